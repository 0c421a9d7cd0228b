#include "shapeid/diagnosis/curve_fit.hpp"

#include <Eigen/QR>

#include <algorithm>
#include <optional>
#include <utility>

#include "shapeid/diagnosis/effects.hpp"
#include "shapeid/diagnosis/series.hpp"
#include "shapeid/diagnosis/unexplained.hpp"

namespace shapeid::diagnosis {
namespace {

/// As many numbers as the smooth curve has by which unexplained() judges: more would cost error on
/// other motion.
constexpr std::size_t most_knots = 5;

std::optional<CurveVariable> variable_of_signal(Signal signal, int joint) {
  switch (signal) {
    case Signal::position:
      return CurveVariable{CurveSignal::position, joint};
    case Signal::speed:
    case Signal::direction:
      return CurveVariable{CurveSignal::speed, joint};
    case Signal::load:
    case Signal::side:
    case Signal::peak:
      return CurveVariable{CurveSignal::load, joint};
    case Signal::turned:
    case Signal::time:
    case Signal::row:
    case Signal::yield:
    case Signal::play:
      break;
  }
  return std::nullopt;
}

/// A curve without knots; none for what a model cannot predict with.
std::optional<Curve> blank(const AppliedEffect& law, const std::optional<CurveVariable>& over) {
  if (!over || !can_follow(*law.effect)) return std::nullopt;
  return Curve{law, *over, {}, {}};
}

std::optional<Curve> blank(const Structure& structure, const Robot& robot) {
  int joint = 0;
  while (robot.joint(joint).name != structure.joint) ++joint;
  return blank(at_start(*find_effect("torque_offset"), joint),
               find_variable(structure.variable, robot));
}

bool same_curve(const Curve& a, const Curve& b) {
  return a.law.effect == b.law.effect && a.law.site == b.law.site && a.over == b.over;
}

/// Means of stretches of x with equally many samples.
Eigen::VectorXd knots_over(std::vector<double> x) {
  std::sort(x.begin(), x.end());
  std::vector<double> knots;
  for (std::size_t k = 0; k < most_knots; ++k) {
    const std::size_t first = k * x.size() / most_knots, last = (k + 1) * x.size() / most_knots;
    if (first == last) continue;
    double sum = 0.0;
    for (std::size_t i = first; i < last; ++i) sum += x[i];
    const double mean = sum / static_cast<double>(last - first);
    if (knots.empty() || mean > knots.back()) knots.push_back(mean);
  }
  return Eigen::Map<const Eigen::VectorXd>(knots.data(), std::ssize(knots));
}

/// A model that lacks curves, and the log that they are fitted to.
class Fitter {
 public:
  Fitter(const Robot& robot, RowSource source, RichModel model, const Recording& recording,
         std::size_t stride)
      : robot_(robot),
        model_(std::move(model)),
        viewer_(robot, source, model_.acting()),
        recording_(recording),
        stride_(stride) {}

  [[nodiscard]] const std::vector<Curve>& curves() const { return model_.curves; }

  [[nodiscard]] std::vector<Structure> structures() const {
    return unexplained(robot_, recording_,
                       series(robot_, viewer_.source(), model_, recording_, stride_), stride_);
  }

  /// Adds it with knots where its signal is, unless there is one like it, or its signal does not
  /// move. Its numbers are those of the next fit().
  void add(Curve curve) {
    for (const Curve& c : curves()) {
      if (same_curve(c, curve)) return;
    }
    std::vector<double> x;
    for_each_sample(model_, [&](const Seen& seen) {
      if (seen.of(curve).squaredNorm() > 0.0) x.push_back(value_of(curve.over, seen.instant));
    });
    curve.at = knots_over(x);
    curve.number = Eigen::VectorXd::Zero(curve.at.size());
    if (curve.at.size() > 1) model_.curves.push_back(std::move(curve));
  }

  /// The numbers of all curves at once: fitted one after the other, the first would keep what it
  /// took of those that are like it.
  void fit() {
    std::vector<Eigen::Index> first;
    Eigen::Index count = 0;
    for (const Curve& c : curves()) {
      first.push_back(count);
      count += c.at.size();
    }
    if (count == 0) return;
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(count, count);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(count);
    RichModel without = model_;
    without.curves.clear();
    for_each_sample(without, [&](const Seen& seen) {
      Eigen::MatrixXd columns(seen.counted.size(), count);
      for (std::size_t k = 0; k < curves().size(); ++k) {
        const Curve& c = curves()[k];
        columns.middleCols(first[k], c.at.size()) =
            seen.of(c) * knot_shares(c.at, value_of(c.over, seen.instant)).transpose();
      }
      normal += columns.transpose() * columns;
      right -= columns.transpose() * seen.residual;
    });
    const Eigen::VectorXd numbers = normal.completeOrthogonalDecomposition().solve(right);
    for (std::size_t k = 0; k < curves().size(); ++k) {
      model_.curves[k].number = numbers.segment(first[k], curves()[k].at.size());
    }
  }

 private:
  struct Seen {
    const Viewer& viewer;
    const View& view;
    Instant instant;
    Eigen::VectorXd residual, counted;
    /// A unit of the law beyond contact forces, in the rows that count; scaled as they are.
    [[nodiscard]] Eigen::VectorXd of(const Curve& curve) const {
      Rows rows{curve.law.effect->columns(instant, curve.law.site, curve.law.shape), view.J};
      viewer.transform(view, rows);
      return counted.cwiseProduct(beyond_contacts(viewer, rows.J, rows.E));
    }
  };

  template <typename Visit>
  void for_each_sample(const RichModel& model, Visit visit) const {
    for (const std::size_t index : recording_.usable(stride_)) {
      const View view = viewer_.view(recording_, index);
      const Prediction predicted = predict(viewer_, view, model);
      visit(Seen{viewer_, view, instant_of(viewer_, view, predicted.load),
                 residual(viewer_, view, model),
                 counted_rows(viewer_, recording_, index, view).template cast<double>().matrix()});
    }
  }

  const Robot& robot_;
  RichModel model_;
  Viewer viewer_;
  const Recording& recording_;
  std::size_t stride_;
};

}  // namespace

std::vector<Curve> curves_for(const Robot& robot, RowSource source, RichModel model,
                              const LoopResult& loop, const Recording& recording,
                              std::size_t stride, const std::vector<std::string>& silent) {
  Fitter fitter(robot, source, std::move(model), recording, stride);
  const auto add = [&](const std::optional<Curve>& curve) {
    if (curve) fitter.add(*curve);
  };
  for (const Found& f : loop.found) {
    if (f.varies) add(blank(f.effect, variable_of_signal(f.varies->signal, f.varies->joint)));
  }
  for (const Stranger& s : loop.strangers) {
    add(blank(s.carrier, variable_of_signal(s.law.signal, s.law.joint)));
  }
  fitter.fit();
  // One a joint each time, because a curve over one signal explains part of what others follow; and
  // none twice, so that this comes to an end.
  for (std::size_t before = fitter.curves().size() + 1; before != fitter.curves().size();) {
    before = fitter.curves().size();
    std::vector<int> done;
    for (const Structure& s : fitter.structures()) {
      const std::optional<Curve> curve = blank(s, robot);
      if (std::count(silent.begin(), silent.end(), s.joint) > 0) continue;
      if (!curve || std::count(done.begin(), done.end(), curve->law.site) > 0) continue;
      done.push_back(curve->law.site);
      fitter.add(*curve);
    }
    fitter.fit();
  }
  return fitter.curves();
}

}  // namespace shapeid::diagnosis
