// Legs whose columns are exchanged, on a trot by Simbody.
#include "shapeid/diagnosis/leg_order.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "shapeid/models/error.hpp"
#include "shapeid/tests/diagnosis/arm.hpp"
#include "shapeid/tests/diagnosis/trot.hpp"

namespace shapeid::diagnosis {
namespace {

constexpr std::array<std::size_t, 4> in_order = {0, 1, 2, 3};

/// What is refused of the trot where leg i has the columns of leg `logged`[i]; empty if nothing is.
/// If feet do not count no flag is ever on.
std::string refused(const test::Trot& trot, const std::array<std::size_t, 4>& logged,
                    bool feet_count = true) {
  std::vector<Sample> samples = trot.samples;
  for (Sample& s : samples) {
    const Sample right = s;
    for (std::size_t leg = 0; leg < logged.size(); ++leg) {
      const auto to = 3 * static_cast<Eigen::Index>(leg);
      const auto from = 3 * static_cast<Eigen::Index>(logged[leg]);
      s.q.segment<3>(to) = right.q.segment<3>(from);
      s.dq.segment<3>(to) = right.dq.segment<3>(from);
      s.ddq.segment<3>(to) = right.ddq.segment<3>(from);
      s.tau.segment<3>(to) = right.tau.segment<3>(from);
      s.in_contact[leg] = feet_count && right.in_contact[logged[leg]];
    }
  }
  try {
    check_leg_order(trot.robot, {std::move(samples), test::Trot::rate}, ContactTreatment::project);
  } catch (const Refusal& r) {
    EXPECT_EQ(r.code(), "leg-order");
    return r.what();
  }
  return "";
}

TEST(LegOrder, IsNamed) {
  const test::Trot trot;
  EXPECT_EQ(refused(trot, in_order), "");
  EXPECT_NE(refused(trot, {1, 0, 2, 3})
                .find("if legs are exchanged, FR_abad by FL_abad, FL_abad by FR_abad, with all"),
            std::string::npos);
  EXPECT_NE(refused(trot, {0, 3, 2, 1})
                .find("if legs are exchanged, FL_abad by RL_abad, RL_abad by FL_abad, with all"),
            std::string::npos);
  // Three in a ring: FR has the columns of FL, so its own are at RR.
  EXPECT_NE(refused(trot, {1, 2, 0, 3})
                .find("if legs are exchanged, FR_abad by RR_abad, FL_abad by FR_abad, RR_abad by "
                      "FL_abad, with all"),
            std::string::npos);
}

/// The given links carry nothing where no flag of a foot is ever on, and legs may seem exchanged.
TEST(LegOrder, MayBeFeetThatDoNotCount) {
  const test::Trot trot;
  constexpr const char* feet = "or feet carry the robot that do not count";
  EXPECT_EQ(refused(trot, {1, 0, 2, 3}).find(feet), std::string::npos);
  EXPECT_NE(refused(trot, in_order, false).find(feet), std::string::npos);
}

TEST(LegOrder, IsAskedOfRobotsWithLegs) {
  EXPECT_NO_THROW(check_leg_order(test::arm(), test::record({}), ContactTreatment::ignore));
  Robot without_feet = test::quadruped();
  without_feet.contacts.clear();
  EXPECT_NO_THROW(check_leg_order(without_feet, {{}, test::Trot::rate}, ContactTreatment::ignore));
}

}  // namespace
}  // namespace shapeid::diagnosis
