// A load is put on and taken off while the robot trots: found within half a second, with its mass.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "shapeid/tests/track/logs.hpp"

namespace shapeid::test {
namespace {

using nlohmann::json;

// s, from the moment to the line that says so.
constexpr double soon = 0.5;
// Of the mass. What a third of a second tells is within two percent (docs/tracking.md).
constexpr double share = 0.05;

TEST(TrackLoad, PutOnAndTakenOffIsFoundWithinHalfASecond) {
  constexpr double mass = 1.5, on = 2.5, off = 4.5;
  for (const int seed : {1, 2}) {
    const std::vector<json> lines = tracked(simulated(
        "loaded", fmt::format("--seconds 6.5 --rate 500 --seed {} --load {} 0.02 -0.01 0.078 "
                              "--load-from {} --load-until {}",
                              seed, mass, on, off)));
    std::vector<json> first, settled;
    for (const json& line : lines) {
      if (line.at("load").is_null()) continue;
      json load = line.at("load");
      load["time"] = line.at("time");
      fmt::print("seed {}: {}\n", seed, load.dump());
      (load.at("settled").get<bool>() ? settled : first).push_back(load);
    }
    ASSERT_EQ(first.size(), 2U);
    ASSERT_EQ(settled.size(), 2U);
    for (const std::size_t i : {0U, 1U}) {
      const double moment = i == 0 ? on : off, change = i == 0 ? mass : -mass;
      EXPECT_GT(first[i].at("time").get<double>(), moment);
      EXPECT_LT(first[i].at("time").get<double>(), moment + soon);
      EXPECT_GT(first[i].at("mass").get<double>() * change, 0.0);
      EXPECT_NEAR(settled[i].at("mass").get<double>(), change, share * mass);
      EXPECT_NEAR(settled[i].at("since").get<double>(), moment, 0.2);
      EXPECT_TRUE(settled[i].at("holds").get<bool>());
    }
  }
}

}  // namespace
}  // namespace shapeid::test
