#include "shapeid/diagnosis/placebo.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "shapeid/diagnosis/effects.hpp"
#include "shapeid/diagnosis/effects/parts.hpp"
#include "shapeid/diagnosis/fits_around.hpp"

namespace shapeid::diagnosis {
namespace {

// A site is a pair of joints: the one whose torque it is, and the donor of the motion.
int site_of(const Robot& robot, int joint, int donor) {
  return donor * robot.joint_count() + joint;
}
int joint_of(const Instant& at, int site) { return site % at.robot.joint_count(); }
Eigen::Index donor_of(const Instant& at, int site) { return site / at.robot.joint_count(); }

Eigen::MatrixXd spring(const Instant& at, int site, const Eigen::VectorXd&) {
  return joint_column(at, joint_of(at, site), at.sample.q[donor_of(at, site)]);
}

Eigen::MatrixXd viscous(const Instant& at, int site, const Eigen::VectorXd&) {
  return joint_column(at, joint_of(at, site), at.sample.dq[donor_of(at, site)]);
}

Eigen::MatrixXd coulomb(const Instant& at, int site, const Eigen::VectorXd& shape) {
  return joint_column(at, joint_of(at, site),
                      direction_of(at.sample.dq[donor_of(at, site)], shape[0]));
}

Eigen::MatrixXd rotor(const Instant& at, int site, const Eigen::VectorXd&) {
  return joint_column(at, joint_of(at, site), at.sample.ddq[donor_of(at, site)]);
}

Eigen::MatrixXd ripple(const Instant& at, int site, const Eigen::VectorXd& shape) {
  const double phase = shape[0] * at.sample.q[donor_of(at, site)];
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(at.robot.dof(), 2);
  columns.row(at.robot.base_dof() + joint_of(at, site)) << std::cos(phase), std::sin(phase);
  return columns;
}

const Effect& ripple_law() {
  static const Effect law = [] {
    Effect e = *find_effect("cogging");  // sizes and periods are those of the name
    e.id = "placebo";
    e.columns = ripple;
    return e;
  }();
  return law;
}

const std::vector<Effect>& laws() {
  static const std::vector<Effect> all = [] {
    std::vector<Effect> list;
    for (const auto columns : {spring, viscous, coulomb, rotor}) {
      Effect& e = list.emplace_back();
      e.id = "placebo";
      e.parameters = {{"k", "SI"}};
      e.shape = {step_width()};
      e.columns = columns;
    }
    return list;
  }();
  return all;
}

}  // namespace

std::vector<AppliedEffect> placebos(const Robot& robot) {
  const int n = robot.joint_count();
  std::vector<AppliedEffect> list;
  for (int joint = 0; joint < n; ++joint) {
    std::set<int> donors = {(joint + 1) % n, (joint + (n + 1) / 2) % n};
    donors.erase(joint);
    for (const int donor : donors) {
      for (const Effect& law : laws()) list.push_back(at_start(law, site_of(robot, joint, donor)));
    }
  }
  return list;
}

std::vector<AppliedEffect> ripple_placebos(const Robot& robot, const Recording& log,
                                           const Series& left, int joint) {
  const ShapeNumber& N = ripple_law().shape.front();
  std::vector<AppliedEffect> list;
  for (int donor = 0; donor < robot.joint_count(); ++donor) {
    if (donor == joint) continue;
    AppliedEffect& a = list.emplace_back(at_start(ripple_law(), site_of(robot, joint, donor)));
    a.shape[0] =
        strongest_ripple(robot, log, left, joint, donor, RippleOf::torque, N.lower, N.upper);
  }
  return list;
}

int joint_of_placebo(const Robot& robot, const AppliedEffect& placebo) {
  return placebo.site % robot.joint_count();
}

double best_placebo(const BlockFits& fits, const std::vector<Term>& terms, std::size_t first,
                    std::size_t last) {
  constexpr double more_than_chance = 2.0;  // standard errors, as for what is kept
  const Tally& tally = fits.tally();
  const FitsAround now(fits, terms);
  const Eigen::VectorXd& without = now.error();
  double best = 0.0;
  for (std::size_t k = first; k < last; ++k) {
    const Eigen::VectorXd error = now.with({"placebo", {tally.first[k]}, {false}, 0});
    if (gain_of(without, error).t > more_than_chance) {
      best = std::max(best, (without - error).sum());
    }
  }
  return best;
}

}  // namespace shapeid::diagnosis
