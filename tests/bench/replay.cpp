// Ten minutes of a 500 Hz log through the online identification, every call timed by the wall
// clock, and what memory it has before and after. Prints a piece of docs/benchmarks.md.
//   bench_replay LOG [ROBOT.urdf ROBOT.yaml SHAPES.yaml]     default: the bundled quadruped
#include <fmt/format.h>
#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <fstream>
#include <iostream>
#include <numeric>
#include <string>
#include <thread>
#include <vector>

#include "shapeid/fast/identifier.hpp"
#include "shapeid/models/motion.hpp"
#include "shapeid/models/robot_yaml.hpp"
#include "shapeid/models/shapes_yaml.hpp"
#include "shapeid/models/urdf.hpp"
#include "shapeid/tests/bench/problems/windows.hpp"
#include "shapeid/tests/fast/allocations.hpp"

namespace shapeid::bench {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double rate = 500.0, minutes = 10.0;
constexpr auto samples_a_minute = static_cast<std::size_t>(rate * 60.0);
constexpr auto samples_replayed = static_cast<std::size_t>(minutes * 60.0 * rate);
/// Linux halts real-time threads that take more than 95 % of a second; with breaks none does.
constexpr std::size_t samples_a_breath = 1000;
constexpr std::chrono::milliseconds breath{2};
constexpr double sample_deadline = 1.0 / rate;             // s
constexpr double window_deadline = window_samples / rate;  // s

struct Times {
  std::vector<double> seconds;

