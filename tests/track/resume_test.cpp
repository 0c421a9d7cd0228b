// A run that was cut anywhere and went on says, to the last byte, what one that was not cut says.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include "shapeid/tests/app/command.hpp"
#include "shapeid/tests/support/files.hpp"
#include "shapeid/tests/track/logs.hpp"

namespace shapeid::test {
namespace {

namespace fs = std::filesystem;

/// What a run says that is not cut.
const std::string& whole() {
  static const std::string text = [] {
    scratch_file("whole.csv", joined(trot_log()));
    const CommandRun run = shapeid(track("whole.csv"));
    EXPECT_EQ(run.status, 0) << run.err;
    return run.out;
  }();
  return text;
}

/// Empty if two texts are the same; else the first line in which they differ, not all of them.
std::string difference(const std::string& a, const std::string& b) {
  std::istringstream in_a(a), in_b(b);
  for (int line = 0;; ++line) {
    std::string of_a, of_b;
    const bool more_a = static_cast<bool>(std::getline(in_a, of_a));
    const bool more_b = static_cast<bool>(std::getline(in_b, of_b));
    if (!more_a && !more_b) return {};
    if (of_a != of_b) return fmt::format("line {}:\n{}\n{}", line, of_a, of_b);
  }
}

/// The log is cut after so many bytes: first a run over that much, then one that goes on.
void expect_same_when_cut_at(std::size_t bytes) {
  const std::string log = joined(trot_log());
  scratch_file("cut.csv", log.substr(0, bytes));
  fs::remove(scratch() + "/state.json");
  const std::string options = track("--checkpoint state.json --resume cut.csv");
  const CommandRun first = shapeid(options);
  ASSERT_EQ(first.status, 0) << first.err;
  scratch_file("cut.csv", log);
  const CommandRun second = shapeid(options);
  ASSERT_EQ(second.status, 0) << second.err;
  EXPECT_EQ(difference(first.out + second.out, whole()), "") << "cut after " << bytes << " bytes";
}

TEST(TrackResume, CutAtEveryKindOfPlace) {
  const Lines& log = trot_log();
  const std::size_t header = log.front().size();
  const std::size_t row = log[1].size() + 1;
  std::size_t middle = 0;
  for (std::size_t i = 0; i < 1000; ++i) middle += log[i].size() + 1;
  // Behind the header; while the rate is learned; while the filters settle; at a row's end, inside
  // a row, one byte before and behind a line's end; near the end.
  for (const std::size_t bytes :
       {header + 1, header + 1 + 100 * row, header + 1 + 280 * row, middle, middle + row / 2,
        middle - 1, middle + 1, joined(log).size() - 1, joined(log).size()}) {
    expect_same_when_cut_at(bytes);
  }
}

/// Starts `shapeid` without waiting; output is appended to a file.
pid_t start(const std::string& arguments, const std::string& out) {
  const std::string line =
      fmt::format("cd '{}' && exec {} >>'{}' 2>/dev/null", scratch(), command(arguments), out);
  const pid_t child = ::fork();
  if (child == 0) {
    ::execl("/bin/sh", "sh", "-c", line.c_str(), nullptr);
    ::_exit(127);
  }
  return child;
}

/// For half a minute at most.
template <class Condition>
void wait_until(const Condition& holds) {
  for (int i = 0; i < 3000 && !holds(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

/// Lines of several runs, each from its first to its last: a line that comes again must be the
/// same, and replaces what came after it.
std::string merged(const std::string& text, std::size_t& repeated) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    if (!nlohmann::json::accept(line)) continue;  // cut by kill -9
    const auto number = nlohmann::json::parse(line).at("line").get<std::size_t>();
    if (number < lines.size()) {
      EXPECT_EQ(lines[number], line);
      ++repeated;
      continue;
    }
    EXPECT_EQ(number, lines.size()) << "a line is lost";
    lines.push_back(line);
  }
  return fmt::format("{}\n", fmt::join(lines, "\n"));
}

// Kill -9 does not ask: the checkpoint that is there is whole, and what was said since is said
// again.
TEST(TrackResume, KilledAtAnyMomentNothingIsLost) {
  const std::string log = joined(trot_log());
  scratch_file("grows.csv", "");
  const std::string out = scratch() + "/killed.jsonl";
  fs::remove(out);
  fs::remove(scratch() + "/state.json");
  const std::string options =
      track("--checkpoint state.json --checkpoint-every 3 --resume grows.csv");
  constexpr std::size_t pieces = 7;  // a prime, so that cuts fall anywhere in lines
  std::ofstream grows(scratch() + "/grows.csv", std::ios::binary);
  for (std::size_t piece = 0; piece < pieces; ++piece) {
    const std::size_t from = piece * log.size() / pieces, to = (piece + 1) * log.size() / pieces;
    grows << log.substr(from, to - from) << std::flush;
    if (piece == 0) continue;  // a header is needed
    const pid_t child = start(options + " --follow", out);
    std::this_thread::sleep_for(std::chrono::milliseconds(150 + 90 * piece));
    // On a busy machine the last run waits for a checkpoint, the only one that it can have written
    // being one while running.
    if (piece + 1 == pieces) wait_until([] { return fs::exists(scratch() + "/state.json"); });
    ::kill(child, SIGKILL);
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFSIGNALED(status));
  }
  EXPECT_TRUE(fs::exists(scratch() + "/state.json")) << "nothing saved while running";
  const CommandRun last = shapeid(options);
  ASSERT_EQ(last.status, 0) << last.err;
  const auto first_line = [](const std::string& text) { return text.substr(0, text.find('\n')); };
  EXPECT_NE(first_line(last.out), first_line(whole())) << "the last run began anew";
  std::size_t repeated = 0;
  EXPECT_EQ(difference(merged(text_of(out) + last.out, repeated), whole()), "");
  fmt::print("killed {} times; {} lines were said again\n", pieces - 1, repeated);
}

/// Of the checkpoint that is there; zero if there is none.
std::ptrdiff_t lines_saved(const std::string& state) {
  if (!fs::exists(state)) return 0;
  return nlohmann::json::parse(text_of(state)).at("lines").get<std::ptrdiff_t>();
}

// A line is said again for each that came behind the last checkpoint.
TEST(TrackResume, CheckpointsComeAfterSoManyLines) {
  const std::string state = scratch() + "/every.json", out = scratch() + "/every.jsonl";
  const auto lines = std::count(whole().begin(), whole().end(), '\n');
  scratch_file("whole.csv", joined(trot_log()));
  for (const auto every : {std::ptrdiff_t{7}, lines - 1, lines + 1}) {
    fs::remove(state);
    fs::remove(out);
    const std::string options = track(
        fmt::format("--checkpoint every.json --checkpoint-every {} --resume whole.csv", every));
    const pid_t child = start(options + " --follow", out);
    // A checkpoint is written after the line is said; of more lines than there are none comes.
    wait_until([&] {
      const bool is_saved = every > lines || lines_saved(state) > lines - every;
      return is_saved && fs::exists(out) && text_of(out) == whole();
    });
    ::kill(child, SIGKILL);
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    const CommandRun again = shapeid(options);
    const auto said = std::count(again.out.begin(), again.out.end(), '\n');
    // The first lines come several at once.
    if (every == 7)
      EXPECT_LT(said, every);
    else
      EXPECT_EQ(said, lines % every) << every;
  }
}

// From a pipe: the writer stops in the middle of a line and goes on later.
TEST(TrackResume, AWriterMayStopInTheMiddleOfALine) {
  scratch_file("whole.csv", joined(trot_log()));
  const std::string line = fmt::format(
      "cd '{0}' && (head -c 100000 whole.csv; sleep 0.3; tail -c +100001 whole.csv) | "
      "{1} >piped.jsonl",
      scratch(), command(track("-")));
  ASSERT_EQ(std::system(line.c_str()), 0);
  EXPECT_EQ(difference(text_of(scratch() + "/piped.jsonl"), whole()), "");
}

// A stream that is resumed may begin with its header again, or simply go on.
TEST(TrackResume, StreamsGoOnEitherWay) {
  const Lines& log = trot_log();
  const Lines head(log.begin(), log.begin() + 900), tail(log.begin() + 900, log.end());
  scratch_file("head.csv", joined(head));
  scratch_file("tail.csv", joined(tail));
  scratch_file("whole.csv", joined(log));
  const std::string options = track("--checkpoint state.json --resume -");
  for (const char* rest : {"tail.csv", "whole.csv"}) {
    fs::remove(scratch() + "/state.json");
    const CommandRun first = shapeid(options, "head.csv");
    ASSERT_EQ(first.status, 0) << first.err;
    const CommandRun second = shapeid(options, rest);
    ASSERT_EQ(second.status, 0) << second.err;
    EXPECT_EQ(difference(first.out + second.out, whole()), "") << rest;
  }
}

TEST(TrackResume, RefusesWhatDoesNotBelongTogether) {
  scratch_file("whole.csv", joined(trot_log()));
  fs::remove(scratch() + "/state.json");
  ASSERT_EQ(shapeid(track("--checkpoint state.json whole.csv")).status, 0);
  const auto expect_refused = [](const std::string& options, const std::string& says) {
    const CommandRun run = shapeid(track(options));
    EXPECT_EQ(run.status, 2) << options;
    EXPECT_NE(run.err.find(says), std::string::npos) << run.err;
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
  };
  expect_refused("--checkpoint state.json --resume --alpha 0.4 whole.csv", "other options");
  // Without flags contacts are derived, by the threshold and the given inertias.
  scratch_file("flagless.csv", joined(without_contacts(trot_log())));
  ASSERT_EQ(shapeid(track("--checkpoint derived.json flagless.csv")).status, 0);
  ASSERT_EQ(shapeid(track("--checkpoint derived.json --resume flagless.csv")).status, 0);
  expect_refused("--checkpoint derived.json --resume --contact-threshold 0.3 flagless.csv",
                 "other options");
  scratch_file("short.csv", joined({trot_log()[0], trot_log()[1]}));
  expect_refused("--checkpoint state.json --resume short.csv", "bytes");
  // The same columns of another run.
  Lines other = trot_log();
  for (std::size_t i = 1; i < other.size(); ++i)
    other[i].back() = other[i].back() == '1' ? '0' : '1';
  scratch_file("other.csv", joined(other));
  const std::string says = fmt::format("other.csv:{}: is not the line", other.size());
  expect_refused("--checkpoint state.json --resume other.csv", says);
  scratch_file("shorter.csv", joined(trot_log()).substr(0, joined(trot_log()).size() - 3));
  expect_refused("--checkpoint state.json --resume shorter.csv", "bytes");
  EXPECT_EQ(shapeid(track("--checkpoint state.json --resume -"), "other.csv").status, 2);
  scratch_file("broken.json", text_of(scratch() + "/state.json").substr(0, 5000));
  expect_refused("--checkpoint broken.json --resume whole.csv", "is not JSON");
  scratch_file("other.json", "{\"format\": \"shapeid-checkpoint-0\"}");
  expect_refused("--checkpoint other.json --resume whole.csv", "format");
}

/// The smallest change of what stands there.
nlohmann::json nudged_member(const nlohmann::json& value) {
  if (value.is_number_unsigned()) return value.get<std::uint64_t>() + 1;
  if (value.is_string()) return value.get<std::string>() + "0";
  if (value.is_null()) return 0;
  return nlohmann::json();
}

/// Of a part of the checkpoint: each member changed, and each taken away; and one more.
void expect_that_every_member_counts(const nlohmann::json& good, const std::string& part) {
  const nlohmann::json::json_pointer place(part);
  const auto expect_refused = [](const nlohmann::json& forged, const std::string& what) {
    scratch_file("forged.json", forged.dump());
    const CommandRun run = shapeid(track("--checkpoint forged.json --resume whole.csv"));
    EXPECT_EQ(run.status, 2) << what;
    EXPECT_EQ(run.out, "") << what;
  };
  for (const auto& [key, value] : good.at(place).items()) {
    nlohmann::json forged = good;
    forged[place][key] = nudged_member(value);
    expect_refused(forged, part + "/" + key);
    forged[place].erase(key);
    expect_refused(forged, part + "/" + key + " taken away");
  }
  nlohmann::json forged = good;
  forged[place]["more"] = 1;
  expect_refused(forged, part + " with one more");
}

TEST(TrackResume, EveryFieldOfACheckpointCounts) {
  scratch_file("whole.csv", joined(trot_log()));
  fs::remove(scratch() + "/state.json");
  ASSERT_EQ(shapeid(track("--checkpoint state.json whole.csv")).status, 0);
  const auto good = nlohmann::json::parse(text_of(scratch() + "/state.json"));
  for (const char* part : {"", "/log", "/state"}) {
    expect_that_every_member_counts(good, part);
  }
  scratch_file("forged.json", good.dump(1));
  EXPECT_EQ(shapeid(track("--checkpoint forged.json --resume whole.csv")).status, 0);
}

/// Names of further columns are what somebody's logger wrote.
TEST(TrackResume, AHeaderOfAnyBytesIsTheSameWhenItIsReadAgain) {
  for (const std::string& name :
       {std::string("temp\xe9rature"), std::string("temp\xc3\xa9rature")}) {
    Lines log = trot_log();
    log.resize(std::min<std::size_t>(log.size(), 900));
    for (std::size_t i = 0; i < log.size(); ++i) log[i] += i == 0 ? "," + name : ",20";
    scratch_file("warm.csv", joined(log));
    fs::remove(scratch() + "/warm.json");
    const CommandRun first = shapeid(track("--checkpoint warm.json warm.csv"));
    ASSERT_EQ(first.status, 0) << first.err;
    const CommandRun again = shapeid(track("--checkpoint warm.json --resume warm.csv"));
    EXPECT_EQ(again.status, 0) << again.err;
  }
}

TEST(TrackInput, IsRefusedInOneLine) {
  const auto expect_refused = [](const std::string& log, const std::string& says) {
    scratch_file("bad.csv", log);
    const CommandRun run = shapeid(track("bad.csv"));
    EXPECT_EQ(run.status, 2) << says;
    EXPECT_NE(run.err.find(says), std::string::npos) << run.err;
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
  };
  const Lines& log = trot_log();
  expect_refused("", "is empty");
  expect_refused(log[0], fmt::format("bad.csv:1: {} bytes have no line's end", log[0].size()));
  std::string old_lines = joined(log);
  std::replace(old_lines.begin(), old_lines.end(), '\n', '\r');
  expect_refused(old_lines, "bad.csv:1: holds a carriage return inside a line");
  expect_refused("\x1f\x8b compressed", "compressed");
  expect_refused("time\n0\n", "has no column");
  expect_refused(log[0] + "\n" + log[1] + ",1\n", "fields where the header has");
  expect_refused(log[0] + "\n" + std::string(2 << 20, '1'), "longer than");
  EXPECT_EQ(shapeid(track("--resume whole.csv")).status, 2) << "--resume needs --checkpoint";
  EXPECT_EQ(shapeid(track("nowhere.csv")).status, 2);
}

TEST(TrackInput, UnitsThatCannotBeAreRefusedInTheFirstRows) {
  const auto said = [](const std::string& column, double factor) {
    Lines log = trot_log();
    change(log, column, 0, log.size() - 1, [&](double value) { return factor * value; });
    scratch_file("units.csv", joined(log));
    const CommandRun run = shapeid(track("units.csv"));
    EXPECT_EQ(run.status, 2) << column;
    return run.err;
  };
  EXPECT_NE(said("q.FR_knee", 57.29578).find("looks like degrees"), std::string::npos);
  EXPECT_NE(said("dq.RL_hip", 57.29578).find("looks like degrees per second"), std::string::npos);
  EXPECT_NE(said("dq.FL_hip", -1.0).find("sign: -1"), std::string::npos);
}

}  // namespace
}  // namespace shapeid::test
