#include "shapeid/diagnosis/contacts_in_loop.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "shapeid/diagnosis/contact_flags.hpp"

namespace shapeid::diagnosis {
namespace {

class LoopsAroundFlags {
 public:
  LoopsAroundFlags(const Robot& robot, Recording& log, Recording* reference,
                   const std::vector<Recording*>& along, const LoopSettings& settings)
      : robot_(robot), log_(log), reference_(reference), along_(along), settings_(settings) {
    places_ = {&log, reference};
    places_.insert(places_.end(), along.begin(), along.end());
    if (!has_contact_flags(log, settings)) return;
    for (const Recording* place : places_) {
      originals_.push_back(place != nullptr ? std::optional(*place) : std::nullopt);
    }
  }

  LoopWithContacts run() {
    result_.flags = correct_contact_flags(robot_, log_, reference_, along_, settings_);
    while (true) {
      LoopInReach closed = close_loop_in_reach(robot_, log_, reference_, along_, settings_);
      closed.loop.screening_seconds += result_.loop.screening_seconds;
      closed.loop.refit_seconds += result_.loop.refit_seconds;
      result_.loop = std::move(closed.loop);
      result_.reach = closed.reach;
      std::size_t fallen = 0;
      while (fallen < result_.flags.size() && asked_again(fallen)) ++fallen;
      if (fallen == result_.flags.size()) return std::move(result_);
      result_.flags = flags_without(fallen);
      std::vector<std::optional<Recording>> logs = logs_with(result_.flags);
      for (std::size_t i = 0; i < places_.size(); ++i) {
        if (places_[i] != nullptr) *places_[i] = std::move(*logs[i]);
      }
    }
  }

 private:
  [[nodiscard]] std::vector<Found> flags_without(std::size_t k) const {
    std::vector<Found> flags = result_.flags;
    flags.erase(flags.begin() + static_cast<std::ptrdiff_t>(k));
    return flags;
  }

  /// The logs as they were given, with these flags corrected, in the order of the places.
  [[nodiscard]] std::vector<std::optional<Recording>> logs_with(
      const std::vector<Found>& flags) const {
    std::vector<std::optional<Recording>> logs = originals_;
    for (std::optional<Recording>& log : logs) {
      if (log) correct_contact_flags(*log, flags);
    }
    return logs;
  }

  /// Whether flag k still explains more than chance; then what it explains is written down.
  [[nodiscard]] bool asked_again(std::size_t k) {
    std::vector<std::optional<Recording>> logs = logs_with(flags_without(k));
    for (std::optional<Recording>& log : logs) {
      if (log) log->extend_contacts(result_.reach.before, result_.reach.after);
    }
    const auto in_place_of = [&](const Recording* of) -> const Recording* {
      const auto place = std::find(places_.begin(), places_.end(), of) - places_.begin();
      return of != nullptr ? &*logs[static_cast<std::size_t>(place)] : nullptr;
    };
    LoopSettings settings = settings_;
    settings.rough = in_place_of(settings_.rough);
    settings.rough_reference = in_place_of(settings_.rough_reference);
    Found& flag = result_.flags[k];
    const std::optional<Gain> gain = gain_beside(
        robot_, *in_place_of(&log_), in_place_of(reference_), settings, result_.loop, flag);
    if (!gain) return false;
    flag.gain = gain->share;
    flag.t = gain->t;
    return true;
  }

  const Robot& robot_;
  Recording& log_;
  Recording* reference_;
  const std::vector<Recording*>& along_;
  const LoopSettings& settings_;
  std::vector<Recording*> places_;                   ///< of all logs, some null
  std::vector<std::optional<Recording>> originals_;  ///< what was there, if it has flags
  LoopWithContacts result_;
};

}  // namespace

LoopWithContacts close_loop_with_contacts(const Robot& robot, Recording& log, Recording* reference,
                                          const std::vector<Recording*>& along,
                                          const LoopSettings& settings) {
  return LoopsAroundFlags(robot, log, reference, along, settings).run();
}

}  // namespace shapeid::diagnosis