  void print(const std::string& what, double deadline) {
    std::ranges::sort(seconds);
    const auto at = [this](double share) {
      return 1e6 *
             seconds[static_cast<std::size_t>(share * static_cast<double>(seconds.size() - 1))];
    };
    const auto missed = seconds.end() - std::ranges::upper_bound(seconds, deadline);
    fmt::print("| {} | {} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.0f} | {} |\n", what,
               seconds.size(), at(0.5), at(0.99), at(0.999), at(1.0), 1e6 * deadline, missed);
  }
};

double resident_kilobytes() {
  std::ifstream statm("/proc/self/statm");
  double all = 0.0, resident = 0.0;
  statm >> all >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1024.0;
}

/// A controller has real-time priority; not everybody may ask for it.
bool ask_for_priority() {
  sched_param parameters{};
  parameters.sched_priority = sched_get_priority_min(SCHED_FIFO);
  return sched_setscheduler(0, SCHED_FIFO, &parameters) == 0;
}

/// What a machine shared with others takes away by itself: for so many seconds nothing is done but
/// reading the clock, with the same breaks.
void print_pauses(double seconds) {
  constexpr double stretch = 0.05;  // s between breaks
  double spent = 0.0, longest = 0.0;
  int missed = 0;
  while (spent < seconds) {
    const auto from = Clock::now();
    double elapsed = 0.0;
    while (elapsed < stretch) {
      const double now = std::chrono::duration<double>(Clock::now() - from).count();
      longest = std::max(longest, now - elapsed);
      if (now - elapsed > sample_deadline) ++missed;
      elapsed = now;
    }
    spent += elapsed;
    std::this_thread::sleep_for(breath);
  }
  fmt::print(
      "\nThe machine by itself, asked for nothing but the time for as long ({:.1f} s): {} pauses "
      "of "
      "more than {:.0f} us, the longest of {:.0f} us.\n",
      spent, missed, 1e6 * sample_deadline, 1e6 * longest);
}

std::vector<Sample> read_samples(const std::string& log, const Robot& robot,
                                 const RobotNotes& notes) {
  MotionOptions options;
  options.smoothing = Smoothing::causal;
  MotionReader reader(log, robot, notes, std::nullopt, options);
  std::vector<Sample> samples;
  while (std::optional<Sample> s = reader.next()) samples.push_back(std::move(*s));
  if (samples.empty()) throw std::runtime_error(log + " has no samples");
  return samples;
}

void replay(const Robot& robot, const BodyModel& model, const std::vector<Sample>& samples,
            int divisions) {
  fast::IdentifierSettings settings;
  settings.window = settings.stride = window_samples;
  settings.expected_mass = stacked_parameters(robot)[0];
  settings.division.most_divisions = divisions;
  fast::Identifier identifier(robot, model, settings);
  Times calls, windows;
  calls.seconds.resize(samples_replayed);
  windows.seconds.resize(samples_replayed / window_samples);
  std::ranges::fill(calls.seconds, 0.0);  // touched, so that no page is asked for later
  std::ranges::fill(windows.seconds, 0.0);

  const double memory_before = resident_kilobytes();
  double memory_early = 0.0;
  std::size_t asked = 0, declined = 0;
  for (std::size_t i = 0; i < samples_replayed; ++i) {
    const Sample& sample = samples[i % samples.size()];
    const std::size_t asked_before = test::allocations();
    const auto from = Clock::now();
    const fast::Identifier::Fed fed = identifier.feed(sample);
    calls.seconds[i] = std::chrono::duration<double>(Clock::now() - from).count();
    asked += test::allocations() - asked_before;
    windows.seconds[i / window_samples] += calls.seconds[i];
    if (fed == fast::Identifier::Fed::sample_declined ||
        fed == fast::Identifier::Fed::window_declined) {
      ++declined;
    }
    if (i % samples_a_breath == 0) std::this_thread::sleep_for(breath);
    if (i == samples_a_minute) memory_early = resident_kilobytes();
  }
  const double memory_after = resident_kilobytes();

  fmt::print(
      "\n{} divisions in every window:\n\n| | number | median | 99 % | 99.9 % | worst | deadline | "
      "missed |\n|---|---|---|---|---|---|---|---|\n",
      divisions);
  calls.print("a call", sample_deadline);
  windows.print("a window", window_deadline);
  fmt::print(
      "\nResident memory {:.0f} kB before, {:.0f} kB after a minute, {:.0f} kB at the end; {} "
      "requests for memory in between; {} samples or windows declined.\n",
      memory_before, memory_early, memory_after, asked, declined);
  print_pauses(std::accumulate(calls.seconds.begin(), calls.seconds.end(), 0.0));
}

void replay(const std::vector<std::string>& files) {
  Robot robot = read_urdf(files[1]).robot;
  const RobotNotes notes = read_robot_yaml(files[2], robot);
  const BodyModel model = read_shapes_yaml(files[3], robot);
  const std::vector<Sample> samples = read_samples(files[0], robot, notes);
  const bool priority = ask_for_priority();
  fmt::print(
      "## Ten minutes at 500 Hz\n\n`fast::Identifier`, {} shapes. {} samples: a log of {:.0f} s, "
      "again and again, "
      "as fast as they go; {}. A window is ten calls, the last of which solves and divides. "
      "Microseconds of the "
      "wall clock.\n",
      model.shapes.size(), samples_replayed, static_cast<double>(samples.size()) / rate,
      priority ? "real-time priority" : "no real-time priority, so that neighbours interrupt");
  for (const int divisions : {0, 30}) replay(robot, model, samples, divisions);
}

}  // namespace
}  // namespace shapeid::bench

int main(int argc, char** argv) {
  const std::string bundled = SHAPEID_SOURCE_DIR "/models/robots/quadruped";
  std::vector<std::string> files(argv + 1, argv + argc);
  if (files.size() == 1)
    files.insert(files.end(),
                 {bundled + ".urdf", bundled + ".robot.yaml", bundled + ".shapes.yaml"});
  if (files.size() != 4) {
    std::cerr << "usage: bench_replay LOG [ROBOT.urdf ROBOT.yaml SHAPES.yaml]\n";
    return 2;
  }
  try {
    shapeid::bench::replay(files);
    return 0;
  } catch (const std::exception& e) {
    std::cerr << e.what() << '\n';
    return 2;
  }
}
