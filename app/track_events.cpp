#include "shapeid/app/track_events.hpp"

namespace shapeid::app {
namespace {

void count(const std::vector<int>& channels, std::vector<std::size_t>& counts) {
  for (const int channel : channels) ++counts[static_cast<std::size_t>(channel)];
}

}  // namespace

void TrackEvents::add(const RowFaults& faults) {
  count(faults.outliers, outliers);
  count(faults.stuck, stuck);
  count(faults.saturated, saturated);
}

nlohmann::json by_channel(const std::vector<std::size_t>& counts, const ChannelPlan& plan) {
  nlohmann::json object = nlohmann::json::object();
  for (std::size_t c = 0; c < counts.size(); ++c) {
    if (counts[c] > 0) object[plan.channels[c].name] = counts[c];
  }
  return object;
}

}  // namespace shapeid::app
