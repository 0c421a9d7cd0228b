#include "shapeid/diagnosis/needed.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "shapeid/diagnosis/body_sums.hpp"
#include "shapeid/diagnosis/candidates.hpp"
#include "shapeid/diagnosis/chance.hpp"
#include "shapeid/diagnosis/effects.hpp"
#include "shapeid/diagnosis/unnoticed.hpp"
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

void take_number(const Consistent& consistent, Found& rotor) {
  const auto& effects = consistent.model.effects;
  for (std::size_t k = 0; k < effects.size(); ++k) {
    if (!same_place(effects[k], rotor.effect)) continue;
    rotor.effect.value = effects[k].value;
    rotor.standard_error = consistent.effect_error[k];
  }
}

}  // namespace

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
