// report.html of a hinge with friction: what its tables, captions and pictures say.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "shapeid/app/diagnosis_result.hpp"
#include "shapeid/diagnosis/effects.hpp"
#include "shapeid/models/simbody/random.hpp"
#include "shapeid/tests/app/command.hpp"
#include "shapeid/tests/app/page_ids.hpp"
#include "shapeid/tests/support/files.hpp"

namespace shapeid::test {
namespace {

std::size_t times_in(const std::string& text, const std::string& what) {
  std::size_t times = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) {
    ++times;
  }
  return times;
}

/// A bar of 2 kg, 0.4 m from a level axis, whose joint holds so much friction (N m) against its
/// motion; 20 s, with noise of the torque.
/// `waves` (N m): of a sum of torques with a clock of their own, which no effect is.
void write_hinge(const std::string& name = "hinge", double friction = 0.5, unsigned seed = 5,
                 double waves = 0.0) {
  scratch_file("hinge.urdf",
               "<robot name='hinge'><link name='post'/><link name='bar'><inertial><origin xyz='0.4 "
               "0 0'/><mass value='2'/><inertia ixx='0.01' iyy='0.02' izz='0.02' ixy='0' ixz='0' "
               "iyz='0'/></inertial></link><joint name='swing' type='revolute'><parent "
               "link='post'/><child link='bar'/><axis xyz='0 -1 0'/><limit lower='-9' upper='9' "
               "effort='999' velocity='99'/></joint></robot>\n");
  Random random(seed);
  std::string log = "time,q.swing,dq.swing,ddq.swing,tau.swing\n";
  for (int i = 0; i < 4000; ++i) {
    const double t = 0.005 * i, u = 3.1 * t + std::sin(0.37 * t);
    const double du = 3.1 + 0.37 * std::cos(0.37 * t), ddu = -0.37 * 0.37 * std::sin(0.37 * t);
    const double q = std::sin(u), dq = du * std::cos(u), ddq = ddu * std::cos(u) - du * du * q;
    constexpr double g = 9.81, inertia = 0.02 + 2 * 0.4 * 0.4;
    log += fmt::format("{},{},{},{},{}\n", t, q, dq, ddq,
                       inertia * ddq + 2 * g * 0.4 * std::cos(q) + friction * std::tanh(dq / 0.05) +
                           waves * (std::sin(17.0 * t) + std::sin(11.3 * t + 1.0)) +
                           0.02 * random.normal());
  }
  scratch_file(name + ".csv", log);
}

struct Reported {
  std::string text, page;
  nlohmann::json result;
};

/// Of the hinge, whose inertias are as given.
Reported reported(const std::string& options, const std::string& name) {
  write_hinge();
  const CommandRun run = shapeid(fmt::format(
      "diagnose --robot hinge.urdf --log hinge.csv --trust {} --out {}", options, name));
  EXPECT_EQ(run.status, 0) << run.err;
  const std::string folder = scratch() + "/" + name;
  return {run.out, text_of(folder + "/report.html"),
          nlohmann::json::parse(text_of(folder + "/result.json"))};
}

/// The line of the text that begins with a row's name, without its end.
std::string row_of(const std::string& text, const std::string& name) {
  const std::size_t at = text.find("\n  " + name + " ");
  return at == std::string::npos ? "" : text.substr(at + 1, text.find('\n', at + 1) - at - 1);
}

TEST(Report, EveryPanelOfAHingeHasItsLabels) {
  const std::string page = reported("--cutoff 20", "labels").page;
  EXPECT_EQ(times_in(page, "<text>time (s)<"), 2U);
  EXPECT_EQ(times_in(page, "<text>residual (N m)<"), 2U) << "beside the torque, and scattered";
  EXPECT_EQ(times_in(page, "<text>torque (N m)<"), 1U);
  EXPECT_EQ(times_in(page, "<text>predicted torque (N m)<"), 1U);
  EXPECT_EQ(times_in(page, "<text>lag (s)<"), 1U);
  for (const char* label : {"velocity (rad/s)", "position (rad)", "residual (N m, rms)"}) {
    EXPECT_EQ(times_in(page, fmt::format("<text>{}<", label)), 1U) << label;
  }
}

/// What answers depend on stands on the page and beside it.
TEST(Report, SaysHowItWasMade) {
  const Reported report = reported("--cutoff 20", "made");
  for (const char* cell : {">hinge.urdf<", ">20 Hz, zero phase<", ">200 Hz<", ">contacts<"}) {
    EXPECT_EQ(times_in(report.page, cell), 1U) << cell;
  }
  EXPECT_EQ(times_in(report.page, "none: the given inertias are trusted"), 1U);
  EXPECT_EQ(times_in(report.page, "No link was sought."), 1U);
  EXPECT_NEAR(report.result["rate"].get<double>(), 200.0, 1e-9);
  EXPECT_EQ(report.result["contacts"], "none");
  EXPECT_TRUE(report.result["mapping"].is_null());
}

/// Names that stand and descriptions are two tables, as they are two lists beside the page.
TEST(Report, WhatOnlyDescribesHasATableOfItsOwn) {
  const Reported report = reported("--cutoff 20", "two");
  const std::size_t found = report.page.find("<h2>What was found</h2>");
  const std::size_t apart = report.page.find("<h2>What predicts, and is not the cause</h2>");
  ASSERT_NE(found, std::string::npos);
  EXPECT_EQ(apart == std::string::npos, report.result["descriptions"].empty());
  for (const auto& finding : report.result["findings"]) {
    const std::string id = fmt::format(">{}@{}</td>", finding["effect"].get<std::string>(),
                                       finding["site"].get<std::string>());
    const std::size_t at = report.page.find(id, found);
    EXPECT_TRUE(at != std::string::npos && at < apart) << id;
  }
}

TEST(Report, ItsPicturesHaveIdsOfTheirOwnAndNoTooltips) {
  const std::string page = reported("--cutoff 20", "ids").page;
  EXPECT_GT(times_in(page, "<svg"), 3U);
  EXPECT_EQ(times_in(page, "<title>"), 1U) << "that of the page";
  const PageIds ids = ids_of(page);
  EXPECT_GT(ids.references.size(), 100U);
  EXPECT_EQ(ids.twice(), "");
  EXPECT_EQ(ids.missing(), "");
}

TEST(Report, ItsFindingsHaveTheirShapeNumbers) {
  const Reported report = reported("--cutoff 20", "shapes");
  const auto& findings = report.result["findings"];
  ASSERT_FALSE(findings.empty()) << report.text;
  ASSERT_EQ(findings[0]["effect"], "coulomb_friction");
  const auto& width = findings[0]["values"]["width"];
  EXPECT_FALSE(width.contains("standard_error")) << "as docs/formats/diagnosis.md has it";
  const std::string row =
      fmt::format("<td>width = {:.3g}</td><td>-</td><td>rad/s</td>", width["value"].get<double>());
  EXPECT_NE(report.page.find(row), std::string::npos) << row;
}

/// What a filter takes away tells the noise; where nothing was taken away nothing is told.
TEST(Report, TheNoiseFloorIsExplainedAndNoneWithoutAFilter) {
  const Reported filtered = reported("--cutoff 20", "filtered");
  const double floor = filtered.result["heldout"]["noise_floor"][0];
  // White noise of 0.02 N m behind 20 of 100 Hz.
  EXPECT_GT(floor, 0.003);
  EXPECT_LT(floor, 0.02);
  EXPECT_NE(filtered.page.find("Noise floor: what noise of the logged torque leaves"),
            std::string::npos);
  EXPECT_NE(filtered.page.find("<text>noise floor<"), std::string::npos) << "its mark";
  for (const char* options : {"--cutoff 0", "--exact"}) {
    const Reported raw = reported(options, "raw");
    EXPECT_TRUE(raw.result["heldout"]["noise_floor"][0].is_null()) << raw.result["heldout"];
    for (const char* name : {"swing", "all joints"}) {
      // Of the columns zero, given, usual, found, noise floor, unfiltered this is the only dash.
      EXPECT_EQ(times_in(row_of(raw.text, name), " - "), 1U) << raw.text;
      EXPECT_EQ(times_in(raw.page, fmt::format("<tr><td>{}</td>", name)), 1U);
    }
    EXPECT_NE(raw.page.find("<td>-</td>"), std::string::npos);
    EXPECT_NE(raw.page.find("without a filter nothing is known of it"), std::string::npos);
    EXPECT_EQ(raw.page.find("<text>noise floor<"), std::string::npos);
  }
}

/// Friction that went is a finding, with its time, and no part of the model that is written out.
TEST(Report, SaysWhatWentSinceTheReferenceLog) {
  write_hinge();
  write_hinge("smooth", 0.0, 6);
  const CommandRun run = shapeid(
      "diagnose --robot hinge.urdf --log smooth.csv --reference hinge.csv --trust --exact "
      "--out went");
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_NE(run.out.find("was in the reference log and is gone"), std::string::npos) << run.out;
  const auto folder = [](const std::string& name) { return text_of(scratch() + "/went/" + name); };
  const auto result = nlohmann::json::parse(folder("result.json"));
  ASSERT_EQ(result["findings"].size(), 1U) << result["findings"];
  const nlohmann::json& finding = result["findings"][0];
  EXPECT_EQ(finding["effect"], "coulomb_friction");
  EXPECT_NEAR(finding["value"].get<double>(), 0.5, 0.02);
  EXPECT_TRUE(finding["gone_since_reference"].get<bool>());
  EXPECT_FALSE(finding["since_reference"].get<bool>());
  EXPECT_FALSE(finding["may_act_in_both"].get<bool>());
  EXPECT_EQ(folder("effects.yaml"), "effects: []\n");
  EXPECT_EQ(folder("predict_torque.hpp").find("coulomb"), std::string::npos);
  EXPECT_NE(folder("report.html").find("was in the reference log and is gone"), std::string::npos);
}

/// Of what no effect is the model knows nothing, in either log.
TEST(Report, SaysWhatIsLeftOfTheReferenceLog) {
  write_hinge();
  write_hinge("smooth", 0.0, 6);
  write_hinge("strange", 0.5, 6, 0.3);
  const auto is_said = [](const std::string& log, const std::string& reference) {
    const auto result = diagnosed(fmt::format(
        "--robot hinge.urdf --log {}.csv --reference {}.csv --trust --cutoff 20", log, reference));
    return std::ranges::any_of(result["notes"], [](const std::string& note) {
      return note.find("of the reference log the model leaves far more") != std::string::npos;
    });
  };
  EXPECT_TRUE(is_said("hinge", "strange"));
  EXPECT_FALSE(is_said("smooth", "hinge"));
  EXPECT_FALSE(is_said("hinge", "smooth"));
}

TEST(Report, SaysWhyAnEffectWasLeftOut) {
  const diagnosis::Effect load = diagnosis::payload(), later = diagnosis::payload_from(),
                          friction = diagnosis::viscous_friction();
  const auto why = [](const diagnosis::Effect& effect) {
    return app::why_left_out({&effect, 0, {}, {}});
  };
  EXPECT_NE(why(load).find("no mass"), std::string::npos);
  EXPECT_EQ(why(later), why(load));
  EXPECT_NE(why(friction).find("its sign is impossible"), std::string::npos);
}

}  // namespace
}  // namespace shapeid::test
