// What was to be reached, and against whom.
#pragma once

#include <string>
#include <vector>

#include "shapeid/tests/bench/report/results.hpp"

namespace shapeid::bench {

/// Ours against the fastest of some results.
struct Goal {
  std::string work;     ///< what is done, for the reader
  std::string ours;     ///< name of our benchmark
  std::string against;  ///< who, for the reader
  double factor;        ///< to be so many times faster
  /// The peers that count: names that start with `prefix`, go on with one of `who` (empty: anyone
  /// but us and the reference) and end with `suffix`.
  std::string prefix;
  std::vector<std::string> who;
  std::string suffix;
  std::string command;  ///< runs this row alone
  bool cold = false;    ///< peers that are warm-started do other work, and do not count
};

[[nodiscard]] const std::vector<Goal>& goals();

/// The fastest peer of a goal that was always right or, if none was, the one with the fewest
/// failures and wrong answers. Null if none was found on this machine.
[[nodiscard]] const Result* opponent(const Goal& goal, const Results& results);

}  // namespace shapeid::bench
