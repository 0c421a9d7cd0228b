#include "shapeid/app/shared_stretches.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <map>
#include <utility>

#include "shapeid/app/option_checks.hpp"
#include "shapeid/diagnosis/in_parallel.hpp"
#include "shapeid/models/error.hpp"
#include "shapeid/models/stretches.hpp"

namespace shapeid::app {
namespace {

/// Columns of what was measured at the joints, in the order of our names for them.
std::vector<std::size_t> measured_columns(const LogReader& log,
                                          const std::optional<Mapping>& mapping) {
  std::map<std::string, std::string> names;  // ours, theirs
  for (const std::string& column : log.columns()) names[column] = column;
  if (mapping) {
    for (const auto& [ours, rule] : mapping->columns) names[ours] = rule.from;
  }
  std::vector<std::size_t> places;
  for (const auto& [ours, theirs] : names) {
    if (!ours.starts_with("q.") && !ours.starts_with("tau.")) continue;
    const auto found = std::find(log.columns().begin(), log.columns().end(), theirs);
    if (found == log.columns().end()) continue;
    places.push_back(static_cast<std::size_t>(found - log.columns().begin()));
  }
  return places;
}

/// Whether the mapping keeps a row.
class Kept {
 public:
  Kept(const LogReader& log, const std::optional<Mapping>& mapping) {
    if (!mapping) return;
    for (const auto& [column, value] : mapping->keep_rows) {
      const auto found = std::find(log.columns().begin(), log.columns().end(), column);
      if (found == log.columns().end()) continue;
      wanted_.emplace_back(static_cast<std::size_t>(found - log.columns().begin()), value);
    }
  }
  bool operator()(const LogRow& row) const {
    return std::all_of(wanted_.begin(), wanted_.end(),
                       [&](const auto& want) { return row.values[want.first] == want.second; });
  }

 private:
  std::vector<std::pair<std::size_t, double>> wanted_;
};

std::uint64_t digest(const LogRow& row, const std::vector<std::size_t>& columns) {
  RowDigest digest;
  for (const std::size_t place : columns) digest.add(row.values[place]);
  return digest.value();
}

/// A log's stretches. Those that it has once only tell: a robot that rests may read the same in any
/// log, and so may a simulated one that repeats itself.
class Stretches {
 public:
  Stretches(const std::string& path, const std::optional<Mapping>& mapping) {
    LogReader log(path);
    const std::vector<std::size_t> columns = measured_columns(log, mapping);
    const Kept is_kept(log, mapping);
    Stretch stretch;
    while (const std::optional<LogRow> row = log.next()) {
      if (!is_kept(*row)) continue;
      stretch.add(digest(*row, columns));
      if (const std::optional<std::uint64_t> state = stretch.digest()) counts_.add(*state);
    }
  }

  /// Whether too many of one log's stand in both.
  [[nodiscard]] bool are_shared_with(const Stretches& other) const {
    const std::uint64_t limit = std::min(counts_.limit(), other.counts_.limit());
    const std::size_t fewer = std::min(count_up_to(limit), other.count_up_to(limit));
    std::size_t both = 0;
    for (const auto& [state, times] : counts_.times()) {
      both += times == 1 && other.has_once(state) ? 1 : 0;
    }
    return static_cast<double>(both) > StretchCounts::too_many * static_cast<double>(fewer);
  }

 private:
  [[nodiscard]] bool has_once(std::uint64_t state) const {
    const auto found = counts_.times().find(state);
    return found != counts_.times().end() && found->second == 1;
  }
  [[nodiscard]] std::size_t count_up_to(std::uint64_t limit) const {
    const auto& times = counts_.times();
    return static_cast<std::size_t>(std::distance(times.begin(), times.upper_bound(limit)));
  }

  StretchCounts counts_;
};

void refuse_same_files(const LogsByUse& logs) {
  std::vector<std::string> paths = logs.fitted;
  paths.insert(paths.end(), logs.earlier.begin(), logs.earlier.end());
  const std::size_t used = paths.size();
  paths.insert(paths.end(), logs.tested.begin(), logs.tested.end());
  const auto twice = same_file(paths);
  if (!twice) return;
  const auto& [first, second] = *twice;
  const bool is_test = first < used && second >= used;
  throw InputError({paths[second]}, is_test ? "is fitted, too" : "is given twice",
                   is_test ? "a test on data that are used for nothing else" : "each log once");
}

}  // namespace

void refuse_same_data(const LogsByUse& logs, const std::optional<Mapping>& mapping,
                      std::size_t threads) {
  if (logs.fitted.size() + logs.earlier.size() + logs.tested.size() < 2) return;
  refuse_same_files(logs);
  enum class Use { fitted, earlier, tested };
  struct Known {
    std::string path;
    Use use;
    std::optional<Stretches> stretches = {};
  };
  std::vector<Known> all;
  for (const std::string& path : logs.fitted) all.push_back({path, Use::fitted});
  for (const std::string& path : logs.earlier) all.push_back({path, Use::earlier});
  for (const std::string& path : logs.tested) all.push_back({path, Use::tested});
  diagnosis::in_parallel(all.size(), threads, [&](std::size_t k) {
    try {
      all[k].stretches.emplace(all[k].path, mapping);
    } catch (const InputError&) {
      all[k].stretches.reset();
    }
  });
  for (std::size_t k = 0; k < all.size(); ++k) {
    const Known& here = all[k];
    for (std::size_t i = 0; i < k; ++i) {
      const Known& known = all[i];
      if (here.use == Use::earlier && known.use == Use::fitted) continue;
      if (!here.stretches || !known.stretches) continue;
      if (!here.stretches->are_shared_with(*known.stretches)) continue;
      const bool is_test = here.use == Use::tested && known.use != Use::tested;
      throw InputError(
          {here.path},
          fmt::format("holds measurements of {}{}", known.path, is_test ? ", which is fitted" : ""),
          is_test ? "a test on data that are used for nothing else" : "each measurement once");
    }
  }
}

}  // namespace shapeid::app
