// Writes docs/benchmarks.md to standard output from the files that the benchmark programs left in a
// folder: *.json by Google Benchmark, *.md as they are; native/*.json from a native build.
#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <set>
#include <sstream>

#include "shapeid/tests/bench/report/goals.hpp"
#include "shapeid/tests/bench/report/growth.hpp"

namespace shapeid::bench {
namespace {

std::string time(double seconds) {
  if (seconds < 1e-6) return fmt::format("{:.3g} ns", seconds * 1e9);
  if (seconds < 1e-3) return fmt::format("{:.3g} us", seconds * 1e6);
  if (seconds < 1.0) return fmt::format("{:.3g} ms", seconds * 1e3);
  return fmt::format("{:.3g} s", seconds);
}

std::string correctness(const Result& r) {
  if (r.counters.count("problems") == 0) return "";
  return fmt::format("{:.0f} + {:.0f} of {:.0f}, {:.0e}", r.counter("failures"), r.counter("wrong"),
                     r.counter("problems"), r.counter("worst_gap"));
}

std::string context(const Results& results, const std::string& key) {
  const auto found = results.context.find(key);
  return found == results.context.end() ? "not recorded" : found->second;
}

void print_head(const Results& results) {
  fmt::print(
      "# Benchmarks\n\n"
      "Written by `./run bench` from one run; no number here was typed by hand. Everything is "
      "pinned "
      "to one core of a\nmachine that may have other work; repetitions of all benchmarks of a "
      "program are interleaved at random. Times are\nmedians over repetitions, ratios are taken "
      "repetition by repetition (median, lowest to highest). A ratio of 3 means\nthat the peer "
      "takes "
      "three times as long.\n\n"
      "- machine: {}\n- build: {}; Eigen's own vectorisation for plain x86-64 (SSE2), peers alike; "
      "the kernels of ours that read `fast/wide.hpp` take AVX2 where the processor has it, and "
      "those of tables with many shapes the registers of AVX-512\n"
      "- peers: {}, Lawson-Hanson of r-cran-nnls; ProxSuite without its optional simde\n"
      "- commit: {}\n- seeds: {}\n\n",
      context(results, "cpu"), context(results, "flags"), context(results, "peers"),
      context(results, "commit"), context(results, "seeds"));
  for (const auto& [key, value] : results.context) {
    if (key.starts_with("missing ")) fmt::print("- {}: {}\n", key.substr(8), value);
  }
  fmt::print(
      "\nInputs are seeded trots of the bundled quadruped (`tests/bench/problems`). \"Solve\" has "
      "everything prepared that a\nsolver starts from: A and b for Lawson-Hanson, H and g for QP "
      "solvers, the triangle [R c] and the shape columns U\nfor ours, which therefore forms R U "
      "inside the clock. \"Triangle\" starts at R, c and U for everybody: the same work. Rows "
      "without a remark\nare of that kind; \"A or H given to the peer\" is the harder comparison. "
      "In division runs peers have A or H made for them between the divisions, outside the clock; "
      "the shapes were picked by Lawson-Hanson's masses. Where as many shapes have mass as rows "
      "are felt, the minimum has many answers: then some of these shapes have no mass in ours, and "
      "dividing one costs no more than two slopes. In the rows that say so the shapes were picked "
      "by our masses, so that every division moves mass: the harder comparison. "
      "An answer is wrong if "
      "its "
      "objective\nexceeds the best of all solvers' by more than 1e-9 of the right-hand side's norm "
      "squared.\n\n");
}

void print_goals(const Results& results) {
  fmt::print(
      "## What was to be reached\n\nEach row by `./run bench COMMAND`. Of several peers or options "
      "the fastest that is always right counts; if none is,\nthe one with the fewest errors. A "
      "cold row counts cold peers. Correctness: failures + wrong "
      "answers of problems, worst gap.\n\n"
      "| the same work | ours | against | peer | ratio | goal | | ours correct | peer correct "
      "| command |\n|---|---|---|---|---|---|---|---|---|---|\n");
  for (const Goal& goal : goals()) {
    const Result* ours = results.find(goal.ours);
    const Result* peer = opponent(goal, results);
    fmt::print("| {} | {} | {} | ", goal.work, ours ? time(ours->median()) : "not run",
               goal.against);
    if (peer == nullptr) {
      fmt::print("peer not found | | {}x | row not met | | | `{}` |\n", goal.factor, goal.command);
      continue;
    }
    const std::string name = peer->name.substr(goal.prefix.size());
    fmt::print("{} {} | ", name, time(peer->median()));
    if (ours == nullptr) {
      fmt::print("| {}x | row not met | | {} | `{}` |\n", goal.factor, correctness(*peer),
                 goal.command);
      continue;
    }
    const Ratio r = ratio(*peer, *ours);
    const bool reached = r.median >= goal.factor && ours->correct();
    fmt::print("{:.3g} ({:.3g} to {:.3g}) | {}x | {} | {} | {} | `{}` |\n", r.median, r.lowest,
               r.highest, goal.factor, reached ? "reached" : "**not reached**", correctness(*ours),
               correctness(*peer), goal.command);
  }
}

void print_growth(const Results& results) {
  fmt::print(
      "\n## Growth\n\nExponent of the time of one more division against the number of shapes, "
      "fitted to runs of different lengths.\nGoal: at most 0.5 up to 300 shapes, 1 beyond.\n\n"
      "| solver | problems | 7 to 300 | 300 to 1000 |\n|---|---|---|---|\n");
  for (const std::string set : {"", "_noisefree", "_density"}) {
    for (const std::string solver : {"fast/warm", "lawson_hanson", "qpoases/mpc/warm"}) {
      const Growth small = growth(results, set, solver, 7, 300);
      const Growth large = growth(results, set, solver, 300, 1000);
      const auto text = [](const Growth& g) {
        return g.points < 2 ? std::string("not run") : fmt::format("{:.2f}", g.exponent);
      };
      fmt::print("| {} | {} | {} | {} |\n", solver, set.empty() ? "noisy" : set.substr(1),
                 text(small), text(large));
    }
  }
}

/// `native`: the same benchmarks in a build for this processor alone.
void print_native(const Results& results, const Results& native) {
  if (native.all.empty()) return;
  fmt::print(
      "\n## What a native build adds\n\nOurs as above, and built with {}. The plain build needs no "
      "more than any x86-64 has.\n\n| row | plain | native | ratio |\n|---|---|---|---|\n",
      context(native, "flags"));
  std::set<std::string> done;
  for (const Goal& goal : goals()) {
    const Result* plain = results.find(goal.ours);
    const Result* other = native.find(goal.ours);
    if (plain == nullptr || other == nullptr || !done.insert(goal.ours).second) continue;
    fmt::print("| {} | {} | {} | {:.3g} |\n", goal.ours, time(plain->median()),
               time(other->median()), plain->median() / other->median());
  }
}

void print_density(const Results& results) {
  fmt::print(
      "\n## The density term\n\nOurs with the design's lambda over ours with lambda = 0, same "
      "rows; "
      "goal: at most ten times as much.\n\n| row | lambda = 0 | lambda > 0 | ratio | correct "
      "|\n|---|---|---|---|---|\n");
  for (const Result& with : results.all) {
    static const std::string density = "_density/fast";
    const std::size_t at = with.name.find(density);
    if (at == std::string::npos) continue;
    std::string name = with.name;
    name.erase(at, density.find('/'));
    const Result* without = results.find(name);
    if (without == nullptr || name.ends_with("/triangle")) continue;
    const Ratio r = ratio(with, *without);
    fmt::print("| {} | {} | {} | {:.3g} ({:.3g} to {:.3g}) | {} |\n", name, time(without->median()),
               time(with.median()), r.median, r.lowest, r.highest, correctness(with));
  }
}

void print_stages(const Results& results) {
  const std::vector<const Result*> stages = results.between("stage/", "");
  const auto rate = [](const Result& r) { return r.counter("flops") / r.median() * 1e-9; };
  const auto machine = std::ranges::find_if(
      stages, [](const Result* r) { return r->name.starts_with("stage/machine"); });
  if (machine == stages.end()) return;
  fmt::print(
      "\n## Stages of a window\n\nBeside each the floating-point operations and bytes that it "
      "needs "
      "at the very least, and what share of the rate of a\nproduct of matrices in the first cache "
      "({:.3g} Gflop/s, this build) that makes: the distance to what this machine can do.\n\n"
      "| stage | time | least flops | least bytes | of the machine's rate "
      "|\n|---|---|---|---|---|\n",
      rate(**machine));
  for (const Result* stage : stages) {
    fmt::print("| {} | {} | {:.0f} | {:.0f} | {:.0f} % |\n", stage->name.substr(6),
               time(stage->median()), stage->counter("flops"), stage->counter("bytes"),
               100.0 * rate(*stage) / rate(**machine));
  }
}

/// One line a solver: "solve" and "triangle" beside each other where both exist.
void print_all(const Results& results) {
  fmt::print(
      "\n## All rows\n\n| row | solver | solve | from the triangle | correctness | worst KKT "
      "residual |\n|---|---|---|---|---|---|\n");
  static const std::string solve = "/solve", triangle = "/triangle";
  for (const Result& r : results.all) {
    if (r.name.ends_with(triangle) || r.name.starts_with("stage/")) continue;
    const std::size_t slash = r.name.find('/');
    const bool is_solve = r.name.ends_with(solve);
    const std::string stem = is_solve ? r.name.substr(0, r.name.size() - solve.size()) : r.name;
    const Result* other = is_solve ? results.find(stem + triangle) : nullptr;
    const bool judged = r.counters.count("worst_kkt") > 0;
    fmt::print("| {} | {} | {} | {} | {} | {} |\n", stem.substr(0, slash), stem.substr(slash + 1),
               time(r.median()), other ? time(other->median()) : "", correctness(r),
               judged ? fmt::format("{:.0e}", r.counter("worst_kkt")) : "");
  }
}

std::set<std::filesystem::path> files_in(const std::filesystem::path& folder) {
  std::set<std::filesystem::path> files;
  if (!std::filesystem::exists(folder)) return files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) files.insert(entry.path());
  return files;
}

Results read_all(const std::set<std::filesystem::path>& files) {
  Results results;
  for (const auto& file : files) {
    if (file.extension() == ".json") read_results(file, results);
  }
  // Random interleaving leaves no order of its own.
  std::ranges::sort(results.all, {}, &Result::name);
  return results;
}

int report(const std::filesystem::path& folder) {
  const std::set<std::filesystem::path> files = files_in(folder);
  const Results results = read_all(files);
  print_head(results);
  print_goals(results);
  print_growth(results);
  print_density(results);
  print_native(results, read_all(files_in(folder / "native")));
  print_stages(results);
  for (const auto& file : files) {
    if (file.extension() != ".md") continue;
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    fmt::print("\n{}", text.str());
  }
  print_all(results);
  return 0;
}

}  // namespace
}  // namespace shapeid::bench

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: bench_report FOLDER\n";
    return 2;
  }
  try {
    return shapeid::bench::report(argv[1]);
  } catch (const std::exception& e) {
    std::cerr << e.what() << '\n';
    return 2;
  }
}
