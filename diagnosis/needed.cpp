#include "shapeid/diagnosis/needed.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "shapeid/diagnosis/body_sums.hpp"
#include "shapeid/diagnosis/candidates.hpp"
#include "shapeid/diagnosis/chance.hpp"
#include "shapeid/diagnosis/credibility.hpp"
#include "shapeid/diagnosis/effects.hpp"
#include "shapeid/diagnosis/loop_state.hpp"
#include "shapeid/diagnosis/unnoticed.hpp"
#include "shapeid/diagnosis/verdicts.hpp"
#include "shapeid/models/student.hpp"

namespace shapeid::diagnosis {
namespace {

/// Whether the joint moves one of the links.
bool moves_any(const Robot& robot, int joint, const std::vector<int>& links) {
  const int first = joint + 1;  // the link that it carries
  return std::any_of(links.begin(), links.end(), [&](int link) {
    while (link > first) link = robot.links[static_cast<std::size_t>(link)].parent;
    return link == first;
  });
}

std::vector<int> far_from_given(const Robot& robot, const LoopSettings& settings,
                                const Consistent& consistent) {
  std::vector<int> links;
  for (const int link : settings.shapes.free_links) {
    if (is_far_from_given(robot, consistent, consistent.Phi_error, link)) links.push_back(link);
  }
  return links;
}

/// At joints that move one of the links.
std::vector<Found> rotors_that_may_lack(const Robot& robot, const std::vector<int>& links,
                                        const LoopResult& loop) {
  std::vector<Found> list;
  const Effect& rotor = *find_effect("rotor_inertia");
  for (int joint = 0; joint < robot.joint_count(); ++joint) {
    const AppliedEffect at = at_start(rotor, joint);
    if (has_place_of(loop.model.effects, at)) continue;
    if (!moves_any(robot, joint, links)) continue;
    Found found{at, rotor.id + "@" + site_name(robot, rotor.site, joint), Eigen::VectorXd::Zero(1)};
    found.needed = true;
    list.push_back(std::move(found));
  }
  return list;
}

LoopResult with(const LoopResult& loop, const std::vector<Found>& more) {
  LoopResult result = loop;
  for (const Found& f : more) {
    result.found.push_back(f);
    result.model.effects.push_back(f.effect);
  }
  return result;
}

/// Standard errors from zero; none if it was dropped.
double size_in(const Consistent& consistent, const AppliedEffect& rotor) {
  const auto& effects = consistent.model.effects;
  for (std::size_t k = 0; k < effects.size(); ++k) {
    if (same_place(effects[k], rotor)) return effects[k].value[0] / consistent.effect_error[k][0];
  }
  return 0.0;
}

void take_number(const Consistent& consistent, Found& found) {
  const auto& effects = consistent.model.effects;
  for (std::size_t k = 0; k < effects.size(); ++k) {
    if (!same_place(effects[k], found.effect)) continue;
    found.effect.value = effects[k].value;
    found.standard_error = consistent.effect_error[k];
  }
}

/// Of what the free numbers hide, all that has columns of its own and no place in the model yet.
std::vector<Found> hidden_causes(const Robot& robot, const LoopResult& loop) {
  std::vector<Found> list;
  for (const AppliedEffect& h : all_hypotheses(robot)) {
    const std::string id = hypothesis_id(robot, h);
    if (h.effect->transform.any() || h.effect->is_payload || !h.effect->shape.empty()) continue;
    if (std::count(loop.hidden.begin(), loop.hidden.end(), id) == 0) continue;
    if (has_place_of(loop.model.effects, h)) continue;
    Found& found = list.emplace_back(Found{h, id, Eigen::VectorXd::Zero(h.value.size())});
    found.needed = h.effect->id == "rotor_inertia" || h.effect->id == "rotor_reaction";
    found.hangs_on_given = !found.needed;
  }
  return list;
}

/// Weighted squared error of a model on the log, block by block, as many as the loop had.
Eigen::VectorXd errors_of(const LoopState& state, const RichModel& model) {
  const Series left = state.left_by(model);
  const auto count = std::ssize(left.index),
             blocks = static_cast<std::ptrdiff_t>(state.result.blocks);
  Eigen::VectorXd errors = Eigen::VectorXd::Zero(blocks);
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const Eigen::ArrayXd rows = left.counted.col(i).select(left.residual.col(i).array(), 0.0);
    errors[i * blocks / count] += (rows.square() * state.result.weight.array()).sum();
  }
  return errors;
}

struct WithCause {
  Found found;
  Consistent bodies;
  Eigen::VectorXd error;
};

/// The best first, if there is any.
std::vector<WithCause> causes_that_help(const LoopState& state, const Recording* reference,
                                        const LoopResult& loop, const Eigen::VectorXd& error,
                                        const Eigen::VectorXd& error_free) {
  const SelectionRule rule = state.rule();
  const double tried = static_cast<double>(loop.hypotheses);
  const double least_t = limit_for(rule.least_t, error.size());
  const double least_size = limit_for(least_z(rule.false_alarms, tried), tenths);
  constexpr double most_lacking = 0.2;  // of what bodies lacked without the cause
  const double most = error_free.sum() + most_lacking * (error.sum() - error_free.sum());
  std::vector<WithCause> list;
  for (Found& found : hidden_causes(state.robot, loop)) {
    Consistent bodies =
        make_consistent(state.robot, state.log, reference, state.settings, with(loop, {found}));
    take_number(bodies, found);
    const AppliedEffect& cause = found.effect;
    if (!has_place_of(bodies.model.effects, cause)) continue;
    if (over_limit(*cause.effect, cause.value, rule.most_force) > 1.0) continue;
    if (!(differs_from_zero(*cause.effect, cause.value, found.standard_error, 1.0) > least_size)) {
      continue;
    }
    Eigen::VectorXd left = errors_of(state, bodies.model);
    const Gain gain = gain_of(error, left);
    if (!(gain.t > least_t) || left.sum() > most) continue;
    found.gain = gain.share;
    found.t = gain.t;
    list.push_back({std::move(found), std::move(bodies), std::move(left)});
  }
  std::stable_sort(list.begin(), list.end(), [](const WithCause& a, const WithCause& b) {
    return a.error.sum() < b.error.sum();
  });
  return list;
}

/// The simplest of those that predict as well as the first; the others are named beside it.
WithCause simplest_of(std::vector<WithCause> list) {
  const Eigen::VectorXd best = list.front().error;
  std::erase_if(list, [&](const WithCause& c) { return gain_of(c.error, best).t > told_apart_t; });
  const auto chosen =
      std::min_element(list.begin(), list.end(), [](const WithCause& a, const WithCause& b) {
        return a.found.effect.value.size() < b.found.effect.value.size();
      });
  for (const WithCause& other : list) {
    if (&other != &*chosen) chosen->found.ambiguous_with.push_back(other.found.id);
  }
  std::sort(chosen->found.ambiguous_with.begin(), chosen->found.ambiguous_with.end());
  return std::move(*chosen);
}

}  // namespace

