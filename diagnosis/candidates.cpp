#include "shapeid/diagnosis/candidates.hpp"

#include <algorithm>
#include <numbers>
#include <optional>

#include "shapeid/diagnosis/effects.hpp"
#include "shapeid/diagnosis/load_places.hpp"

namespace shapeid::diagnosis {
namespace {

using std::numbers::pi;

double range_of(const Recording& log, int joint) {
  const auto [least, most] = std::minmax_element(
      log.samples().begin(), log.samples().end(),
      [&](const Sample& a, const Sample& b) { return a.q[joint] < b.q[joint]; });
  return most->q[joint] - least->q[joint];
}

/// A payload's term on the link's own columns.
Candidate payload_candidate(const Robot& robot, const Effect& effect, int link,
                            std::size_t from_block, double onset) {
  Candidate c{at_start(effect, link), {}, {}};
  if (c.effect.shape.size() > 0) c.effect.shape[0] = onset;
  c.term.id = hypothesis_id(robot, c.effect);
  c.term.from_block = from_block;
  for (Eigen::Index p = 0; p < 10; ++p) {
    c.term.columns.push_back(Eigen::Index{10} * link + p);
    c.term.nonnegative.push_back(p == 0);
  }
  return c;
}

/// The block from whose beginning on a load of the link explains most beside the masses. Blocks in
/// which the load is taken to be there and is not yet, or the other way round, cost more than many
/// others gain: between fixed moments a load that is plain to see was missed.
std::size_t likeliest_moment(const Robot& robot, const BlockFits& fits,
                             const std::vector<int>& free_links, int link) {
  std::vector<Term> loads;
  const std::size_t first = fits.first_block();
  const std::size_t end = fits.tally().blocks.size();
  for (std::size_t block = first + 1; block < end; ++block) {
    loads.push_back(payload_candidate(robot, *find_effect("payload_from"), link, block, 0.0).term);
  }
  const auto promises = fits.promises({term_of_masses(free_links)}, loads);
  const auto best =
      std::max_element(promises.begin(), promises.end(),
                       [](const auto& one, const auto& other) { return one.gain < other.gain; });
  return first + 1 + static_cast<std::size_t>(best - promises.begin());
}

/// The same effect at every joint together: what every drive has shows in the sum before it shows
/// in one.
void add_groups(std::vector<Candidate>& list) {
  const std::size_t singles = list.size();
  for (const Effect& effect : all_effects()) {
    if (effect.site != SiteKind::joint || effect.columns == nullptr) continue;
    for (const When when : every_when) {
      Candidate group;
      for (std::size_t k = 0; k < singles; ++k) {
        const AppliedEffect& single = list[k].effect;
        if (single.effect != &effect || single.when != when) continue;
        if (list[k].only_rival) continue;
        if (group.members.empty()) group = {single, {}, {}};
        group.members.push_back(k);
        group.choices = std::max(group.choices, list[k].choices);
        const Term& term = list[k].term;
        group.term.from_block = term.from_block;
        group.term.to_block = term.to_block;
        group.term.columns.insert(group.term.columns.end(), term.columns.begin(),
                                  term.columns.end());
      }
      group.term.nonnegative.assign(group.term.columns.size(), false);
      group.term.id = effect.id + "@every joint";
      if (group.members.size() > 1) list.push_back(group);
    }
  }
}

/// The number of that name in the effect's shape.
std::optional<double> shape_number(const AppliedEffect& effect, const std::string& name) {
  const std::vector<ShapeNumber>& all = effect.effect->shape;
  const auto own =
      std::find_if(all.begin(), all.end(), [&](const ShapeNumber& n) { return n.name == name; });
  if (own == all.end()) return std::nullopt;
  return effect.shape[own - all.begin()];
}

/// The hypothesis with those numbers of its shape that the model has found of another effect at the
/// same place, if there are any.
std::optional<AppliedEffect> with_shape_of_neighbours(AppliedEffect hypothesis,
                                                      const RichModel& model) {
  bool has_any = false;
  for (const AppliedEffect& found : model.effects) {
    if (found.effect->site != hypothesis.effect->site || found.site != hypothesis.site) continue;
    for (std::size_t i = 0; i < hypothesis.effect->shape.size(); ++i) {
      const ShapeNumber& own = hypothesis.effect->shape[i];
      const std::optional<double> number = shape_number(found, own.name);
      if (!number) continue;
      hypothesis.shape[static_cast<Eigen::Index>(i)] = std::clamp(*number, own.lower, own.upper);
      has_any = true;
    }
  }
  return has_any ? std::optional(hypothesis) : std::nullopt;
}

/// The candidate as one that acts at that time. Empty if it cannot (one of the model's that came
/// always did), or if the tally has that one with numbers of its own.
std::optional<Candidate> of_time(When when, Candidate c, const BlockFits& fits,
                                 const CandidateRule& rule) {
  const AppliedEffect known = c.effect;
  if (known.when != When::always && when != known.when) return std::nullopt;
  const bool is_change = when != When::always;
  if (is_change && (!rule.has_reference || known.effect->built_in || known.begins())) {
    return std::nullopt;
  }
  c.effect.when = when;
  if (when != known.when) {
    const bool has_own_numbers =
        std::ranges::any_of(fits.tally().hypotheses, [&](const AppliedEffect& other) {
          return other.when == when && same_place(other, c.effect);
        });
    if (has_own_numbers) return std::nullopt;
    if (known.effect->transform.any()) c.effect.value.setZero();
  }
  if (rule.excluded(c.effect)) return std::nullopt;
  fits.limit_to_time_of(c.effect, c.term);
  return c;
}

}  // namespace

std::vector<AppliedEffect> screened_hypotheses(const Robot& robot, const RichModel& model,
                                               const Rest& of_log,
                                               const std::optional<Rest>& earlier) {
  std::vector<AppliedEffect> list = all_hypotheses(robot), again;
  for (AppliedEffect& h : list) {
    const auto found = std::find_if(model.effects.begin(), model.effects.end(),
                                    [&](const AppliedEffect& a) { return same_place(a, h); });
    if (found != model.effects.end()) {
      h = *found;
      continue;
    }
    // How fast a joint must go until its dry friction is whole may be one number, whichever law it
    // is of: looked at with the usual one alone, a law would be told by that from another.
    if (const auto other = with_shape_of_neighbours(h, model)) again.push_back(*other);
    if (!is_ripple(h)) continue;
    const auto strongest = [&](const Rest& rest) {
      const ShapeNumber& N = h.effect->shape.front();
      return strongest_ripple(robot, rest.log, rest.left, h.site, h.site, RippleOf::torque, N.lower,
                              N.upper);
    };
    AppliedEffect gone = h;
    gone.when = When::gone;
    if (earlier && !has_place_of(model.effects, gone)) {
      gone.shape[0] = strongest(*earlier);
      again.push_back(gone);
    }
    h.shape[0] = strongest(of_log);
  }
  list.insert(list.end(), again.begin(), again.end());
  for (const AppliedEffect& a : model.effects) {
    if (a.effect->is_payload || (a.when != When::always && !has_place_of(list, a)))
      list.push_back(a);
  }
  return list;
}

bool is_ripple(const AppliedEffect& effect) { return effect.effect->id == "cogging"; }

double periods_told_apart(const Recording& log, const AppliedEffect& effect) {
  if (!is_ripple(effect)) return 1.0;
  const ShapeNumber& N = effect.effect->shape.front();
  return std::max(1.0, (N.upper - N.lower) * range_of(log, effect.site) / pi);
}

bool is_ripple_at_rest(const Recording& log, const AppliedEffect& effect) {
  constexpr double hardly = 0.5;  // rad, of phase
  return is_ripple(effect) && effect.shape[0] * range_of(log, effect.site) < hardly;
}

bool is_long_ripple(const Recording& log, const AppliedEffect& effect) {
  return is_ripple(effect) && effect.shape[0] * range_of(log, effect.site) < 4.0 * pi;
}

bool is_fast_ripple(const Recording& log, const AppliedEffect& effect, double frequency) {
  if (!is_ripple(effect)) return false;
  const double speed = 2.0 * pi * frequency / effect.shape[0];  // rad/s or m/s
  const auto fast = std::ranges::count_if(
      log.samples(), [&](const Sample& s) { return std::abs(s.dq[effect.site]) > speed; });
  return 2 * fast > std::ssize(log.samples());
}

Term term_of_masses(const std::vector<int>& links) {
  Term term{"masses", {}, {}, 0};
  for (const int link : links) {
    for (Eigen::Index p = 0; p < 10; ++p) term.columns.push_back(Eigen::Index{10} * link + p);
  }
  term.nonnegative.assign(term.columns.size(), false);
  return term;
}

Term term_of(const Robot& robot, const Tally& tally, std::size_t hypothesis) {
  const AppliedEffect& h = tally.hypotheses[hypothesis];
  Term term;
  term.id = hypothesis_id(robot, h);
  for (Eigen::Index p = 0; p < h.value.size(); ++p) {
    term.columns.push_back(tally.first[hypothesis] + p);
    const bool changes = h.effect->transform.any();  // the column is of a change, of either sign
    term.nonnegative.push_back(!changes &&
                               h.effect->parameters[static_cast<std::size_t>(p)].nonnegative);
  }
  return term;
}

std::vector<Candidate> candidates(const Robot& robot, const BlockFits& fits,
                                  const CandidateRule& rule) {
  const Tally& tally = fits.tally();
  std::vector<Candidate> list;
  for (std::size_t k = 0; k < tally.hypotheses.size(); ++k) {
    const AppliedEffect& h = tally.hypotheses[k];
    if (!rule.transformations && h.effect->transform.any()) continue;
    Candidate c{h, term_of(robot, tally, k), {}, rule.choices(h)};
    c.only_rival = !rule.several_shapes &&
                   std::any_of(tally.hypotheses.begin(),
                               tally.hypotheses.begin() + static_cast<std::ptrdiff_t>(k),
                               [&](const AppliedEffect& other) { return same_place(other, h); });
    for (const When when : every_when) {
      if (const std::optional<Candidate> other = of_time(when, c, fits, rule))
        list.push_back(*other);
    }
  }
  add_groups(list);
  const std::size_t first = fits.first_block();
  const auto blocks = static_cast<std::size_t>(fits.log_blocks());
  for (int link = 0; link < robot.link_count(); ++link) {
    const Effect& always = *find_effect("payload");
    const Effect& later = *find_effect("payload_from");
    if (!always.applies(robot, link)) continue;
    const auto add = [&](const Candidate& c) {
      if (!rule.excluded(c.effect)) list.push_back(c);
    };
    const bool is_free = std::count(rule.free_links.begin(), rule.free_links.end(), link) > 0;
    for (const When when : every_when) {
      if (when == When::always ? is_free : !rule.has_reference) continue;
      Candidate c = payload_candidate(robot, always, link, 0, 0.0);
      c.effect.when = when;
      fits.limit_to_time_of(c.effect, c.term);
      add(c);
    }
    constexpr std::size_t onsets = 9;
    std::vector<std::size_t> moments = {likeliest_moment(robot, fits, rule.free_links, link)};
    for (std::size_t i = 1; i < onsets; ++i) {
      const std::size_t block = first + i * blocks / onsets;
      if (block != first && block != moments.front()) moments.push_back(block);
    }
    for (const std::size_t block : moments) {
      add(payload_candidate(robot, later, link, block, tally.blocks[block].from));
    }
  }
  for (Candidate& c : list) {
    if (c.effect.effect->is_payload) c.room = room_for_load(robot, c.effect.site);
  }
  return list;
}

}  // namespace shapeid::diagnosis
