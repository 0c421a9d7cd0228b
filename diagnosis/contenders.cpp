#include "shapeid/diagnosis/contenders.hpp"

#include <algorithm>
#include <numeric>

namespace shapeid::diagnosis {
namespace {

// Onsets of one load that are looked at more closely.
constexpr std::ptrdiff_t most_of_one_place = 2;

}  // namespace

double Contenders::parameters() const {
  double sum = 0.0;
  for (const Candidate& c : candidates_) {
    if (c.members.empty() && !c.only_rival) sum += static_cast<double>(c.term.columns.size());
  }
  return sum;
}

Chosen Contenders::usual() const {
  Chosen list;
  for (std::size_t k = 0; k < candidates_.size(); ++k) {
    const Candidate& c = candidates_[k];
    if (c.members.empty() && !c.only_rival && c.effect.effect->is_usual &&
        c.effect.when == When::always) {
      list.push_back(k);
    }
  }
  return list;
}

bool Contenders::is_contained(std::size_t k, const Chosen& others) const {
  return fits_.promises(terms(others), {candidates_[k].term}).front().contained();
}

std::vector<Term> Contenders::terms(const Chosen& chosen) const {
  std::vector<Term> list = {masses_};
  for (const std::size_t k : chosen) list.push_back(candidates_[k].term);
  return list;
}

std::vector<Term> Contenders::terms(const Chosen& chosen, std::size_t k) const {
  std::vector<Term> list = terms(chosen);
  list.push_back(candidates_[k].term);
  return list;
}

Fit Contenders::last_of(std::size_t k, const Fit& fit) const {
  const Eigen::Index n = std::ssize(candidates_[k].term.columns);
  return part_of(fit, fit.value.size() - n, n);
}

bool Contenders::any_single(std::size_t k,
                            const std::function<bool(std::size_t)>& condition) const {
  const auto& members = candidates_[k].members;
  return members.empty() ? condition(k) : std::any_of(members.begin(), members.end(), condition);
}

bool Contenders::is_among(std::size_t k, const Chosen& chosen) const {
  return any_single(k, [&](std::size_t single) {
    return std::find(chosen.begin(), chosen.end(), single) != chosen.end();
  });
}

bool Contenders::is_taken(std::size_t k, const Chosen& chosen) const {
  return any_single(k, [&](std::size_t single) {
    return std::any_of(chosen.begin(), chosen.end(),
                       [&](std::size_t other) { return same_place(single, other); });
  });
}

bool Contenders::same_place(std::size_t k, std::size_t other) const {
  return diagnosis::same_place(candidates_[k].effect, candidates_[other].effect);
}

bool Contenders::same_law(std::size_t k, std::size_t other) const {
  return diagnosis::same_law(candidates_[k].effect, candidates_[other].effect);
}

Chosen Contenders::of_other_times(std::size_t k) const {
  Chosen list;
  for (std::size_t i = 0; i < candidates_.size(); ++i) {
    const bool is_first = std::ranges::none_of(list, [&](std::size_t other) {
      return candidates_[other].effect.when == candidates_[i].effect.when;
    });
    if (candidates_[i].members.empty() && same_law(k, i) && is_first &&
        candidates_[i].effect.when != candidates_[k].effect.when) {
      list.push_back(i);
    }
  }
  return list;
}

std::size_t Contenders::cost(std::size_t k) const {
  const Effect& e = *candidates_[k].effect.effect;
  return candidates_[k].term.columns.size() + e.shape.size() + (e.transform.any() ? 1 : 0);
}

std::size_t Contenders::cost(const Chosen& chosen) const {
  std::size_t sum = 0;
  for (const std::size_t k : chosen) sum += cost(k);
  return sum;
}

Shortlist Contenders::shortlist(const Chosen& chosen, int length, const Chosen& excluded) const {
  Chosen open;
  for (std::size_t k = 0; k < candidates_.size(); ++k) {
    if (!is_taken(k, chosen) && !is_among(k, excluded) && !candidates_[k].only_rival) {
      open.push_back(k);
    }
  }
  return most_promising(open, chosen, length);
}

Chosen Contenders::rivals(const Chosen& chosen, int length) const {
  Chosen open;
  for (std::size_t k = 0; k < candidates_.size(); ++k) {
    if (!is_taken(k, chosen)) open.push_back(k);
  }
  return most_promising(open, chosen, length).listed;
}

Shortlist Contenders::most_promising(const Chosen& open, const Chosen& chosen, int length) const {
  std::vector<Term> open_terms;
  for (const std::size_t k : open) open_terms.push_back(candidates_[k].term);
  const auto promises = fits_.promises(terms(chosen), open_terms);
  std::vector<std::size_t> order(open.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return promises[a].gain > promises[b].gain;
  });
  Shortlist list;
  for (const std::size_t i : order) {
    // A load's moments must not crowd out what is something else.
    const auto of_one_place =
        std::count_if(list.listed.begin(), list.listed.end(),
                      [&](std::size_t other) { return same_place(open[i], other); });
    if (promises[i].hidden()) list.hidden.push_back(open[i]);
    if (promises[i].contained() && !contained_too_) continue;
    if (std::ssize(list.listed) < length && of_one_place < most_of_one_place) {
      list.listed.push_back(open[i]);
    }
  }
  return list;
}

Fit part_of(const Fit& fit, Eigen::Index from, Eigen::Index n) {
  return {fit.value.segment(from, n), fit.standard_error.segment(from, n),
          fit.between_blocks.segment(from, n), fit.left, fit.freedom};
}

}  // namespace shapeid::diagnosis
