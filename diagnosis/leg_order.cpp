#include "shapeid/diagnosis/leg_order.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "shapeid/diagnosis/accelerometer_axes.hpp"
#include "shapeid/diagnosis/given_errors.hpp"
#include "shapeid/diagnosis/joint_readings.hpp"
#include "shapeid/models/error.hpp"

namespace shapeid::diagnosis {
namespace {

/// What hangs on one joint of the base and may touch the ground.
struct Leg {
  int first;  ///< link
  std::vector<int> joints = {};
  std::vector<std::size_t> contacts = {};
};

/// The link on the base that `link` hangs on; 0 for the base.
int first_link_above(const Robot& robot, int link) {
  while (link > 0 && robot.links[static_cast<std::size_t>(link)].parent > 0) {
    link = robot.links[static_cast<std::size_t>(link)].parent;
  }
  return link;
}

bool are_alike(const Robot& robot, const Leg& one, const Leg& other) {
  return one.contacts.size() == other.contacts.size() &&
         std::ranges::equal(one.joints, other.joints, [&robot](int a, int b) {
           return robot.joint(a).kind == robot.joint(b).kind;
         });
}

/// Those that are like the first one.
std::vector<Leg> legs_of(const Robot& robot) {
  std::vector<Leg> legs;
  for (std::size_t c = 0; c < robot.contacts.size(); ++c) {
    const int first = first_link_above(robot, robot.contacts[c].link);
    auto leg = std::ranges::find(legs, first, &Leg::first);
    if (leg == legs.end()) leg = legs.insert(legs.end(), {first});
    leg->contacts.push_back(c);
  }
  for (Leg& leg : legs) {
    for (int j = 0; j < robot.joint_count(); ++j) {
      if (first_link_above(robot, j + 1) == leg.first) leg.joints.push_back(j);
    }
  }
  std::erase_if(legs, [&](const Leg& leg) { return !are_alike(robot, legs.front(), leg); });
  return legs;
}

/// Which leg's columns each leg should have.
using Order = std::vector<std::size_t>;

std::vector<Order> other_orders(std::size_t legs) {
  Order order(legs);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::vector<Order> others;
  constexpr std::size_t few = 4;
  if (legs <= few) {
    while (std::ranges::next_permutation(order).found) others.push_back(order);
    return others;
  }
  for (std::size_t a = 0; a < legs; ++a) {
    for (std::size_t b = a + 1; b < legs; ++b) {
      others.push_back(order);
      std::swap(others.back()[a], others.back()[b]);
    }
  }
  return others;
}

void exchange(const std::vector<Leg>& legs, const Order& order, Sample& sample) {
  const Sample logged = sample;
  for (std::size_t i = 0; i < legs.size(); ++i) {
    const Leg &to = legs[i], &from = legs[order[i]];
    for (std::size_t k = 0; k < to.joints.size(); ++k) {
      sample.q[to.joints[k]] = logged.q[from.joints[k]];
      sample.dq[to.joints[k]] = logged.dq[from.joints[k]];
      sample.ddq[to.joints[k]] = logged.ddq[from.joints[k]];
      sample.tau[to.joints[k]] = logged.tau[from.joints[k]];
    }
    for (std::size_t k = 0; k < to.contacts.size(); ++k) {
      const std::size_t here = to.contacts[k], there = from.contacts[k];
      if (!logged.in_contact.empty()) sample.in_contact[here] = logged.in_contact[there];
      if (!logged.contact_force.empty()) sample.contact_force[here] = logged.contact_force[there];
    }
  }
}

/// Whether no foot's force is projected away, or taken off, in any sample.
bool no_foot_counts(const Recording& recording, ContactTreatment contacts) {
  const auto touches = [](const Sample& s) {
    return std::ranges::find(s.in_contact, true) != s.in_contact.end();
  };
  return contacts == ContactTreatment::ignore ||
         (contacts == ContactTreatment::project &&
          std::ranges::none_of(recording.samples(), touches));
}

int legs_moved_by(const Order& order) {
  int moved = 0;
  for (std::size_t i = 0; i < order.size(); ++i) moved += order[i] != i ? 1 : 0;
  return moved;
}

std::string words_of(const Robot& robot, const std::vector<Leg>& legs, const Order& order) {
  const auto joint = [&](std::size_t leg) { return robot.joint(legs[leg].first - 1).name; };
  std::vector<std::string> each;
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (order[i] != i) each.push_back(fmt::format("{} by {}", joint(i), joint(order[i])));
  }
  return fmt::format("{}", fmt::join(each, ", "));
}

}  // namespace

void check_leg_order(const Robot& robot, const Recording& recording, ContactTreatment contacts) {
  if (robot.root == Root::fixed) return;
  const std::vector<Leg> legs = legs_of(robot);
  if (legs.size() < 2 || legs.front().first == 0) return;
  const GivenErrors errors(robot, recording, contacts);
  const Eigen::VectorXd as_logged = errors.of_parts([](Sample&) {});
  // Of measured trots whose legs are in order others leave 1.07 to 3.7 times as much.
  constexpr double little = 1e-4, better = 0.9;
  if (!(as_logged.sum() > little * errors.of_nothing())) return;
  struct Trial {
    Order order;
    double left;
  };
  std::vector<Trial> trials;
  for (const Order& order : other_orders(legs.size())) {
    const Eigen::VectorXd left =
        errors.of_parts([&](Sample& sample) { exchange(legs, order, sample); });
    if (left.sum() < better * as_logged.sum() && are_less(left, as_logged)) {
      trials.push_back({order, left.sum()});
    }
  }
  if (trials.empty()) return;
  check_accelerometer(robot, recording, contacts);  // with other axes it may look like that, too
  // Of those that are about as good as the best one, that which moves fewest legs.
  const double least = std::ranges::min(trials, {}, &Trial::left).left;
  // A joint of the other sign is said by check_joint_readings().
  if (left_by_other_signs(robot, recording, contacts) < least) return;
  std::erase_if(trials, [&](const Trial& t) { return better * t.left > least; });
  const Order best = std::ranges::min(trials, {}, [](const Trial& t) {
                       return std::pair(legs_moved_by(t.order), t.left);
                     }).order;
  throw Refusal("leg-order",
                fmt::format("the given model predicts the logged torque better if legs are "
                            "exchanged, {}, with all that is beyond these joints: exchange their "
                            "columns in the mapping, or their joints in the URDF; or the IMU is "
                            "turned{}",
                            words_of(robot, legs, best),
                            no_foot_counts(recording, contacts)
                                ? ", or feet carry the robot that do not count"
                                : ""));
}

}  // namespace shapeid::diagnosis
