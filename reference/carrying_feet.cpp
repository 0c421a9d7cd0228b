#include "shapeid/reference/carrying_feet.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "shapeid/models/error.hpp"
#include "shapeid/reference/contact_detection.hpp"

namespace shapeid::reference {
namespace {

// s. Nobody swings a leg for as long, and no step is missed for as long as a flag that is dead.
constexpr double swing = 0.5, dead = 1.5;
// s between samples that are looked at: where a foot is in the air for long, and else.
constexpr double closely = 0.02, now_and_then = 0.1;
constexpr double gap = 0.25;  // s
constexpr std::size_t enough = 40;

}  // namespace

CarryingFeet::CarryingFeet(const Robot& robot) : robot_(&robot), Phi_(stacked_parameters(robot)) {
  for (std::size_t c = 0; c < robot.contacts.size(); ++c) {
    const int link = robot.contacts[c].link;
    auto foot = std::ranges::find(feet_, link, &Foot::link);
    if (foot == feet_.end()) {
      foot = feet_.insert(feet_.end(), Foot{});
      foot->link = link;
    }
    foot->contacts.push_back(c);
  }
}

bool CarryingFeet::stands(const Foot& foot, const Sample& sample) {
  return std::ranges::any_of(foot.contacts, [&](std::size_t c) { return sample.in_contact[c]; });
}

void CarryingFeet::land(Foot& foot) {
  foot.in_the_air = false;
  const Stretch& now = foot.now;
  if (now.seconds() < dead || now.force.count < enough) return;
  if (now.least() > foot.strongest.least()) foot.strongest = now;
}

void CarryingFeet::add(const Sample& sample) {
  if (sample.in_contact.empty()) return;
  const double since = sample.time - last_;
  if (!begun_ || !(since >= 0.0 && since < gap)) {
    for (Foot& foot : feet_) land(foot);
    begun_ = true;
    looked_at_ = sample.time;
  }
  last_ = sample.time;
  bool any_long = false;
  for (Foot& foot : feet_) {
    if (stands(foot, sample)) {
      if (foot.in_the_air) land(foot);
      continue;
    }
    if (!foot.in_the_air) foot.now = {sample.time, sample.time, {}, {}};
    foot.in_the_air = true;
    foot.now.end = sample.time;
    any_long = any_long || foot.now.seconds() > swing;
  }
  if (sample.time - looked_at_ < (any_long ? closely : now_and_then)) return;
  looked_at_ = sample.time;
  const Eigen::VectorXd force = supporting_forces(*robot_, sample, Phi_);
  const Eigen::MatrixXd per_torque = support_per_torque(*robot_, sample);
  const Eigen::VectorXd of_torques = -per_torque * sample.tau;
  for (const Foot& foot : feet_) {
    if (foot.in_the_air) continue;
    standing_.add(on(foot, force)[0]);
    per_torque_.add(on(foot, per_torque).norm());
  }
  for (Foot& foot : feet_) {
    if (!foot.in_the_air || !(foot.now.seconds() > swing)) continue;
    constexpr double straight = 2.0;
    if (on(foot, per_torque).norm() > straight * per_torque_.value()) continue;
    foot.now.force.add(on(foot, force)[0]);
    foot.now.of_torques.add(on(foot, of_torques)[0]);
  }
}

Eigen::RowVectorXd CarryingFeet::on(const Foot& foot, const Eigen::MatrixXd& contacts) {
  Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(contacts.cols());
  for (const std::size_t c : foot.contacts) sum += contacts.row(static_cast<Eigen::Index>(c));
  return sum;
}

void CarryingFeet::judge() {
  for (Foot& foot : feet_) land(foot);
  // A foot that walks along carries for half of the time or more what one that stands does; one
  // that is held up carries nothing, and given links that are wrong a little.
  constexpr double carries = 0.2;
  if (standing_.count < enough || !(standing_.value() > 0.0)) return;
  for (const Foot& foot : feet_) {
    const double share = foot.strongest.least() / standing_.value();
    if (!(share > carries)) continue;
    throw Refusal(
        "contact-labels",
        fmt::format("{} is declared in the air for {:.2g} s from {:.6g} s on, and by the torques "
                    "of its leg carries {:.0f} % of what feet do that are declared to stand: a "
                    "flag that is dead (mend it, or leave these rows out), or given masses of the "
                    "leg that are far off",
                    names(foot), foot.strongest.seconds(), foot.strongest.begin, 1e2 * share));
  }
}

std::string CarryingFeet::names(const Foot& foot) const {
  std::vector<std::string> names;
  for (const std::size_t c : foot.contacts) names.push_back(robot_->contacts[c].name);
  return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace shapeid::reference
