// diagnose on a simulated trot whose knee has friction that the model lacks, and its files in use.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "shapeid/tests/app/changed_log.hpp"
#include "shapeid/tests/app/command.hpp"
#include "shapeid/tests/support/files.hpp"

namespace shapeid::test {
namespace {

/// The log with a function of one column added to the torque of a joint.
void add_torque(const std::string& from, const std::string& to, const std::string& joint,
                const std::string& over, const std::function<double(double)>& torque) {
  write_changed(from, to, [&](NamedRow& row) { row["tau." + joint] += torque(row[over]); });
}

TEST(Diagnose, FindsAKneesFrictionAndItsFilesAreOfUse) {
  simulated_log("clean.csv.gz", "--seconds 10");
  add_torque("clean.csv.gz", "rough.csv.gz", "FR_knee", "dq.FR_knee",
             [](double dq) { return 0.4 * dq; });
  // Whatever the user's gnuplot draws on.
  const CommandRun run = program(
      "GNUTERM=none_of_this_name " +
      command(fmt::format("diagnose {} --log rough.csv.gz --json --out why", quadruped_files)));
  ASSERT_EQ(run.status, 0) << run.err;
  const auto result = nlohmann::json::parse(run.out);
  const auto& findings = result["findings"];
  const auto knee = std::find_if(findings.begin(), findings.end(), [](const auto& f) {
    return f["effect"] == "viscous_friction" && f["site"] == "FR_knee";
  });
  ASSERT_NE(knee, findings.end()) << findings.dump(2);
  constexpr double errors = 5.0;
  EXPECT_LT(std::abs((*knee)["value"].get<double>() - 0.4),
            errors * (*knee)["standard_error"].get<double>());
  const auto& rows = result["heldout"]["rows"];
  const auto at =
      static_cast<std::size_t>(std::find(rows.begin(), rows.end(), "FR_knee") - rows.begin());
  EXPECT_LT(result["heldout"]["rms_after"][at].get<double>(),
            0.5 * result["heldout"]["rms_before"][at].get<double>());

  const std::string folder = scratch() + "/why/";
  const std::string damping =
      fmt::format("<dynamics damping=\"{}\" friction", (*knee)["value"].get<double>());
  EXPECT_NE(text_of(folder + "identified.urdf").find(damping), std::string::npos);
  const std::string page = text_of(folder + "report.html");
  EXPECT_NE(page.find("viscous_friction@FR_knee"), std::string::npos);
  EXPECT_EQ(page.find("http://localhost"), std::string::npos);
  const CommandRun again = shapeid(
      fmt::format("identify {} --log rough.csv.gz --effects why/effects.yaml --divisions 2 --json",
                  quadruped_files));
  ASSERT_EQ(again.status, 0) << again.err;
  EXPECT_LT(nlohmann::json::parse(again.out)["heldout"]["rms_after"][at].get<double>(),
            0.5 * result["heldout"]["rms_before"][at].get<double>());

  const CommandRun fast =
      shapeid(fmt::format("diagnose {} --log rough.csv.gz --json --path fast", quadruped_files));
  ASSERT_EQ(fast.status, 0) << fast.err;
  const auto same = nlohmann::json::parse(fast.out);
  EXPECT_EQ(result["path"], "reference");
  EXPECT_EQ(same["path"], "fast");
  ASSERT_EQ(same["findings"].size(), findings.size());
  for (std::size_t k = 0; k < findings.size(); ++k) {
    EXPECT_EQ(same["findings"][k]["site"], findings[k]["site"]);
    const auto value = findings[k]["value"].get<double>();
    constexpr double rounding = 1e-6;  // enlarged by the loop's many fits
    EXPECT_NEAR(same["findings"][k]["value"].get<double>(), value, rounding * std::abs(value));
  }
}

/// Names are what a URDF says, and go into scripts of a plotting program.
TEST(Diagnose, DrawsJointsOfAnyName) {
  const std::string name = "left'hip'; system('touch drawn_by_name'); x='\"y\"";
  const std::string in_xml = "left'hip'; system('touch drawn_by_name'); x='&quot;y&quot;";
  const std::string in_csv = "left'hip'; system('touch drawn_by_name'); x='\"\"y\"\"";
  simulated_log("named.csv", "--seconds 10");
  const auto renamed = [](std::string text, const std::string& to) {
    const std::string from = "FR_hip";
    for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size()) {
      text.replace(at, from.size(), to);
    }
    return text;
  };
  const std::string log = text_of(scratch() + "/named.csv");
  const std::size_t line = log.find('\n');
  std::string header;
  for (std::size_t from = 0; from < line;) {
    const std::size_t end = std::min(log.find(',', from), line);
    const std::string column = log.substr(from, end - from);
    header += header.empty() ? "" : ",";
    header +=
        column.find("FR_hip") == std::string::npos ? column : '"' + renamed(column, in_csv) + '"';
    from = end + 1;
  }
  scratch_file("named.csv", header + log.substr(line));
  scratch_file("named.urdf", renamed(text_of(robots + "quadruped.urdf"), in_xml));
  const CommandRun run = shapeid(
      fmt::format("diagnose --robot named.urdf --robot-yaml {}quadruped.robot.yaml --log named.csv "
                  "--trust --json --out named",
                  robots));
  ASSERT_EQ(run.status, 0) << run.err;
  const auto result = nlohmann::json::parse(run.out);
  const auto& rows = result["heldout"]["rows"];
  EXPECT_NE(std::find(rows.begin(), rows.end(), name), rows.end()) << rows.dump();
  EXPECT_EQ(result["notes"].dump().find("asks for no mass"), std::string::npos) << "none is sought";
  EXPECT_TRUE(std::filesystem::exists(scratch() + "/named/report.html"));
  EXPECT_FALSE(std::filesystem::exists(scratch() + "/drawn_by_name"));
}

TEST(Diagnose, NeedsUsableSamplesToTestOn) {
  simulated_log("long.csv", "--seconds 8");
  simulated_log("short.csv", "--seconds 0.2 --seed 3");
  const CommandRun run = shapeid(
      fmt::format("diagnose {} --log long.csv --test short.csv --out short", quadruped_files));
  EXPECT_EQ(run.status, 1);
  EXPECT_NE(run.err.find("refused (no-data): nothing is left to test on: of "), std::string::npos)
      << run.err;
}

/// A knee that is pulled by the hip of another leg has no name. As a curve it predicts, here and
/// where `identify` takes it as known.
/// A foot that carries little before it lifts is no foot in the air: at 0.15 of the weight a delay
/// of the torque was found in such logs, by five standard errors and more.
TEST(Diagnose, FindsNothingWhereContactsAreDerived) {
  simulated_log("clean.csv.gz", "--seconds 10");
  write_changed("clean.csv.gz", "derived.csv", as_it_is, {"contact."});
  const nlohmann::json result = diagnosed(quadruped_files + " --log derived.csv");
  EXPECT_TRUE(result["findings"].empty()) << result["findings"].dump(2);
  EXPECT_TRUE(result["descriptions"].empty()) << result["descriptions"].dump(2);
  EXPECT_NE(result["notes"].dump().find("no contact.* columns"), std::string::npos);
}

TEST(Diagnose, WritesWhatHasNoNameAsCurves) {
  simulated_log("even.csv.gz", "--seconds 10");
  add_torque("even.csv.gz", "pulled.csv.gz", "FR_knee", "q.RL_hip",
             [](double q) { return 3.0 * std::sin(5.0 * q); });
  const CommandRun run = shapeid(fmt::format(
      "diagnose {} --log pulled.csv.gz --trust --curves --json --out drawn", quadruped_files));
  ASSERT_EQ(run.status, 0) << run.err;
  const auto result = nlohmann::json::parse(run.out);
  ASSERT_FALSE(result["curves"].empty());
  const auto& held = result["heldout"];
  const auto knee = static_cast<std::size_t>(
      std::find(held["rows"].begin(), held["rows"].end(), "FR_knee") - held["rows"].begin());
  const double found = held["rms_after"][knee], with_curves = held["rms_with_curves"][knee];
  EXPECT_LT(with_curves, 0.5 * found);
  const CommandRun again = shapeid(fmt::format(
      "identify {} --log pulled.csv.gz --effects drawn/effects.yaml --divisions 2 --json",
      quadruped_files));
  ASSERT_EQ(again.status, 0) << again.err;
  EXPECT_LT(nlohmann::json::parse(again.out)["heldout"]["rms_after"][knee].get<double>(),
            0.5 * found);
}

TEST(Diagnose, FitsAndTestsSeveralLogsTogether) {
  for (const char* seed : {"1", "2", "3", "4"}) {
    simulated_log(fmt::format("run{}.csv", seed), fmt::format("--seconds 4 --seed {}", seed));
  }
  const auto one = diagnosed(quadruped_files + " --log run1.csv --test run3.csv");
  const auto two =
      diagnosed(quadruped_files + " --log run1.csv --also run2.csv --test run3.csv run4.csv");
  // Blocks have margins at their ends, which costs a few samples more or less.
  const auto samples = [](const nlohmann::json& r) { return r["samples"].get<double>(); };
  EXPECT_NEAR(samples(two) / samples(one), 2.0, 0.05);
  // Every second sample or so of each log counts: one more or less where the stride begins anew.
  EXPECT_NEAR(two["heldout"]["samples"].get<int>(), 2 * one["heldout"]["samples"].get<int>(), 1);
}

/// What is fitted and what is held out are parts of one log: what is put on at its twelfth second
/// is there in the stretch from the eighteenth on.
TEST(Diagnose, ALoadActsFromItsMomentAlsoInWhatIsHeldOut) {
  simulated_log("load.csv", "--seconds 20 --load 2 0.1 0.02 0.05 --load-from 12");
  const CommandRun run =
      shapeid(fmt::format("diagnose {} --trust --log load.csv --out loaded", quadruped_files));
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_NE(run.out.find("its centre at (0.1"), std::string::npos) << run.out;
  const auto result = nlohmann::json::parse(text_of(scratch() + "/loaded/result.json"));
  const auto& findings = result["findings"];
  const auto load = std::find_if(findings.begin(), findings.end(), [](const auto& f) {
    return f["effect"] == "payload_from" && f["site"] == "base";
  });
  ASSERT_NE(load, findings.end()) << findings.dump(2);
  const auto value = [&](const char* name) {
    return (*load)["values"][name]["value"].get<double>();
  };
  EXPECT_NEAR(value("m"), 2.0, 0.1);
  EXPECT_NEAR(value("mrx") / value("m"), 0.1, 0.02);
  EXPECT_NEAR(value("mry") / value("m"), 0.02, 0.02);
  const auto squares = [&](const char* of) {
    double sum = 0.0;
    for (const auto& rms : result["heldout"][of]) sum += std::pow(rms.get<double>(), 2);
    return sum;
  };
  // Without the load the error would be what it was before.
  EXPECT_LT(squares("rms_after"), 0.1 * squares("rms_before"));
}

TEST(Diagnose, TestsOnNothingThatIsFitted) {
  simulated_log("run.csv", "--seconds 2");
  simulated_log("other.csv", "--seconds 2 --seed 2");
  const auto expect_refused = [](const std::string& logs, const std::string& says) {
    const CommandRun run = shapeid(fmt::format("diagnose {} {}", quadruped_files, logs));
    EXPECT_EQ(run.status, 2) << logs;
    EXPECT_NE(run.err.find(says), std::string::npos) << run.err;
  };
  expect_refused("--log run.csv --test ./run.csv", "./run.csv: is fitted, too");
  expect_refused("--log other.csv --also run.csv --test run.csv", "run.csv: is fitted, too");
  expect_refused("--log run.csv --reference other.csv --test other.csv",
                 "other.csv: is fitted, too");
  expect_refused("--log run.csv --reference run.csv", "run.csv: is given twice");
  expect_refused("--log run.csv --also other.csv run.csv", "run.csv: is given twice");
  expect_refused("--log run.csv --test other.csv other.csv", "other.csv: is given twice");
}

/// Copies, logs with another clock, and what was cut out of a log are no data of their own.
TEST(Diagnose, TestsOnNoCopyOfWhatIsFitted) {
  simulated_log("fitted.csv", "--seconds 2");
  simulated_log("else.csv", "--seconds 2 --seed 2");
  std::filesystem::copy_file(scratch() + "/fitted.csv", scratch() + "/copy.csv",
                             std::filesystem::copy_options::overwrite_existing);
  write_changed("fitted.csv", "later.csv", [](NamedRow& row) { row["time"] += 100.0; });
  const auto end_of = [](const std::string& file) {
    const std::string text = text_of(scratch() + "/" + file);
    return text.substr(text.find('\n', text.size() / 2) + 1);
  };
  const std::string fitted = text_of(scratch() + "/fitted.csv");
  scratch_file("end.csv", fitted.substr(0, fitted.find('\n') + 1) + end_of("fitted.csv"));
  scratch_file("joined.csv", text_of(scratch() + "/else.csv") + end_of("later.csv"));
  const auto expect_refused = [](const std::string& words, const std::string& says) {
    expect_one_line(shapeid(fmt::format("{} {}", words, quadruped_files)), 2, says);
  };
  expect_refused("diagnose --log fitted.csv --test copy.csv", "copy.csv: is fitted, too");
  const std::string as_well = "holds measurements of fitted.csv";
  for (const std::string name : {"later.csv", "end.csv", "joined.csv"}) {
    const std::string tested = fmt::format("--log fitted.csv --test {}", name);
    expect_refused("diagnose " + tested, as_well + ", which is fitted; a test on data");
    expect_refused("identify " + tested, as_well + ", which is fitted; a test on data");
    if (name == "joined.csv") continue;  // nor is it beside else.csv, which comes first
    expect_refused("diagnose --log else.csv --also fitted.csv " + name, as_well + "; each");
  }
  expect_refused("diagnose --log else.csv --reference fitted.csv --test end.csv",
                 "which is fitted");
  expect_refused("batch --log fitted.csv else.csv copy.csv", "copy.csv: is given twice");
}

TEST(Diagnose, LogsOfDifferentRatesAreNotMixed) {
  simulated_log("run.csv", "--seconds 2");
  simulated_log("slow.csv", "--seconds 2 --rate 250");
  const CommandRun run =
      shapeid(fmt::format("diagnose {} --log run.csv --also slow.csv", quadruped_files));
  EXPECT_EQ(run.status, 2);
  EXPECT_NE(run.err.find("slow.csv: has 250 samples a second, run.csv has 500"), std::string::npos)
      << run.err;
}

/// What is only tested on, or came before, means the same as what is diagnosed.
TEST(Diagnose, OtherLogsAreCheckedAsTheLogIs) {
  simulated_log("run.csv", "--seconds 4");
  simulated_log("other.csv", "--seconds 4 --seed 2");
  write_changed("other.csv", "turned.csv",
                [](NamedRow& row) { row.each("tau.", [](double& tau) { tau = -tau; }); });
  for (const char* option : {"also", "test", "reference"}) {
    const CommandRun run = shapeid(fmt::format(
        "diagnose {} --trust --json --log run.csv --{} turned.csv", quadruped_files, option));
    EXPECT_EQ(run.status, 1) << option;
    EXPECT_EQ(run.out, "");
    EXPECT_NE(run.err.find("refused (torque-sign): turned.csv: "), std::string::npos) << run.err;
  }
}

TEST(Diagnose, LoggedAndDerivedContactsAreNotMixed) {
  simulated_log("run.csv", "--seconds 4");
  simulated_log("flagged.csv", "--seconds 4 --seed 2");
  write_changed("flagged.csv", "derived.csv", as_it_is, {"contact."});
  const auto refused = [](const std::string& verb, const std::string& option,
                          const std::string& first, const std::string& other) {
    const CommandRun run =
        shapeid(fmt::format("{} {} --log {} --{} {}", verb, quadruped_files, first, option, other));
    EXPECT_EQ(run.status, 2) << verb << " --" << option;
    EXPECT_EQ(run.out, "");
    return run.err;
  };
  const std::string words = "contact.* columns, and ";
  for (const auto& [verb, option] : {std::pair("diagnose --trust --json", "also"),
                                     {"diagnose --trust --json", "test"},
                                     {"diagnose --trust --json", "reference"},
                                     {"identify --free base --json", "test"}}) {
    const std::string first = refused(verb, option, "run.csv", "derived.csv");
    EXPECT_NE(first.find("derived.csv: has no " + words + "run.csv has some"), std::string::npos)
        << first;
    const std::string second = refused(verb, option, "derived.csv", "run.csv");
    EXPECT_NE(second.find("run.csv: has " + words + "derived.csv has none"), std::string::npos)
        << second;
  }
}

TEST(Diagnose, NotesOfFurtherLogsNameThem) {
  simulated_log("run.csv", "--seconds 4");
  simulated_log("fast.csv", "--seconds 4 --seed 2");
  simulated_log("test.csv", "--seconds 4 --seed 3");
  write_changed("fast.csv", "slopeless.csv", as_it_is, {"dq."});
  const CommandRun run =
      shapeid(fmt::format("diagnose {} --trust --json --log run.csv --also slopeless.csv "
                          "--test test.csv",
                          quadruped_files));
  ASSERT_EQ(run.status, 0) << run.err;
  const auto result = nlohmann::json::parse(run.out);
  const auto& notes = result["notes"];
  EXPECT_TRUE(std::any_of(notes.begin(), notes.end(), [](const auto& note) {
    return note.template get<std::string>().starts_with("slopeless.csv: no dq.* columns");
  })) << notes.dump(2);
}

TEST(Diagnose, RefusesAPathThatIsNone) {
  const CommandRun run =
      shapeid(fmt::format("diagnose {} --log x.csv --path slow", quadruped_files));
  EXPECT_EQ(run.status, 2);
  EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
  EXPECT_NE(run.err.find("--path"), std::string::npos) << run.err;
}

/// A lag asks for the samples around each one, in the fit as in the residual.
TEST(Diagnose, MassesAreFoundBesideALagThatIsKnown) {
  simulated_log("even.csv.gz", "--seconds 4");
  const auto masses = [&](const std::string& yaml) {
    scratch_file("known.yaml", yaml);
    const CommandRun run = shapeid(
        fmt::format("identify {} --log even.csv.gz --effects known.yaml --divisions 2 --json",
                    quadruped_files));
    EXPECT_EQ(run.status, 0) << run.err;
    return nlohmann::json::parse(run.out)["links"].dump();
  };
  const std::string lag = "effects:\n  - {effect: torque_lag, site: FR_knee, values: {T: ";
  const std::string none = masses("effects: []\n");
  EXPECT_EQ(masses(lag + "0}}\n"), none);
  EXPECT_NE(masses(lag + "0.03}}\n"), none);
}

TEST(Diagnose, ListsTheCatalogue) {
  for (const char* beside : {"--cutoff -5", "extra", "--robot nope", "--json"}) {
    expect_one_line(shapeid(fmt::format("diagnose --list {}", beside)), 2, "--list: stands alone");
  }
  const CommandRun run = shapeid("diagnose --list");
  EXPECT_EQ(run.status, 0);
  EXPECT_EQ(run.out, text_of(SHAPEID_SOURCE_DIR "/docs/effects.md"));
}

TEST(Diagnose, EffectsThatDoNotExistAreRefusedWithTheirLine) {
  simulated_log("short.csv.gz", "--seconds 2");
  const auto refused = [&](const std::string& yaml) {
    scratch_file("effects.yaml", yaml);
    const CommandRun run = shapeid(
        fmt::format("identify {} --log short.csv.gz --effects effects.yaml", quadruped_files));
    EXPECT_EQ(run.status, 2);
    return run.err;
  };
  EXPECT_NE(
      refused("effects:\n  - {effect: magic, site: all, values: {}}\n").find("effects.yaml:2"),
      std::string::npos);
  EXPECT_NE(refused("effects:\n  - {effect: torque_offset, site: FR_nee, values: {o: 1}}\n")
                .find("FR_nee"),
            std::string::npos);
  EXPECT_NE(refused("effects:\n  - {effect: torque_offset, site: FR_knee, values: {}}\n")
                .find("does not give its o"),
            std::string::npos);
  const std::string offset = "effects:\n  - {effect: torque_offset, site: FR_knee, values: {o: ";
  EXPECT_NE(refused(offset + "1e300}}\n").find("effects.yaml:2: o is 1e+300; -1e+06 to 1e+06 N m"),
            std::string::npos);
  const std::string gain =
      refused("effects:\n  - {effect: torque_gain, site: FR_knee, values: {g: -1}}\n");
  EXPECT_NE(gain.find("g is -1; -0.8 to 0.8\n"), std::string::npos) << gain;
  EXPECT_NE(refused("effects: []\ncurves: [{effect: torque_offset, site: FR_knee, over: "
                    "dq.FR_knee, at: [0, 1], number: [0, 1e300]}]\n")
                .find("effects.yaml:2: a number of 1e+300"),
            std::string::npos);
}

}  // namespace
}  // namespace shapeid::test
