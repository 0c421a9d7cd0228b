#include "shapeid/diagnosis/effect.hpp"

#include <Eigen/QR>
#include <Eigen/SVD>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include "shapeid/reference/projection.hpp"

namespace shapeid::diagnosis {
namespace {

using Decomposition = Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>;

/// The x of least norm for which A x comes closest to b, without what A multiplies by less than
/// `least`.
Eigen::VectorXd felt(const Eigen::MatrixXd& A, const Eigen::VectorXd& b, double least) {
  if (A.size() == 0) return Eigen::VectorXd::Zero(A.cols());
  Eigen::JacobiSVD<Eigen::MatrixXd> svd(A, Eigen::ComputeThinU | Eigen::ComputeThinV);
  const double most = svd.singularValues()[0];
  if (!(most > least)) return Eigen::VectorXd::Zero(A.cols());
  return svd.setThreshold(least / most).solve(b);
}

}  // namespace

bool same_law(const AppliedEffect& a, const AppliedEffect& b) {
  return a.effect == b.effect && a.site == b.site;
}

bool same_place(const AppliedEffect& a, const AppliedEffect& b) {
  return same_law(a, b) && (a.when == b.when || a.effect->transform.sample != nullptr);
}

bool has_place_of(const std::vector<AppliedEffect>& effects, const AppliedEffect& a) {
  return std::any_of(effects.begin(), effects.end(),
                     [&](const AppliedEffect& b) { return same_place(a, b); });
}

double over_limit(const Effect& effect, const Eigen::VectorXd& value, double most_force) {
  double most = 0.0;
  for (std::size_t p = 0; p < effect.parameters.size(); ++p) {
    const Parameter& parameter = effect.parameters[p];
    const double limit = parameter.unit == "N" ? most_force : parameter.limit;
    most = std::max(most, std::abs(value[static_cast<Eigen::Index>(p)]) / limit);
  }
  return most;
}

namespace {

/// Several contacts of a link share its name.
std::string contact_name(const Robot& robot, int contact) {
  const auto here = robot.contacts.begin() + contact;
  const auto before = std::count_if(robot.contacts.begin(), here,
                                    [&](const Contact& c) { return c.name == here->name; });
  return before == 0 ? here->name : here->name + " #" + std::to_string(before + 1);
}

}  // namespace

std::string site_name(const Robot& robot, SiteKind kind, int site) {
  switch (kind) {
    case SiteKind::joint:
      return robot.joint(site).name;
    case SiteKind::link:
      return robot.links[static_cast<std::size_t>(site)].name;
    case SiteKind::contact:
      return contact_name(robot, site);
    case SiteKind::accelerometer:
      return "base.accel";
    case SiteKind::whole:
      break;
  }
  return "all";
}

int site_count(const Robot& robot, SiteKind kind) {
  switch (kind) {
    case SiteKind::joint:
      return robot.joint_count();
    case SiteKind::link:
      return robot.link_count();
    case SiteKind::contact:
      return static_cast<int>(robot.contacts.size());
    case SiteKind::accelerometer:
      return robot.root == Root::floating ? 1 : 0;
    case SiteKind::whole:
      break;
  }
  return 1;
}

Eigen::VectorXd carrying_forces(const Robot& robot, const Eigen::VectorXd& YPhi,
                                const Eigen::MatrixXd& J) {
  const int base = robot.base_dof();
  if (J.rows() == 0) return Eigen::VectorXd(0);
  return Decomposition(J.leftCols(base).transpose()).solve(YPhi.head(base));
}

PredictedLoad predicted_load(const Robot& robot, const Eigen::VectorXd& applied,
                             const Eigen::VectorXd& YPhi, const Eigen::MatrixXd& J) {
  const int base = robot.base_dof(), n = robot.joint_count();
  PredictedLoad load{Eigen::VectorXd::Zero(J.rows()), YPhi.tail(n), Eigen::VectorXd::Zero(n)};
  if (J.rows() == 0) return load;
  const Eigen::MatrixXd JT = J.rightCols(n).transpose();
  if (base == 0) {
    load.force = Decomposition(JT).solve(YPhi - applied);
  } else {
    load.force = carrying_forces(robot, YPhi, J);
    const Eigen::VectorXd each = Eigen::VectorXd::Ones(J.rows());
    const Eigen::MatrixXd open =
        reference::contact_free_basis(J.leftCols(base).transpose(), each).Q2;
    load.force += open * felt(JT * open, load.joint - applied.tail(n) - JT * load.force,
                              least_lever * JT.norm());
  }
  load.joint -= JT * load.force;
  return load;
}

}  // namespace shapeid::diagnosis
