#include "shapeid/diagnosis/strangers.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "shapeid/diagnosis/candidates.hpp"
#include "shapeid/diagnosis/constancy.hpp"
#include "shapeid/diagnosis/effects.hpp"
#include "shapeid/diagnosis/gears.hpp"

namespace shapeid::diagnosis {
namespace {

/// Whether the joint's torque is seldom so light that noise decides its side: play of an unloaded
/// gear cannot be seen.
bool drives_from_a_side(const Recording& log, int joint) {
  constexpr double seldom = 0.1;  // of the samples
  const double light = light_load(log, joint);
  const auto count = std::count_if(log.samples().begin(), log.samples().end(),
                                   [&](const Sample& s) { return std::abs(s.tau[joint]) < light; });
  return static_cast<double>(count) < seldom * static_cast<double>(log.samples().size());
}

}  // namespace

std::string law_id(const Stranger& stranger, const Robot& robot) {
  std::string id = hypothesis_id(robot, stranger.carrier);
  if (stranger.law.signal == Signal::yield) id += " that yields";
  if (stranger.law.signal == Signal::play) id += " with play";
  return id;
}

std::string law_text(const Stranger& stranger, const Robot& robot) {
  if (stranger.law.of_gear()) return law_id(stranger, robot);
  return law_id(stranger, robot) + " over " +
         variable_of({stranger.law.signal, stranger.law.joint}, robot);
}

std::vector<AppliedEffect> carriers(const Robot& robot, const std::vector<AppliedEffect>& effects) {
  std::vector<AppliedEffect> list;
  for (const AppliedEffect& h : all_hypotheses(robot)) {
    if (h.effect->site != SiteKind::joint) continue;
    if (h.effect->built_in || h.effect->filters_load) continue;
    if (h.value.size() > 1 || h.shape.size() > 1) continue;
    if (!has_place_of(effects, h)) list.push_back(h);
  }
  for (int joint = 0; joint < robot.joint_count(); ++joint) {
    list.push_back(at_start(motor_ahead(), joint));
  }
  return list;
}

std::vector<AppliedEffect> ripple_carriers(const Robot& robot, const Recording& log,
                                           const Series& rigid, const Series& left) {
  const Effect& ripple = *find_effect("cogging");
  const ShapeNumber& N = ripple.shape.front();
  std::vector<AppliedEffect> list;
  for (int joint = 0; joint < robot.joint_count(); ++joint) {
    std::set<double> periods;
    for (const Series* of : {&rigid, &left}) {
      periods.insert(
          strongest_ripple(robot, log, *of, joint, joint, RippleOf::load, N.lower, N.upper));
    }
    for (const double period : periods) {
      list.push_back(at_start(ripple, joint));
      list.back().shape[0] = period;
    }
  }
  return list;
}

std::vector<Modulation> modulated_carriers(const Recording& log,
                                           const std::vector<AppliedEffect>& hypotheses,
                                           std::size_t first, std::size_t last) {
  std::vector<Modulation> list;
  for (std::size_t k = first; k < last; ++k) {
    if (hypotheses[k].effect == &motor_ahead()) {
      list.push_back({k, Signal::yield, hypotheses[k].site});
      if (drives_from_a_side(log, hypotheses[k].site)) {
        list.push_back({k, Signal::play, hypotheses[k].site});
      }
      continue;
    }
    if (hypotheses[k].value.size() > 1) {
      list.push_back({k, Signal::load, hypotheses[k].site});
      continue;
    }
    for (const Signal signal : joint_signals) list.push_back({k, signal, hypotheses[k].site});
    list.push_back({k, Signal::time, hypotheses[k].site});
    if (hypotheses[k].effect->id != "torque_gain") continue;
    for (std::size_t level = 0; level < high_levels.size(); ++level) {
      list.push_back({k, Signal::peak, hypotheses[k].site, level});
    }
  }
  return list;
}

}  // namespace shapeid::diagnosis
