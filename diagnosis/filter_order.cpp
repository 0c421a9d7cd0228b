#include "shapeid/diagnosis/filter_order.hpp"

#include <algorithm>
#include <string>

namespace shapeid::diagnosis {

std::vector<Found> filters_among(const std::vector<Found>& found) {
  std::vector<Found> filters;
  for (const Found& f : found) {
    if (f.effect.effect->filters_load) filters.push_back(f);
  }
  return filters;
}

void take_filters_as_they_are(LoopState& state) {
  const std::vector<Found> filters = filters_among(state.result.found);
  std::erase_if(state.result.found, [&](const Found& f) {
    return f.effect.effect->transform.scales && std::ranges::any_of(filters, [&](const Found& g) {
             return g.effect.site == f.effect.site;
           });
  });
  state.result.filters_to_first_order = false;
  state.collect_effects();
}

void add_names_to_first_order(const std::vector<Found>& filters, std::vector<Found>& found) {
  const auto is_found = [&](const std::string& name) {
    return std::ranges::any_of(found, [&](const Found& f) { return f.id == name; });
  };
  for (Found& f : found) {
    for (const Found& before : filters) {
      if (!same_place(before.effect, f.effect)) continue;
      for (const std::string& name : before.ambiguous_with) {
        if (!is_found(name)) f.ambiguous_with.push_back(name);
      }
    }
  }
}

}  // namespace shapeid::diagnosis
