#include "shapeid/app/shared_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>

#include "shapeid/models/error.hpp"

namespace shapeid::app {
namespace {

/// Of one log's rows: fewer are found by chance in logs of a sensor that hardly moves.
constexpr double too_many = 0.1;

using Rows = std::vector<std::uint64_t>;

/// The next state of splitmix64 (Steele, Lea, Flood 2014).
std::uint64_t mixed(std::uint64_t state) {
  state += 0x9E3779B97F4A7C15;
  state = (state ^ (state >> 30U)) * 0xBF58476D1CE4E5B9;
  state = (state ^ (state >> 27U)) * 0x94D049BB133111EB;
  return state ^ (state >> 31U);
}

std::uint64_t digest(const LogRow& row, std::size_t but) {
  std::uint64_t state = 0;
  for (std::size_t i = 0; i < row.values.size(); ++i) {
    if (i == but) continue;
    const double value = row.values[i];
    // An empty field is one NaN, and a zero has no sign.
    const std::uint64_t bits =
        std::isnan(value) ? 1 : (value == 0.0 ? 0 : std::bit_cast<std::uint64_t>(value));
    state = mixed(state ^ bits);
  }
  return state;
}

/// Of rows that the log has once, in order: a robot that rests may read the same in any log.
Rows digests(const std::string& path, const std::string& time) {
  LogReader log(path);
  const auto but = static_cast<std::size_t>(
      std::find(log.columns().begin(), log.columns().end(), time) - log.columns().begin());
  Rows all;
  while (const std::optional<LogRow> row = log.next()) all.push_back(digest(*row, but));
  std::sort(all.begin(), all.end());
  Rows once;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const bool is_first = i == 0 || all[i - 1] != all[i];
    const bool is_last = i + 1 == all.size() || all[i + 1] != all[i];
    if (is_first && is_last) once.push_back(all[i]);
  }
  return once;
}

}  // namespace

void refuse_shared_rows(const std::vector<std::string>& fitted,
                        const std::vector<std::string>& tested,
                        const std::optional<Mapping>& mapping) {
  std::string time = "time";
  if (mapping && mapping->columns.contains(time)) time = mapping->columns.at(time).from;
  std::vector<std::string> paths = fitted;
  paths.insert(paths.end(), tested.begin(), tested.end());
  std::vector<Rows> before;
  for (std::size_t k = 0; k < paths.size(); ++k) {
    Rows rows = digests(paths[k], time);
    for (std::size_t i = 0; i < before.size(); ++i) {
      Rows both;
      std::set_intersection(rows.begin(), rows.end(), before[i].begin(), before[i].end(),
                            std::back_inserter(both));
      const std::size_t fewer = std::min(rows.size(), before[i].size());
      if (static_cast<double>(both.size()) <= too_many * static_cast<double>(fewer)) continue;
      const bool is_test = i < fitted.size() && k >= fitted.size();
      throw InputError(
          {paths[k]},
          fmt::format("{} of its rows stand in {} as well{}", both.size(), paths[i],
                      is_test ? ", which is fitted" : ""),
          is_test ? "a test on data that are used for nothing else" : "each measurement once");
    }
    before.push_back(std::move(rows));
  }
}

}  // namespace shapeid::app
