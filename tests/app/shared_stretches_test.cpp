// Logs that hold the same measurements, and logs that only look alike.
#include "shapeid/app/shared_stretches.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <string>

#include "shapeid/models/error.hpp"
#include "shapeid/tests/support/scratch_folder.hpp"

namespace shapeid::test {
namespace {

using app::LogsByUse;
using app::refuse_same_data;

/// A joint that swings, read by a coarse encoder and a coarse torque sensor, both noisy.
struct Swing {
  std::size_t rows = 4000;
  unsigned seed = 1;
  std::size_t begins = 0;  ///< row of the same experiment
  double clock = 0.0;      ///< s at the first row
  bool swapped = false;
  bool numbered = false;
};

std::string log_of(const Swing& swing) {
  std::mt19937 random(swing.seed);
  std::normal_distribution<double> noise;
  const std::string number = swing.numbered ? ",seq" : "";
  std::string text = (swing.swapped ? "tau.a,time,q.a" : "time,q.a,tau.a") + number + "\n";
  for (std::size_t k = 0; k < swing.begins + swing.rows; ++k) {
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(k) / 500.0;
    const double q = std::round(300.0 * std::sin(angle) + noise(random)) / 600.0;
    const double tau = std::round(20.0 * std::cos(angle) + noise(random)) / 10.0;
    if (k < swing.begins) continue;
    const double time = swing.clock + 0.002 * static_cast<double>(k - swing.begins);
    text += swing.swapped ? fmt::format("{},{},{}", tau, time, q)
                          : fmt::format("{},{},{}", time, q, tau);
    text += swing.numbered ? fmt::format(",{}\n", k - swing.begins) : "\n";
  }
  return text;
}

class SharedStretches : public testing::Test {
 protected:
  std::string log(const std::string& name, const Swing& swing) {
    return folder_.write(name, log_of(swing));
  }
  static void expect_refused(const LogsByUse& logs, const std::string& says,
                             const std::optional<Mapping>& mapping = std::nullopt) {
    try {
      refuse_same_data(logs, mapping);
      ADD_FAILURE() << "taken";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(says), std::string::npos) << error.what();
    }
  }

  ScratchFolder folder_;
};

TEST_F(SharedStretches, TheSameMotionMeasuredAgainIsAnotherLog) {
  const std::string one = log("one.csv", {}), other = log("other.csv", {.seed = 2}),
                    third = log("third.csv", {.seed = 3});
  EXPECT_NO_THROW(refuse_same_data({{one, other}, {}, {third}}, std::nullopt));
}

TEST_F(SharedStretches, ACopyIsSeenThroughClocksAndColumns) {
  const std::string one = log("one.csv", {});
  const std::string tested = "one.csv, which is fitted; a test on data";
  expect_refused({{one}, {}, {log("later.csv", {.clock = 12.5})}}, tested);
  expect_refused({{one}, {}, {log("swapped.csv", {.swapped = true})}}, tested);
  expect_refused({{one}, {}, {log("numbered.csv", {.numbered = true})}}, tested);
  expect_refused({{one}, {}, {log("cut.csv", {.rows = 300, .begins = 3700})}}, tested);
  expect_refused({{log("part.csv", {.rows = 300, .begins = 1200})}, {}, {one}},
                 "part.csv, which is fitted; a test on data");
  expect_refused({{one, log("again.csv", {.rows = 2000, .begins = 3500})}, {}, {}},
                 "one.csv; each measurement once");
  expect_refused({{one}, {}, {log("a.csv", {.seed = 5}), log("b.csv", {.seed = 5, .clock = 1.0})}},
                 "a.csv; each measurement once");
  expect_refused({{one}, {}, {log("same.csv", {})}}, "same.csv: is fitted, too");
}

/// A tenth is what fits hardly notice.
TEST_F(SharedStretches, LogsMayOverlapALittle) {
  const std::string one = log("one.csv", {}),
                    next = log("next.csv", {.rows = 4000, .begins = 3700});
  EXPECT_NO_THROW(refuse_same_data({{one}, {}, {next}}, std::nullopt));
}

/// What was logged before may be what the log begins with; a test is neither.
TEST_F(SharedStretches, AnEarlierLogMayBeAPartOfTheFittedOne) {
  const std::string one = log("one.csv", {}), before = log("before.csv", {.rows = 1500});
  EXPECT_NO_THROW(refuse_same_data({{one}, {before}, {}}, std::nullopt));
  const std::string other = log("other.csv", {.seed = 2});
  expect_refused({{other}, {before}, {one}}, "before.csv, which is fitted");
}

/// A robot that stands, and a simulated one that repeats itself, read the same in any log.
TEST_F(SharedStretches, RestIsNoCopy) {
  std::string still = "time,q.a,tau.a\n";
  for (int k = 0; k < 2000; ++k) still += fmt::format("{},0.25,1.5\n", 0.002 * k);
  const std::string one = folder_.write("one.csv", still);
  const std::string other = folder_.write("other.csv", still + "9,0.25,1.5\n");
  EXPECT_NO_THROW(refuse_same_data({{one}, {}, {other}}, std::nullopt));
}

TEST_F(SharedStretches, ForeignNamesAreTheMappings) {
  const auto renamed = [&](const std::string& name, const Swing& swing) {
    std::string text = log_of(swing);
    text.replace(0, text.find('\n'), "stamp,angle,load");
    return folder_.write(name, text);
  };
  Mapping mapping;
  mapping.columns["time"].from = "stamp";
  mapping.columns["q.a"].from = "angle";
  mapping.columns["tau.a"].from = "load";
  const std::string one = renamed("one.csv", {}), later = renamed("later.csv", {.clock = 3.0});
  expect_refused({{one}, {}, {later}}, "which is fitted", mapping);
  EXPECT_NO_THROW(refuse_same_data({{one}, {}, {renamed("other.csv", {.seed = 2})}}, mapping));
}

/// More stretches than are kept: the smallest digests tell of a part as well.
TEST_F(SharedStretches, LongLogsAreComparedByASample) {
  const std::string one = log("one.csv", {.rows = 150000});
  expect_refused({{one}, {}, {log("cut.csv", {.rows = 3000, .begins = 90000})}}, "which is fitted");
  EXPECT_NO_THROW(
      refuse_same_data({{one}, {}, {log("other.csv", {.rows = 3000, .seed = 2})}}, std::nullopt));
}

}  // namespace
}  // namespace shapeid::test
