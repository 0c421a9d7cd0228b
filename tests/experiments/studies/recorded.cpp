#include "shapeid/tests/experiments/studies/recorded.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "shapeid/tests/experiments/studies/experiment.hpp"

namespace shapeid::experiments {

std::map<std::string, double> small_values() {
  Findings all;
  for (const Experiment& experiment : experiments()) all.merge(experiment.run(Form::small));
  std::erase_if(all.values, [](const auto& entry) {
    const std::string& name = entry.first;
    // The small form has one or two seeds: medians say it all.
    return name.starts_with("time.") || name.ends_with(".lowest") || name.ends_with(".highest");
  });
  return all.values;
}

std::vector<std::string> differences(const std::map<std::string, double>& recorded,
                                     const std::map<std::string, double>& now, double relative,
                                     double smallest) {
  std::vector<std::string> lines;
  for (const auto& [name, value] : recorded) {
    const auto found = now.find(name);
    if (found == now.end()) {
      lines.push_back(name + " is missing");
      continue;
    }
    const double allowed = relative * std::max(std::abs(value), std::abs(found->second));
    if (std::abs(found->second - value) > std::max(allowed, smallest)) {
      lines.push_back(fmt::format("{} was {} and is {}", name, value, found->second));
    }
  }
  for (const auto& [name, value] : now) {
    if (!recorded.contains(name)) lines.push_back(name + " was not recorded");
  }
  return lines;
}

}  // namespace shapeid::experiments
