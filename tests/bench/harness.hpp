// What the benchmark programs share: their arguments and how a peer is timed.
#pragma once

#include <benchmark/benchmark.h>

#include <functional>
#include <string>
#include <vector>

#include "shapeid/tests/bench/peers/verdict.hpp"
#include "shapeid/tests/bench/problems/seeds.hpp"

namespace shapeid::bench {

/// Takes --seeds=tuning (default) or --seeds=published out of the arguments, hands the others to
/// Google Benchmark, and notes seeds, missing peers and the build in the output's context. Exits
/// with status 2 for arguments that nobody knows.
[[nodiscard]] SeedSet start(int argc, char** argv);

/// Runs what was registered.
void finish();

/// Whether --benchmark_filter lets this name through.
[[nodiscard]] bool wanted(const std::string& name);

/// The verdict as counters beside the time.
void add_counters(benchmark::State& state, const Verdict& verdict);

/// Who is timed in a row, and at the end one more, to be compared with: Lawson-Hanson, or for
/// lambda > 0 the reference.
struct Field {
  std::vector<PeerKind> peers;
  std::size_t timed = 0;
};
/// Everybody who can solve such problems and passes `also`. `largest`: the one with most shapes.
[[nodiscard]] Field field(const DenseProblem& largest,
                          const std::function<bool(const PeerKind&)>& also);

/// Registers, for each peer, "row/solver.../solve" (everything prepared beforehand) and
/// "row/solver.../triangle" (from R, c, U on). One iteration is one problem, in their order, each
/// started at the last one's answer where the peer is warm. Verdicts stand in the counters.
/// Only what --benchmark_filter lets through is made and judged.
void register_solves(const std::string& row,
                     const std::function<std::vector<DenseProblem>()>& make_problems);

}  // namespace shapeid::bench
