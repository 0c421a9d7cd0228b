// Notes that gather the names they concern: "no <limit>, taken as none: hip, knee".
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace shapeid {

class NoteList {
 public:
  void add(const std::string& note, const std::string& name) {
    const auto found = std::find_if(entries_.begin(), entries_.end(),
                                    [&](const auto& entry) { return entry.first == note; });
    if (found == entries_.end()) {
      entries_.emplace_back(note, name);
    } else {
      found->second.append(", ").append(name);
    }
  }

  /// One line a note, in the order of first mention.
  [[nodiscard]] std::vector<std::string> lines() const {
    std::vector<std::string> result;
    result.reserve(entries_.size());
    for (const auto& [note, names] : entries_) result.push_back(fmt::format("{}: {}", note, names));
    return result;
  }

 private:
  std::vector<std::pair<std::string, std::string>> entries_;
};

}  // namespace shapeid
