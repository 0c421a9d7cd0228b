// What went wrong, or was unusual, since the last line of `track`.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <vector>

#include "shapeid/models/channels.hpp"
#include "shapeid/models/row_guard.hpp"

namespace shapeid::app {

/// Counted from one line to the next. Rows are seen some tens of milliseconds before the samples
/// that are made of them.
struct TrackEvents {
  std::size_t rows = 0, repeated = 0, missing = 0;
  std::size_t clock_back = 0, gaps = 0;
  std::vector<std::size_t> outliers, stuck, saturated;  ///< one a channel: rows
  std::size_t taken = 0, still = 0, not_finite = 0, no_forces = 0;
  std::size_t contacts_unknown = 0;   ///< samples that there would have been; in no checkpoint
  std::size_t airborne = 0;           ///< of the samples
  std::vector<std::size_t> slipping;  ///< one a contact: samples

  TrackEvents() = default;
  TrackEvents(std::size_t channels, std::size_t contacts)
      : outliers(channels, 0), stuck(outliers), saturated(outliers), slipping(contacts, 0) {}

  void add(const RowFaults& faults);

  template <class Archive>
  void state(Archive& archive) {
    archive("rows", rows);
    archive("repeated", repeated);
    archive("missing", missing);
    archive("clock_back", clock_back);
    archive("gaps", gaps);
    archive("outliers", outliers);
    archive("stuck", stuck);
    archive("saturated", saturated);
    archive("taken", taken);
    archive("still", still);
    archive("not_finite", not_finite);
    archive("no_forces", no_forces);
    archive("airborne", airborne);
    archive("slipping", slipping);
  }
};

/// {"q.knee": 3} for the channels with a count.
[[nodiscard]] nlohmann::json by_channel(const std::vector<std::size_t>& counts,
                                        const ChannelPlan& plan);

}  // namespace shapeid::app
