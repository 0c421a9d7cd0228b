// What goes wrong while a robot runs is said on the line where it happens, and does not become an
// answer.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "shapeid/tests/app/command.hpp"
#include "shapeid/tests/track/logs.hpp"

namespace shapeid::test {
namespace {

using nlohmann::json;

// kg, of the bundled base.
constexpr double true_mass = 5.48;
// Of the tracked mass. The same log without faults stays within a fifth of this.
constexpr double near = 0.25;

std::size_t total(const std::vector<json>& lines, const char* group, const char* what) {
  std::size_t sum = 0;
  for (const json& line : lines) sum += line.at(group).at(what).get<std::size_t>();
  return sum;
}

std::size_t total_of(const std::vector<json>& lines, const char* fault, const char* channel) {
  std::size_t sum = 0;
  for (const json& line : lines) sum += line.at("rows").at(fault).value(channel, std::size_t{0});
  return sum;
}

double tracked_mass(const json& line) { return line.at("mass").at("tracked").get<double>(); }

/// No fault that the guard looks for.
bool clean(const json& line) {
  const json& rows = line.at("rows");
  return rows.at("outliers").empty() && rows.at("stuck").empty() && rows.at("saturated").empty();
}

TEST(TrackEvents, AnOrdinaryTrotHasNone) {
  const std::vector<json> lines = tracked(trot_log());
  ASSERT_GT(lines.size(), 150U);
  for (const json& line : lines) {
    EXPECT_EQ(line.at("format"), "shapeid-track-1");
    EXPECT_TRUE(clean(line)) << line.at("rows");
    EXPECT_TRUE(line.at("contacts").at("slipping").empty()) << line.at("time");
    EXPECT_TRUE(line.at("load").is_null()) << line.at("load");
    EXPECT_TRUE(line.at("doubt").is_null()) << line.at("time");
    EXPECT_EQ(line.at("scale"), "joint rows");
    EXPECT_GE(line.at("gap").get<double>(), 0.0);
  }
  EXPECT_EQ(total(lines, "rows", "repeated") + total(lines, "rows", "missing"), 0U);
  EXPECT_EQ(lines.back().at("line"), lines.size() - 1);
  EXPECT_LT(std::abs(tracked_mass(lines.back()) - true_mass), near);
}

/// The clock is judged by the log's own rows, whatever the grid between them.
TEST(TrackEvents, AFinerGridMissesNothing) {
  const Lines& log = trot_log();
  for (const char* rate : {"1000", "3000"}) {
    const std::vector<json> lines = tracked(log, fmt::format("--rate {} --window 60", rate));
    ASSERT_GT(lines.size(), 50U) << rate;
    EXPECT_EQ(total(lines, "rows", "missing") + total(lines, "rows", "gaps"), 0U) << rate;
    EXPECT_EQ(total(lines, "rows", "repeated"), 0U) << rate;
    EXPECT_LT(std::abs(tracked_mass(lines.back()) - true_mass), near) << rate;
  }
  scratch_file("trot.csv", joined(log));
  const CommandRun coarse = shapeid(track("--rate 100 trot.csv"));
  EXPECT_EQ(coarse.status, 2);
  EXPECT_NE(coarse.err.find("a grid of 100 Hz for a log of 500 Hz"), std::string::npos)
      << coarse.err;
}

/// What is kept for --recent has a limit that is told before the work.
TEST(TrackEvents, ALongerWindowThanThereIsRoomForIsRefused) {
  scratch_file("trot.csv", joined(trot_log()));
  const std::string words = fmt::format(
      "track --robot {0}quadruped.urdf --robot-yaml {0}quadruped.robot.yaml --whole-body trot.csv ",
      SHAPEID_SOURCE_DIR "/models/robots/");
  const CommandRun refused = shapeid(words + "--recent 3600");
  EXPECT_EQ(refused.status, 2);
  EXPECT_NE(refused.err.find("--recent 3600: 180000 windows of 130 parameters"), std::string::npos)
      << refused.err;
  EXPECT_EQ(shapeid(words + "--recent 5").status, 0);
}

/// What is taken for granted is said where nothing else says it.
TEST(TrackEvents, ARobotWithoutNotesIsSaidToHaveNone) {
  scratch_file("trot.csv", joined(without_contacts(trot_log())));
  const CommandRun copied =
      program(fmt::format("cp {}quadruped.urdf alone.urdf", SHAPEID_SOURCE_DIR "/models/robots/"));
  ASSERT_EQ(copied.status, 0) << copied.err;
  const CommandRun run = shapeid("track --robot alone.urdf --contacts none trot.csv");
  EXPECT_NE(run.err.find("warning: no robot.yaml beside alone.urdf"), std::string::npos) << run.err;
}

TEST(TrackEvents, OutliersAreLeftOut) {
  Lines log = trot_log();
  for (const std::size_t row : {600U, 777U, 1203U}) {
    change(log, "q.FL_knee", row, row + 1, [](double q) { return q + 1.0; });
    change(log, "base.accel.x", row + 40, row + 41, [](double) { return 300.0; });
    change(log, "tau.RR_hip", row + 80, row + 82, [](double) { return -500.0; });
  }
  const std::vector<json> lines = tracked(log);
  EXPECT_EQ(total_of(lines, "outliers", "q.FL_knee"), 3U);
  EXPECT_EQ(total_of(lines, "outliers", "base.accel.x"), 3U);
  EXPECT_EQ(total_of(lines, "outliers", "tau.RR_hip"), 6U);
  const std::vector<json> without = tracked(trot_log());
  ASSERT_EQ(lines.size(), without.size()) << "interpolated across, nothing restarts";
  EXPECT_LT(std::abs(tracked_mass(lines.back()) - tracked_mass(without.back())), 0.1 * near);
}

// The guard learns from the first second what is ordinary: until then only the scale can be judged.
TEST(TrackEvents, TorquesOutOfScaleAtFirstSpoilNoLaterWindow) {
  Lines log = trot_log();
  for (const char* joint : {"FR_hip", "RL_knee"}) {
    change(log, std::string("tau.") + joint, 0, 60, [](double tau) { return 1e9 * tau; });
  }
  const std::vector<json> lines = tracked(log);
  EXPECT_EQ(lines.front().at("why"), "window declined: forces that no robot has");
  const std::vector<json> without = tracked(trot_log());
  ASSERT_EQ(lines.size(), without.size());
  for (const char* estimate : {"window", "filtered", "recent"}) {
    EXPECT_NEAR(lines.back().at("mass").at(estimate).get<double>(),
                without.back().at("mass").at(estimate).get<double>(), 0.1 * near)
        << estimate;
  }
}

// What the limit of scale lets through (a filter spreads it over good windows, too) weighs as
// little as it is noisy, and says nothing about the noise of what follows.
TEST(TrackEvents, TorquesFarOffAtFirstAreForgotten) {
  for (const double factor : {1e2, 1e4, 1e6}) {
    Lines log = trot_log();
    for (const char* joint : {"FR_hip", "RL_knee"}) {
      change(log, std::string("tau.") + joint, 0, 60, [&](double tau) { return factor * tau; });
    }
    const std::vector<json> lines = tracked(log);
    for (const json& line : lines) EXPECT_TRUE(line.at("load").is_null()) << line.at("load");
    EXPECT_LT(std::abs(tracked_mass(lines.back()) - true_mass), near) << factor;
    EXPECT_LT(
        std::abs(lines.at(lines.size() / 2).at("mass").at("recent").get<double>() - true_mass),
        2.0 * near)
        << factor;
  }
}

TEST(TrackEvents, DroppedAndRepeatedRows) {
  Lines log = trot_log();
  log.insert(log.begin() + 900, log[900]);            // twice
  log.erase(log.begin() + 1200, log.begin() + 1203);  // three are lost
  std::swap(log[1500], log[1501]);                    // one comes late
  const std::vector<json> lines = tracked(log);
  EXPECT_EQ(total(lines, "rows", "repeated"), 2U);
  EXPECT_EQ(total(lines, "rows", "missing"), 4U);
  EXPECT_EQ(total(lines, "rows", "gaps"), 0U);
  EXPECT_LT(std::abs(tracked_mass(lines.back()) - true_mass), near);
}

// The window that the break interrupts is told before what came after it.
TEST(TrackEvents, TimesOfLinesIncreaseAcrossABreak) {
  for (const std::size_t first : {700U, 703U, 707U}) {
    Lines log = simulated("long", "--seconds 6 --rate 500");
    log.erase(log.begin() + static_cast<std::ptrdiff_t>(first),
              log.begin() + static_cast<std::ptrdiff_t>(first) + 1500);
    for (const char* options : {"", "--cutoff 6", "--window 3"}) {
      const std::vector<json> lines = tracked(log, options);
      EXPECT_EQ(total(lines, "rows", "gaps"), 1U);
      for (std::size_t k = 1; k < lines.size(); ++k) {
        EXPECT_LT(lines[k - 1].at("time").get<double>(), lines[k].at("time").get<double>())
            << "line " << k << ", a break after row " << first << " " << options;
      }
    }
  }
}

TEST(TrackEvents, AClockThatJumpsStartsFiltersAnew) {
  for (const double jump : {-1.5, 3600.0}) {
    Lines log = trot_log();
    change(log, "time", 1000, log.size(), [&](double t) { return t + jump; });
    const std::vector<json> lines = tracked(log);
    EXPECT_EQ(total(lines, "rows", jump < 0.0 ? "clock_back" : "gaps"), 1U) << jump;
    EXPECT_NEAR(lines.back().at("time").get<double>(), 4.0 + jump, 0.1);
    EXPECT_LT(std::abs(tracked_mass(lines.back()) - true_mass), near);
    // Only what the filter needs to settle is lost.
    const std::size_t whole = tracked(trot_log()).size();
    EXPECT_GT(lines.size() + 15, whole);
    EXPECT_LT(lines.size(), whole);
  }
}

// Mini Cheetah's logs have gaps more often than the rows that the rate is learned from: once that
// meant that no line ever came.
TEST(TrackEvents, GapsFromTheStartDelayNothingForGood) {
  constexpr std::size_t whole = 130, kept = 100;  // rows
  Lines log = {trot_log().front()};
  for (std::size_t row = 0; row + 1 < trot_log().size(); ++row) {
    if (row % whole < kept) log.push_back(trot_log()[row + 1]);
  }
  const std::vector<json> lines = tracked(log);
  const auto answered = std::count_if(lines.begin(), lines.end(),
                                      [](const json& line) { return line.at("answered") == true; });
  EXPECT_GE(answered, 40);
  EXPECT_GE(total(lines, "rows", "gaps"), 10U);
  ASSERT_FALSE(lines.empty());
  EXPECT_LT(std::abs(tracked_mass(lines.back()) - true_mass), near);
}

TEST(TrackEvents, AStuckOrSaturatedSensorGivesNoAnswersUntilItIsBack) {
  for (const bool saturated : {false, true}) {
    Lines log = trot_log();
    const std::string column = "tau.FR_knee";
    double stays = value(log, column, 800);
    if (saturated) {
      for (std::size_t row = 0; row < 1500; ++row) {
        stays = std::max(stays, 1.2 * std::abs(value(log, column, row)));
      }
    }
    change(log, column, 800, 1100, [&](double) { return stays; });
    const std::vector<json> lines = tracked(log);
    const char* const fault = saturated ? "saturated" : "stuck";
    EXPECT_GE(total_of(lines, fault, column.c_str()), 290U) << fault;
    for (const json& line : lines) {
      const double time = line.at("time").get<double>();
      // The guard looks back over all rows of the run that it still holds.
      if (time > 1.61 && time < 2.19) {
        EXPECT_FALSE(line.at("answered").get<bool>()) << time;
      }
    }
    const auto silent = std::find_if(lines.begin(), lines.end(), [](const json& line) {
      return line.at("why") == "no samples: see rows";
    });
    ASSERT_NE(silent, lines.end()) << "it must say that there is nothing to answer";
    EXPECT_TRUE(lines.back().at("answered").get<bool>());
    EXPECT_LT(std::abs(tracked_mass(lines.back()) - true_mass), near);
  }
}

TEST(TrackEvents, StandingStillKeepsTheAnswerAndWidensItsInterval) {
  Lines log = trot_log();
  const std::size_t from = 1200;
  // The last posture is held for two seconds: one row, with a little life in the IMU.
  Lines held(log.begin(), log.begin() + static_cast<std::ptrdiff_t>(from));
  const std::string last = held.back();
  for (std::size_t k = 0; k < 1000; ++k) held.push_back(last);
  const double start = value(log, "time", from - 2);
  std::size_t row = 0;
  change(held, "time", from - 1, held.size(),
         [&](double) { return start + 0.002 * static_cast<double>(++row); });
  for (const char* axis : {"x", "y", "z"}) {
    change(held, fmt::format("base.gyro.{}", axis), from - 1, held.size(),
           [&](double) { return 0.001 * std::sin(static_cast<double>(++row)); });
  }
  const std::vector<json> lines = tracked(held);
  std::vector<json> still;
  for (const json& line : lines) {
    if (line.at("why") == "stands still: nothing is excited") still.push_back(line);
  }
  ASSERT_GT(still.size(), 50U);
  EXPECT_FALSE(still.front().at("answered").get<bool>());
  EXPECT_EQ(still.front().at("links"), still.back().at("links")) << "the last answer stays";
  const auto width = [](const json& line) {
    const json& interval = line.at("mass").at("interval");
    return interval[1].get<double>() - interval[0].get<double>();
  };
  for (std::size_t k = 1; k < still.size(); ++k) EXPECT_GT(width(still[k]), width(still[k - 1]));
}

// In the air nothing but the known legs tells how heavy the base is.
TEST(TrackEvents, InTheAirTheScaleComesFromKnownLinks) {
  Lines log = trot_log();
  for (const char* foot : {"FR", "FL", "RR", "RL"}) {
    change(log, fmt::format("contact.{}_foot", foot), 1000, 1200, [](double) { return 0.0; });
  }
  const std::vector<json> lines = tracked(log);
  const auto from = [&](const char* scale) {
    return std::count_if(lines.begin(), lines.end(),
                         [&](const json& line) { return line.at("scale") == scale; });
  };
  EXPECT_GE(from("known links"), 10);
  EXPECT_GE(from("joint rows"), 100);
  EXPECT_GE(total(lines, "contacts", "airborne"), 140U);
}

// A pause up there touches nothing either.
TEST(TrackEvents, APauseInTheAirGivesNoScale) {
  constexpr std::size_t from = 1000, pause = 304;  // rows; no whole number of windows stands still
  Lines log = trot_log();
  const std::string posture = log[from];
  log.insert(log.begin() + from, pause, posture);
  const double start = value(log, "time", from - 2);
  std::size_t row = 0;
  change(log, "time", from - 1, log.size(),
         [&](double) { return start + 0.002 * static_cast<double>(++row); });
  for (const char* axis : {"x", "y", "z"}) {
    change(log, fmt::format("base.gyro.{}", axis), from - 1, from - 1 + pause,
           [&](double) { return 0.001 * std::sin(static_cast<double>(++row)); });
  }
  for (const char* foot : {"FR", "FL", "RR", "RL"}) {
    change(log, fmt::format("contact.{}_foot", foot), from - 100, log.size(),
           [](double) { return 0.0; });
  }
  const std::vector<json> lines = tracked(log);
  const auto after = std::find_if(lines.begin(), lines.end(), [](const json& line) {
    return line.at("answered") == true && line.at("samples").at("still") > 0;
  });
  ASSERT_NE(after, lines.end());
  EXPECT_EQ(after->at("scale"), "known links");
}

/// Nor is it said that a robot weighs nothing, with status 0.
TEST(TrackEvents, ContactsThatAreNotKnownAreCounted) {
  const auto with_unknown = [](std::size_t first, std::size_t last) {
    Lines log = trot_log();
    change(log, "contact.FL_foot", first, last, [](double) { return -1.0; });
    return log;
  };
  const std::vector<json> lines = tracked(with_unknown(1000, 1200));
  EXPECT_EQ(total(lines, "samples", "contacts_unknown"), 200U);
  const auto unanswered = std::count_if(lines.begin(), lines.end(), [](const json& line) {
    return line.at("why") == "no samples: contacts are not known";
  });
  EXPECT_GT(unanswered, 2);

  scratch_file("unknown.csv", joined(with_unknown(0, trot_log().size())));
  const CommandRun run = shapeid(track("unknown.csv"));
  expect_one_line(run, 1, "refused (no-data): unknown.csv: none of ");
  EXPECT_NE(run.err.find(" lines has an answer; the last says: no samples: contacts are not known"),
            std::string::npos)
      << run.err;
}

TEST(TrackEvents, AFootThatSlipsIsNamed) {
  Lines log = trot_log();
  // A stance foot's knee moves on by half a radian over a tenth of a second, as on ice.
  std::size_t first = 800;
  while (!(value(log, "contact.FL_foot", first) == 1.0 &&
           value(log, "contact.FL_foot", first - 1) == 0.0)) {
    ++first;
  }
  first += 10;
  std::size_t row = 0;
  change(log, "q.FL_knee", first, first + 60,
         [&](double q) { return q + 0.6 * static_cast<double>(++row) / 60.0; });
  change(log, "contact.FL_foot", first, first + 60, [](double) { return 1.0; });
  const std::vector<json> lines = tracked(log);
  const double time = value(log, "time", first);
  const auto named = std::find_if(lines.begin(), lines.end(), [&](const json& line) {
    const json& slipping = line.at("contacts").at("slipping");
    return std::find(slipping.begin(), slipping.end(), "FL_foot") != slipping.end();
  });
  ASSERT_NE(named, lines.end());
  EXPECT_GT(named->at("time").get<double>(), time);
  EXPECT_LT(named->at("time").get<double>(), time + 0.2);
}

}  // namespace
}  // namespace shapeid::test
