#include "shapeid/diagnosis/placebo.hpp"

#include <algorithm>
#include <set>

#include "shapeid/diagnosis/effects/parts.hpp"

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

double best_placebo(const BlockFits& fits, const std::vector<Term>& terms, std::size_t first,
                    std::size_t last) {
  constexpr double more_than_chance = 2.0;  // standard errors, as for what is kept
  const Tally& tally = fits.tally();
  const Eigen::VectorXd without = fits.held_out(terms);
  double best = 0.0;
  for (std::size_t k = first; k < last; ++k) {
    std::vector<Term> with = terms;
    with.push_back({"placebo", {tally.first[k]}, {false}, 0});
    const Eigen::VectorXd error = fits.held_out(with);
    if (gain_of(without, error).t > more_than_chance) {
      best = std::max(best, (without - error).sum());
    }
  }
  return best;
}

}  // namespace shapeid::diagnosis