void add_needed_causes(const Robot& robot, const Recording& log, const Recording* reference,
                       const LoopSettings& settings, LoopResult& loop, Consistent& consistent) {
  LoopState state(robot, log, reference, settings);
  state.result = loop;
  const Eigen::VectorXd error_free = errors_of(state, loop.model);
  const double least_t = limit_for(settings.rule.least_t, error_free.size());
  constexpr int most = 2;
  for (int added = 0; added < most; ++added) {
    const Eigen::VectorXd error = errors_of(state, consistent.model);
    if (!(gain_of(error, error_free).t > least_t)) return;
    std::vector<WithCause> list = causes_that_help(state, reference, loop, error, error_free);
    if (list.empty()) return;
    WithCause chosen = simplest_of(std::move(list));
    loop = with(loop, {chosen.found});
    std::erase(loop.hidden, chosen.found.id);
    // They were sought beside masses that stood for this. What bodies and it leave is looked at
    // anyway.
    loop.strangers.clear();
    consistent = std::move(chosen.bodies);
  }
}

void add_needed_rotors(const Robot& robot, const Recording& log, const Recording* reference,
                       const LoopSettings& settings, LoopResult& loop, Consistent& consistent) {
  const double least =
      limit_for(least_z(settings.rule.false_alarms, static_cast<double>(loop.hypotheses)), tenths);
  const std::vector<int> far = far_from_given(robot, settings, consistent);
  std::vector<Found> rotors = rotors_that_may_lack(robot, far, loop);
  while (!rotors.empty()) {
    Consistent bodies = make_consistent(robot, log, reference, settings, with(loop, rotors));
    const std::size_t before = rotors.size();
    std::erase_if(rotors, [&](const Found& f) { return !(size_in(bodies, f.effect) > least); });
    if (rotors.size() < before) continue;
    if (far_from_given(robot, settings, bodies).size() >= far.size()) return;
    for (Found& f : rotors) take_number(bodies, f);
    loop = with(loop, rotors);
    consistent = std::move(bodies);
    return;
  }
}

}  // namespace shapeid::diagnosis
