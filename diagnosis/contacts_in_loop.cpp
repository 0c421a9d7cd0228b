#include "shapeid/diagnosis/contacts_in_loop.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "shapeid/diagnosis/contact_flags.hpp"

namespace shapeid::diagnosis {
namespace {

/// Logs, some of them null, as they were before any contact was made longer.
class Originals {
 public:
  explicit Originals(const std::vector<Recording*>& logs) {
    for (const Recording* log : logs) {
      logs_.push_back(log != nullptr ? std::optional(*log) : std::nullopt);
    }
  }

  /// With these flags corrected, in the order of the construction.
  [[nodiscard]] std::vector<std::optional<Recording>> with(const std::vector<Found>& flags) const {
    std::vector<std::optional<Recording>> logs = logs_;
    for (std::optional<Recording>& log : logs) {
      if (log) correct_contact_flags(*log, flags);
    }
    return logs;
  }

 private:
  std::vector<std::optional<Recording>> logs_;
};

std::vector<Found> without(std::vector<Found> flags, std::size_t k) {
  flags.erase(flags.begin() + static_cast<std::ptrdiff_t>(k));
  return flags;
}

}  // namespace

LoopWithContacts close_loop_with_contacts(const Robot& robot, Recording& log, Recording* reference,
                                          const std::vector<Recording*>& along,
                                          const LoopSettings& settings) {
  std::vector<Recording*> places = {&log, reference};
  places.insert(places.end(), along.begin(), along.end());
  const Originals originals(places);
  // Where the logs of these settings are among the places.
  const auto place_of = [&](const Recording* of) {
    return static_cast<std::size_t>(std::find(places.begin(), places.end(), of) - places.begin());
  };
  LoopWithContacts result;
  result.flags = correct_contact_flags(robot, log, reference, along, settings);
  while (true) {
    LoopInReach in_reach = close_loop_in_reach(robot, log, reference, along, settings);
    result.loop = std::move(in_reach.loop);
    result.reach = in_reach.reach;
    const auto stands = [&](std::size_t k) {
      std::vector<std::optional<Recording>> logs = originals.with(without(result.flags, k));
      LoopSettings these = settings;
      const auto pointer = [&](std::size_t place) {
        if (place == places.size() || !logs[place]) return static_cast<Recording*>(nullptr);
        logs[place]->extend_contacts(result.reach.before, result.reach.after);
        return &*logs[place];
      };
      if (these.rough != nullptr) these.rough = pointer(place_of(settings.rough));
      if (these.rough_reference != nullptr)
        these.rough_reference = pointer(place_of(settings.rough_reference));
      const Recording *seen = pointer(0), *earlier = pointer(1);
      return flag_stands(robot, *seen, earlier, these, result.loop, result.flags[k]);
    };
    std::size_t fallen = 0;
    while (fallen < result.flags.size() && stands(fallen)) ++fallen;
    if (fallen == result.flags.size()) return result;
    result.flags = without(result.flags, fallen);
    std::vector<std::optional<Recording>> logs = originals.with(result.flags);
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (places[i] != nullptr) *places[i] = std::move(*logs[i]);
    }
  }
}

}  // namespace shapeid::diagnosis
