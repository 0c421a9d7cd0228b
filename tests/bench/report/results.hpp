// What the benchmark programs wrote, as numbers a table can be made of.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace shapeid::bench {

/// One benchmark: a time for each repetition, in their order.
struct Result {
  std::string name;
  std::vector<double> seconds;
  std::map<std::string, double> counters;

  [[nodiscard]] double median() const;
  /// Absent counter: zero.
  [[nodiscard]] double counter(const std::string& which) const;
  /// No failures, nothing wrong.
  [[nodiscard]] bool correct() const;
};

struct Results {
  std::map<std::string, std::string> context;  ///< machine, flags, commit, missing peers
  std::vector<Result> all;                     ///< in the order of the files

  [[nodiscard]] const Result* find(const std::string& name) const;
  /// Names that start with `prefix` and end with `suffix`.
  [[nodiscard]] std::vector<const Result*> between(const std::string& prefix,
                                                   const std::string& suffix) const;
};

/// Adds one JSON file of Google Benchmark, with repetitions. Throws std::runtime_error.
void read_results(const std::string& path, Results& results);

/// a over b, repetition by repetition: they ran interleaved, so both saw the same machine.
struct Ratio {
  double median = 0.0, lowest = 0.0, highest = 0.0;
};
[[nodiscard]] Ratio ratio(const Result& a, const Result& b);

}  // namespace shapeid::bench
