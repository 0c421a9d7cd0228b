// A refusal with what was noted of the data before it: that readings were held, say, may be why.
#pragma once

#include <string>
#include <vector>

#include "shapeid/models/error.hpp"

namespace shapeid::app {

/// What a result would have noted of robot and log is said beside the refusal, by run_command().
class NotedRefusal : public Refusal {
 public:
  /// Behind the notes that `refusal` has itself, without those that it has already.
  NotedRefusal(const Refusal& refusal, const std::vector<std::string>& notes);

  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }

 private:
  std::vector<std::string> notes_;
};

/// What `work` returns; where it refuses, the refusal with what `notes` says then.
template <typename Notes, typename Work>
auto with_notes(const Notes& notes, const Work& work) {
  try {
    return work();
  } catch (const Refusal& refusal) {
    throw NotedRefusal(refusal, notes());
  }
}

}  // namespace shapeid::app
