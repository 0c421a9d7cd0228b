#include "shapeid/diagnosis/hypotheses.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "shapeid/diagnosis/effects.hpp"

namespace shapeid::diagnosis {
namespace {

/// What the recursions over links lose, a few dozen sums and products.
constexpr double few_roundings = 64.0 * std::numeric_limits<double>::epsilon();

// Of a parameter's usual size: small enough for the third derivative, large against rounding.
constexpr double part_of_size = 0.01;

/// Small; but the derivative by a delay is a rate, whose noise the load's own span keeps down. (Of
/// neighbouring samples, noise made it twice as long as it is: two lags then took more than the
/// delay that they were.) Loads of legs change too fast for that: with 2 ms to either side a delay
/// of 13 ms was not found in a gallop any more.
double step_of(const Robot& robot, const Effect& effect, const Parameter& parameter) {
  const bool is_delay = effect.transform.sample != nullptr && parameter.unit == "s";
  const bool smooth = is_delay && robot.root == Root::fixed;
  return smooth ? neighbour_step(robot) : part_of_size * parameter.size;
}

/// The model's effects that act, the hypothesis among them if it does, with its parameter changed
/// by `step`.
std::vector<AppliedEffect> stepped(const RichModel& model, const AppliedEffect& hypothesis,
                                   Eigen::Index parameter, double step) {
  std::vector<AppliedEffect> effects = model.acting();
  if (!model.has_acting(hypothesis)) return effects;
  auto place = std::find_if(effects.begin(), effects.end(),
                            [&](const AppliedEffect& a) { return same_place(a, hypothesis); });
  if (place == effects.end()) place = effects.insert(effects.end(), hypothesis);
  place->value[parameter] += step;
  return effects;
}

}  // namespace

std::string unit_of(const Robot& robot, const AppliedEffect& effect, const std::string& unit) {
  const bool at_joint = effect.effect->site == SiteKind::joint;
  return at_joint ? unit_at(robot.joint(effect.site), unit) : unit;
}

std::string hypothesis_id(const Robot& robot, const AppliedEffect& effect) {
  return fmt::format("{}@{}", effect.effect->id,
                     site_name(robot, effect.effect->site, effect.site));
}

std::vector<AppliedEffect> all_hypotheses(const Robot& robot) {
  std::vector<AppliedEffect> hypotheses;
  for (const Effect& effect : all_effects()) {
    if (effect.is_payload || effect.sought_first) continue;
    for (int site = 0; site < site_count(robot, effect.site); ++site) {
      if (effect.applies != nullptr && !effect.applies(robot, site)) continue;
      hypotheses.push_back(at_start(effect, site));
    }
  }
  return hypotheses;
}

HypothesisColumns::HypothesisColumns(const Robot& robot, RowSource source, const RichModel& model,
                                     const std::vector<AppliedEffect>& hypotheses)
    : model_(model), hypotheses_(hypotheses), viewer_(robot, source, model.acting(), hypotheses) {
  for (const AppliedEffect& h : hypotheses_) {
    first_.push_back(count_);
    count_ += h.value.size();
    auto& differences = differences_.emplace_back();
    if (!h.effect->transform.any()) continue;
    for (Eigen::Index p = 0; p < h.value.size(); ++p) {
      const double h_step =
          step_of(robot, *h.effect, h.effect->parameters[static_cast<std::size_t>(p)]);
      differences.push_back({Viewer(robot, source, stepped(model, h, p, h_step)),
                             Viewer(robot, source, stepped(model, h, p, -h_step)), 2.0 * h_step});
    }
  }
}

Eigen::VectorXd HypothesisColumns::difference(const AppliedEffect& hypothesis, const Difference& d,
                                              const Recording& recording, std::size_t index,
                                              const View& view, const Prediction& predicted) const {
  const auto force = [&](const Viewer& viewer) -> Eigen::VectorXd {
    // What changes rows alone needs no new regressor.
    const bool same_view = hypothesis.effect->transform.sample == nullptr &&
                           hypothesis.effect->transform.robot == nullptr;
    if (same_view) {
      const Prediction changed = predict(viewer, view, predicted.links, model_, predicted.load);
      return changed.force - changed.J.transpose() * predicted.load.force;
    }
    // The contacts whose forces are held fixed, also where a delay looks across a touchdown.
    Sample moved = viewer.moved(recording, index);
    moved.in_contact = view.sample.in_contact;
    const Scene scene = viewer.scene(std::move(moved), view.surroundings);
    const Prediction changed =
        predict(viewer, scene, viewer.links(scene, model_.Phi), model_, predicted.load);
    return changed.force - changed.J.transpose() * predicted.load.force;
  };
  const Eigen::VectorXd plus = force(d.plus), minus = force(d.minus);
  // A difference that rounding can make is none: a hypothesis that no row feels has no column, by
  // whichever path.
  const double rounding = few_roundings * plus.lpNorm<Eigen::Infinity>();
  return ((plus - minus).array().abs() > rounding).select((plus - minus) / d.step, 0.0);
}

Eigen::MatrixXd HypothesisColumns::at(const Recording& recording, std::size_t index,
                                      const View& view, const Prediction& predicted) const {
  const Instant instant = instant_of(viewer_, view, predicted.load);
  Eigen::MatrixXd columns(viewer_.robot().dof(), count_);
  for (std::size_t k = 0; k < hypotheses_.size(); ++k) {
    const AppliedEffect& h = hypotheses_[k];
    if (h.effect->columns != nullptr) {
      Rows rows{h.effect->columns(instant, h.site, h.shape), view.J};
      viewer_.transform(view, rows);
      columns.middleCols(first_[k], h.value.size()) = rows.E;
      continue;
    }
    for (std::size_t p = 0; p < differences_[k].size(); ++p) {
      columns.col(first_[k] + static_cast<Eigen::Index>(p)) =
          difference(h, differences_[k][p], recording, index, view, predicted);
    }
  }
  return columns;
}

}  // namespace shapeid::diagnosis
