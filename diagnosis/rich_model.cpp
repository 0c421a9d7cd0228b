#include "shapeid/diagnosis/rich_model.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <utility>

#include "shapeid/diagnosis/effects.hpp"
#include "shapeid/reference/contact.hpp"
#include "shapeid/reference/regressor.hpp"

namespace shapeid::diagnosis {

AppliedEffect at_start(const Effect& effect, int site) {
  AppliedEffect applied{&effect, site, Eigen::VectorXd(std::ssize(effect.shape)),
                        Eigen::VectorXd::Zero(std::ssize(effect.parameters))};
  for (std::size_t i = 0; i < effect.shape.size(); ++i) {
    applied.shape[static_cast<Eigen::Index>(i)] = effect.shape[i].start;
  }
  return applied;
}

RichModel RichModel::in_reference() const {
  RichModel model = *this;
  model.earlier = true;
  return model;
}

std::vector<AppliedEffect> RichModel::acting() const {
  std::vector<AppliedEffect> list;
  std::ranges::copy_if(effects, std::back_inserter(list),
                       [this](const AppliedEffect& a) { return has_acting(a); });
  return list;
}

bool needs_load_rate(const std::vector<AppliedEffect>& effects) {
  return std::any_of(effects.begin(), effects.end(),
                     [](const AppliedEffect& a) { return a.effect->filters_load; });
}

std::vector<LoadRate> slopes_of_filters(const Robot& robot,
                                        const std::vector<AppliedEffect>& effects, double reach) {
  std::map<int, double> time_constant;
  for (const AppliedEffect& a : effects) {
    if (a.effect->filters_load && !a.to_first_order) time_constant[a.site] += a.value[0];
  }
  const double step = neighbour_step(robot);
  std::vector<LoadRate> slopes;
  for (const auto& [joint, T] : time_constant) {
    const double ago = std::clamp(T, 0.0, std::max(reach - step, 0.0));
    const double longest = std::max(reach - ago, step);
    const double half = std::clamp(std::sqrt(3.0) * ago, step, longest);
    slopes.push_back({joint, -ago - half, -ago + half});
  }
  return slopes;
}

std::vector<LoadRate> load_rates(const Robot& robot, const std::vector<AppliedEffect>& effects,
                                 const std::vector<AppliedEffect>& tried) {
  std::vector<LoadRate> rates;
  const bool of_now = std::any_of(effects.begin(), effects.end(),
                                  [](const AppliedEffect& a) { return a.to_first_order; });
  if (of_now || needs_load_rate(tried)) {
    const double step = neighbour_step(robot);
    rates.push_back({LoadRate::all_joints, -step, step});
  }
  // What comes late moves the whole sample at which a slope begins or ends.
  double reach = largest_shift;
  for (const AppliedEffect& a : effects) {
    for (const char* late : {"torque_delay", "imu_delay"}) {
      if (a.effect == find_effect(late)) reach -= std::abs(a.value[0]);
    }
  }
  const std::vector<LoadRate> slopes = slopes_of_filters(robot, effects, reach);
  rates.insert(rates.end(), slopes.begin(), slopes.end());
  return rates;
}

Viewer::Viewer(const Robot& robot, RowSource source, const std::vector<AppliedEffect>& effects,
               const std::vector<AppliedEffect>& tried)
    : robot_(robot), source_(source), load_rates_(diagnosis::load_rates(robot, effects, tried)) {
  for (const AppliedEffect& a : effects) {
    if (!a.effect->transform.any()) continue;
    transforming_.push_back(a);
    if (a.effect->transform.robot != nullptr) a.effect->transform.robot(robot_, a.site, a.value);
  }
  rows_.emplace(robot_, source_.path);
}

Sample Viewer::moved(const Recording& recording, std::size_t index, double dt,
                     std::size_t count) const {
  while (count > 0 && transforming_[count - 1].effect->transform.sample == nullptr) --count;
  if (count == 0) return dt == 0.0 ? recording[index] : recording.shifted(index, dt);
  const AppliedEffect& last = transforming_[count - 1];
  const Sample now = moved(recording, index, dt, count - 1);
  const Moment moment{now,
                      [&](double more) { return moved(recording, index, dt + more, count - 1); },
                      recording.surroundings(index)};
  return last.effect->transform.sample(moment, last.site, last.value);
}

Sample Viewer::moved(const Recording& recording, std::size_t index) const {
  return moved(recording, index, 0.0, transforming_.size());
}

View Viewer::view(const Recording& recording, std::size_t index) const {
  View result = view(moved(recording, index), recording.surroundings(index));
  result.correction = recording.correction(index);
  for (const LoadRate& over : load_rates_) {
    for (const double dt : {over.begin, over.end}) {
      Sample sample = moved(recording, index, dt, transforming_.size());
      sample.in_contact = result.sample.in_contact;
      const View near = view(std::move(sample), result.surroundings);
      result.around.push_back({logged_force(*this, near), near.Y, near.J, near.carried});
    }
  }
  return result;
}

View Viewer::view(Sample moved, Surroundings surroundings) const {
  View view{scene(std::move(moved), std::move(surroundings)), {}, {}, {}};
  view.Y = rows_->regressor(robot_, view.sample, view.motions);
  return view;
}

Scene Viewer::scene(Sample moved, Surroundings surroundings) const {
  Scene scene;
  scene.sample = std::move(moved);
  scene.surroundings = std::move(surroundings);
  scene.motions = reference::link_motions(robot_, scene.sample);
  scene.J = source_.contacts == ContactTreatment::project
                ? rows_->contact_jacobian(robot_, scene.sample, scene.motions)
                : Eigen::MatrixXd(0, robot_.dof());
  scene.carried = source_.contacts == ContactTreatment::measured
                      ? reference::measured_contact_force(robot_, scene.sample)
                      : Eigen::VectorXd(Eigen::VectorXd::Zero(robot_.dof()));
  return scene;
}

Eigen::VectorXd Viewer::links(const Scene& scene, const Eigen::VectorXd& Phi) const {
  return rows_->inverse_dynamics(robot_, scene.sample, scene.motions, Phi);
}

void Viewer::transform(const Scene& scene, Rows& rows) const {
  for (const bool scales : {false, true}) {
    for (const AppliedEffect& a : transforming_) {
      const Transformation& transform = a.effect->transform;
      if (transform.rows == nullptr || transform.scales != scales) continue;
      transform.rows(robot_, scene.sample, scene.surroundings.down, a.site, a.value, rows);
    }
  }
}

Eigen::Array<bool, Eigen::Dynamic, 1> counted_rows(const Viewer& viewer, const Recording& recording,
                                                   std::size_t index, const View& view) {
  const Robot& robot = viewer.robot();
  Eigen::Array<bool, Eigen::Dynamic, 1> counted =
      Eigen::Array<bool, Eigen::Dynamic, 1>::Constant(robot.dof(), true);
  if (robot.root == Root::floating || view.J.rows() > 0) return counted;
  for (Eigen::Index j = 0; j < robot.joint_count(); ++j) counted[j] = !recording.at_rest(index, j);
  return counted;
}

Eigen::VectorXd logged_force(const Viewer& viewer, const View& view) {
  Eigen::VectorXd force = reference::applied_force(viewer.robot(), view.sample);
  if (view.correction.size() > 0) force += view.correction;
  return force;
}

Instant instant_of(const Viewer& viewer, const Scene& scene, const PredictedLoad& load) {
  return {viewer.robot(), scene.sample, scene.motions, load.joint, load.rate, scene.surroundings};
}

namespace {

Eigen::VectorXd force_of(const RichModel& model, const Instant& instant) {
  Eigen::VectorXd force = Eigen::VectorXd::Zero(instant.robot.dof());
  for (const AppliedEffect& a : model.effects) {
    if (a.effect->columns != nullptr && model.has_acting(a)) {
      force += a.effect->columns(instant, a.site, a.shape) * a.value;
    }
  }
  for (const Curve& curve : model.curves) force += force_of(curve, instant);
  return force;
}

/// Contact forces are those that carry links and effects, and come closest to the torque with both;
/// of effects that grow with the load, by the load that links alone make of all torque.
PredictedLoad load_of(const Viewer& viewer, const View& view, const Eigen::VectorXd& links,
                      const RichModel& model) {
  const Eigen::VectorXd applied = logged_force(viewer, view);
  PredictedLoad now = predicted_load(viewer.robot(), applied, links - view.carried, view.J);
  const auto load = [&](const Neighbour& near) -> Eigen::VectorXd {
    const Eigen::VectorXd taken = near.Y * model.Phi - near.carried;
    return predicted_load(viewer.robot(), near.applied, taken, near.J).joint;
  };
  for (std::size_t k = 0; 2 * k < view.around.size(); ++k) {
    const LoadRate& over = viewer.load_rates()[k];
    const Eigen::VectorXd rate =
        (load(view.around[2 * k + 1]) - load(view.around[2 * k])) / over.span();
    if (over.joint == LoadRate::all_joints) {
      now.rate = rate;
    } else {
      now.rate[over.joint] = rate[over.joint];
    }
  }
  if (view.J.rows() == 0 || (model.effects.empty() && model.curves.empty())) return now;
  const Eigen::VectorXd E = force_of(model, instant_of(viewer, view, now));
  PredictedLoad all = predicted_load(viewer.robot(), applied, links - view.carried + E, view.J);
  now.force = std::move(all.force);
  now.joint = all.joint - E.tail(viewer.robot().joint_count());
  return now;
}

}  // namespace

Prediction predict(const Viewer& viewer, const View& view, const RichModel& model) {
  Eigen::VectorXd links = view.Y * model.Phi;
  const PredictedLoad load = load_of(viewer, view, links, model);
  return predict(viewer, view, std::move(links), model, load);
}

Prediction predict(const Viewer& viewer, const Scene& scene, Eigen::VectorXd links,
                   const RichModel& model, const PredictedLoad& load) {
  const Instant instant = instant_of(viewer, scene, load);
  Rows rows{links - scene.carried, scene.J};
  rows.E += force_of(model, instant);
  viewer.transform(scene, rows);
  return {rows.E, std::move(rows.J), std::move(links), load};
}

reference::SampleRows mass_rows(const Viewer& viewer, const View& view, const RichModel& model,
                                const std::vector<int>& free_links) {
  const PredictedLoad load = load_of(viewer, view, view.Y * model.Phi, model);
  const Instant instant = instant_of(viewer, view, load);
  const Eigen::Index sought = 10 * std::ssize(free_links);
  Rows rows{Eigen::MatrixXd(viewer.robot().dof(), sought + 1), view.J};
  Eigen::VectorXd known = model.Phi;
  Eigen::Index column = 0;
  for (const int link : free_links) {
    rows.E.middleCols<10>(column) = view.Y.middleCols<10>(Eigen::Index{10} * link);
    known.segment<10>(Eigen::Index{10} * link).setZero();
    column += 10;
  }
  rows.E.rightCols<1>() = view.Y * known - view.carried;
  rows.E.rightCols<1>() += force_of(model, instant);
  viewer.transform(view, rows);
  return {rows.E.leftCols(sought), logged_force(viewer, view) - rows.E.rightCols<1>(), rows.J};
}

Eigen::MatrixXd beyond_contacts(const Viewer& viewer, const Eigen::MatrixXd& J,
                                const Eigen::MatrixXd& force) {
  ContactFree contact_free(viewer.robot(), Eigen::VectorXd::Ones(viewer.robot().dof()),
                           viewer.source().path);
  return contact_free.beyond(J, force);
}

Eigen::VectorXd residual(const Viewer& viewer, const View& view, const RichModel& model) {
  // The load takes contact forces to know, and much of the time.
  const bool feels_load =
      !model.curves.empty() ||
      std::any_of(model.effects.begin(), model.effects.end(),
                  [](const AppliedEffect& a) { return a.effect->columns != nullptr; });
  const Prediction predicted = feels_load ? predict(viewer, view, model)
                                          : predict(viewer, view, view.Y * model.Phi, model, {});
  return beyond_contacts(viewer, predicted.J, predicted.force - logged_force(viewer, view));
}

}  // namespace shapeid::diagnosis
