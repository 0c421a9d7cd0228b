#include "shapeid/diagnosis/remainders.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>

#include "shapeid/diagnosis/refit.hpp"

namespace shapeid::diagnosis {
namespace {

// A remainder is worth little once the other's shape is right: less than this part of what it was,
// and no more than what is dropped elsewhere. (Of two in blind trials of drawn arms a fifth was
// left, and nothing. A lag, half of whose gain a wider friction can take, is none.)
constexpr double most_left = 1.0 / 3.0;
// Each that has to stay costs a refit, and the weakest comes first.
constexpr int most_that_stay = 3;

bool is_law_of_joint(const AppliedEffect& a) {
  return a.effect->site == SiteKind::joint && !a.effect->transform.any() && a.when == When::always;
}

/// Of laws with a shape at the same joint, which gain more, the one that gains most.
std::optional<std::size_t> main_law(const std::vector<Found>& found, std::size_t i) {
  std::optional<std::size_t> main;
  for (std::size_t j = 0; j < found.size(); ++j) {
    const AppliedEffect& a = found[j].effect;
    if (!is_law_of_joint(a) || a.effect->shape.empty() || a.site != found[i].effect.site) continue;
    if (found[j].gain > found[main.value_or(i)].gain) main = j;
  }
  return main;
}

std::optional<std::size_t> weakest_beside_another(const std::vector<Found>& found,
                                                  const std::vector<std::string>& stay) {
  std::optional<std::size_t> weakest;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (!is_law_of_joint(found[i].effect) || std::ranges::count(stay, found[i].id) > 0) continue;
    if (!main_law(found, i)) continue;
    if (!weakest || found[i].gain < found[*weakest].gain) weakest = i;
  }
  return weakest;
}

}  // namespace

std::optional<AppliedEffect> leave_out_remainder(LoopState& state) {
  std::vector<std::string> stay;
  // Of most logs nothing is asked, and sums of a log take time.
  if (!weakest_beside_another(state.result.found, stay)) return std::nullopt;
  const LoopResult before = state.result;
  const Eigen::VectorXd with = state.held_out_of_model();
  while (stay.size() < most_that_stay) {
    const std::optional<std::size_t> i = weakest_beside_another(before.found, stay);
    if (!i) break;
    std::size_t main = *main_law(before.found, *i);
    state.result.found.erase(state.result.found.begin() + static_cast<std::ptrdiff_t>(*i));
    if (main > *i) --main;
    state.collect_effects();
    refit_from_afar(state, main);
    const Gain still = gain_of(state.held_out_of_model(), with);
    if (!(still.t > keep_t) && !(still.share > most_left * before.found[*i].gain)) {
      return before.found[*i].effect;
    }
    stay.push_back(before.found[*i].id);
    state.result = before;
  }
  return std::nullopt;
}

}  // namespace shapeid::diagnosis
