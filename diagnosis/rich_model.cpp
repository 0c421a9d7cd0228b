#include "shapeid/diagnosis/rich_model.hpp"

#include <utility>

#include "shapeid/reference/contact.hpp"
#include "shapeid/reference/projection.hpp"
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

Viewer::Viewer(const Robot& robot, reference::ContactTreatment contacts,
               const std::vector<AppliedEffect>& effects)
    : robot_(robot), contacts_(contacts) {
  for (const AppliedEffect& a : effects) {
    if (!a.effect->transform.any()) continue;
    transforming_.push_back(a);
    if (a.effect->transform.robot != nullptr) a.effect->transform.robot(robot_, a.site, a.value);
  }
}

Sample Viewer::moved(const Recording& recording, std::size_t index, double dt,
                     std::size_t count) const {
  while (count > 0 && transforming_[count - 1].effect->transform.sample == nullptr) --count;
  if (count == 0) return dt == 0.0 ? recording[index] : recording.shifted(index, dt);
  const AppliedEffect& last = transforming_[count - 1];
  const Sample now = moved(recording, index, dt, count - 1);
  const Moment moment{now,
                      [&](double more) { return moved(recording, index, dt + more, count - 1); }};
  return last.effect->transform.sample(moment, last.site, last.value);
}

Sample Viewer::moved(const Recording& recording, std::size_t index) const {
  return moved(recording, index, 0.0, transforming_.size());
}

View Viewer::view(const Recording& recording, std::size_t index) const {
  View result = view(moved(recording, index), recording.elapsed(index));
  result.correction = recording.correction(index);
  return result;
}

View Viewer::view(Sample moved, double elapsed) const {
  View view;
  view.sample = std::move(moved);
  view.elapsed = elapsed;
  view.motions = reference::link_motions(robot_, view.sample);
  view.Y = reference::regressor(robot_, view.sample);
  view.J = contacts_ == reference::ContactTreatment::project
               ? reference::contact_jacobian(robot_, view.sample)
               : Eigen::MatrixXd(0, robot_.dof());
  return view;
}

void Viewer::transform(const View& view, Rows& rows) const {
  for (const AppliedEffect& a : transforming_) {
    if (a.effect->transform.rows == nullptr) continue;
    a.effect->transform.rows(robot_, view.sample, a.site, a.value, rows);
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
  if (viewer.contacts() == reference::ContactTreatment::measured) {
    force += reference::measured_contact_force(viewer.robot(), view.sample);
  }
  if (view.correction.size() > 0) force += view.correction;
  return force;
}

Prediction predict(const Viewer& viewer, const View& view, const RichModel& model) {
  return predict(
      viewer, view, model,
      predicted_load(viewer.robot(), logged_force(viewer, view), view.Y * model.Phi, view.J));
}

Prediction predict(const Viewer& viewer, const View& view, const RichModel& model,
                   const PredictedLoad& load) {
  const Instant instant{viewer.robot(), view.sample, view.motions,
                        view.Y,         load.joint,  view.elapsed};
  Rows rows{view.Y * model.Phi, view.J};
  for (const AppliedEffect& a : model.effects) {
    if (a.effect->columns != nullptr) {
      rows.E += a.effect->columns(instant, a.site, a.shape) * a.value;
    }
  }
  viewer.transform(view, rows);
  return {rows.E, std::move(rows.J), load};
}

reference::SampleRows mass_rows(const Viewer& viewer, const View& view, const RichModel& model,
                                const std::vector<int>& free_links) {
  const PredictedLoad load =
      predicted_load(viewer.robot(), logged_force(viewer, view), view.Y * model.Phi, view.J);
  const Instant instant{viewer.robot(), view.sample, view.motions,
                        view.Y,         load.joint,  view.elapsed};
  const Eigen::Index sought = 10 * std::ssize(free_links);
  Rows rows{Eigen::MatrixXd(viewer.robot().dof(), sought + 1), view.J};
  Eigen::VectorXd known = model.Phi;
  Eigen::Index column = 0;
  for (const int link : free_links) {
    rows.E.middleCols<10>(column) = view.Y.middleCols<10>(Eigen::Index{10} * link);
    known.segment<10>(Eigen::Index{10} * link).setZero();
    column += 10;
  }
  rows.E.rightCols<1>() = view.Y * known;
  for (const AppliedEffect& a : model.effects) {
    if (a.effect->columns != nullptr) {
      rows.E.rightCols<1>() += a.effect->columns(instant, a.site, a.shape) * a.value;
    }
  }
  viewer.transform(view, rows);
  return {rows.E.leftCols(sought), logged_force(viewer, view) - rows.E.rightCols<1>(), rows.J};
}

Eigen::VectorXd residual(const Viewer& viewer, const View& view, const RichModel& model) {
  const Prediction predicted = predict(viewer, view, model);
  const Eigen::VectorXd r = predicted.force - logged_force(viewer, view);
  const Eigen::MatrixXd Q2 =
      reference::contact_free_basis(predicted.J, Eigen::VectorXd::Ones(viewer.robot().dof())).Q2;
  return Q2 * (Q2.transpose() * r);
}

}  // namespace shapeid::diagnosis
