#include "shapeid/app/number_source.hpp"

#include <fmt/format.h>

namespace shapeid::app {

std::string number_source(const reference::Identification& found, Eigen::Index at) {
  const reference::Determination& data = found.data;
  if (data.is_impossible(at)) return "shapes, the data impossible";
  if (!data.determined[static_cast<std::size_t>(at)]) return "shapes and bounds";
  if (!data.agrees(at, found.run.solution.Phi[at])) return "shapes, against the data";
  const bool is_held = reference::is_held(found.standard_error[at], data.standard_error[at]);
  return is_held ? "shapes, the data agree" : "data";
}

bool hangs_on_filter(const reference::Identification& found, Eigen::Index at) {
  return found.slower && differ(found.data, *found.slower, at);
}

std::string number_source_text(const Result& result, Eigen::Index at, double known) {
  const reference::Identification& found = result.found;
  std::string text = number_source(found, at);
  if (found.data.is_impossible(at)) {
    text +=
        fmt::format(": {:.5g}{}", found.data.value[at], known == 0.0 ? "" : " of what is sought");
  }
  if (hangs_on_filter(found, at)) {
    text += fmt::format("; behind {:.3g} Hz the data say {:.5g}", result.slower_cutoff,
                        known + found.slower->value[at]);
  }
  return text;
}

void note_numbers_that_hang(Result& result) {
  int count = 0;
  for (Eigen::Index at = 0; at < result.found.standard_error.size(); ++at) {
    if (hangs_on_filter(result.found, at)) ++count;
  }
  if (count == 0) return;
  result.notes.push_back(fmt::format(
      "of {} {} the data say something else behind a filter of {:.3g} Hz than errors allow: noise "
      "in the motion, what is no rigid body, or a filter of the signals that bends a fast motion "
      "(--cutoff 80 --row-cutoff 20 bends less) is in {}; by chance alone up to "
      "one in twenty does so",
      count, count == 1 ? "number" : "numbers", result.slower_cutoff, count == 1 ? "it" : "them"));
}

std::string number_source_legend(const reference::Identification& found) {
  for (Eigen::Index at = 0; at < found.standard_error.size(); ++at) {
    if (number_source(found, at) == "data") continue;
    return "note: beside \"shapes\", s.e. is of what they leave open, taken for right; the data's "
           "s.e. is what is known without them\n";
  }
  return "";
}

}  // namespace shapeid::app
