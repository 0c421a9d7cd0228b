// Flags that are dead: what the torques of a leg say of a foot that is declared in the air.
#include "shapeid/reference/carrying_feet.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "shapeid/models/error.hpp"
#include "shapeid/tests/recovery/quadruped.hpp"

namespace shapeid {
namespace {

using Change = std::function<void(Sample&)>;

/// What is said of a trot of which `change` makes another one; empty if nothing is.
class Trotting {
 public:
  Trotting() {
    test::Trot wanted;
    wanted.seconds = 5.0;
    for (const SimulatedSample& s : test::trot(q_.robot, wanted)) samples_.push_back(s.sample);
  }
  [[nodiscard]] const Robot& robot() const { return q_.robot; }
  [[nodiscard]] double begin() const { return samples_.front().time; }

  [[nodiscard]] std::string said(const Robot& robot, const Change& change) const {
    reference::CarryingFeet feet(robot);
    for (Sample s : samples_) {
      change(s);
      feet.add(s);
    }
    try {
      feet.judge();
    } catch (const Refusal& refusal) {
      return refusal.code() + ": " + refusal.what();
    }
    return "";
  }
  [[nodiscard]] std::string said(const Change& change) const { return said(robot(), change); }

 private:
  test::Quadruped q_ = test::bundled_quadruped();
  std::vector<Sample> samples_;
};

/// By the ratio of forces: also of a robot whose base is given without mass.
TEST(CarryingFeet, AreNamedWhoseFlagIsDead) {
  const Trotting trot;
  for (std::size_t foot = 0; foot < 4; ++foot) {
    const std::string all = trot.said([foot](Sample& s) { s.in_contact[foot] = false; });
    EXPECT_EQ(all.rfind("contact-labels: ", 0), 0U) << all;
    EXPECT_NE(all.find(trot.robot().contacts[foot].name + " is declared in the air for "),
              std::string::npos)
        << all;
  }
  const std::string later = trot.said([&](Sample& s) {
    if (s.time > trot.begin() + 2.0) s.in_contact[1] = false;
  });
  EXPECT_NE(later.find("FL_foot is declared in the air for"), std::string::npos) << later;
  Robot light = trot.robot();
  light.links[0].inertia.values.setZero();
  EXPECT_NE(trot.said(light, [](Sample& s) { s.in_contact[2] = false; }), "");
  EXPECT_EQ(trot.said(light, [](Sample&) {}), "");
}

/// Flags as they are, torques in another unit, a step or two that no flag tells of, logs of less
/// than a second each, and a leg that is held up: its torques carry nothing.
TEST(CarryingFeet, AreNotFoundElsewhere) {
  const Trotting trot;
  EXPECT_EQ(trot.said([](Sample&) {}), "");
  EXPECT_EQ(trot.said([](Sample& s) { s.tau *= 8.0; }), "");
  const auto for_a_second = [&](Sample& s) {
    if (s.time > trot.begin() + 2.0 && s.time < trot.begin() + 3.0) s.in_contact[1] = false;
  };
  EXPECT_EQ(trot.said(for_a_second), "");
  const auto short_logs = [&](Sample& s) {
    s.in_contact[1] = false;
    s.time += 10.0 * std::floor((s.time - trot.begin()) / 0.9);
  };
  EXPECT_EQ(trot.said(short_logs), "");
  const auto held_up = [](Sample& s) {
    s.in_contact[0] = false;
    s.tau.head<3>() = Eigen::Vector3d(0.2, -0.3, 0.1);
  };
  EXPECT_EQ(trot.said(held_up), "");
  reference::CarryingFeet none(trot.robot());
  EXPECT_NO_THROW(none.judge());
}

}  // namespace
}  // namespace shapeid
