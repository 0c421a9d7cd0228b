#include "shapeid/diagnosis/constancy.hpp"

#include <algorithm>
#include <cmath>

#include "shapeid/diagnosis/chance.hpp"
#include "shapeid/diagnosis/fits_around.hpp"
#include "shapeid/models/student.hpp"

namespace shapeid::diagnosis {
namespace {

constexpr double false_alarms = 0.01;  // of all variations that are tried on a log

}  // namespace

std::string variable_of(const Variation& variation, const Robot& robot) {
  if (variation.signal == Signal::time) return "time";
  const std::string& joint = robot.joint(variation.joint).name;
  switch (variation.signal) {
    case Signal::position:
      return "q." + joint;
    case Signal::speed:
    case Signal::direction:
      return "dq." + joint;
    case Signal::load:
    case Signal::side:
    case Signal::peak:
    case Signal::row:
    case Signal::yield:
    case Signal::play:
      return "tau." + joint;
    case Signal::turned:
      return "turn." + joint;
    case Signal::time:
      break;
  }
  return "time";
}

std::optional<int> joint_of(const Robot& robot, const AppliedEffect& effect) {
  int link = 0;
  switch (effect.effect->site) {
    case SiteKind::joint:
      return effect.site;
    case SiteKind::link:
      link = effect.site;
      break;
    case SiteKind::contact:
      link = robot.contacts[static_cast<std::size_t>(effect.site)].link;
      break;
    case SiteKind::accelerometer:
    case SiteKind::whole:
      break;
  }
  return link > 0 ? std::optional(link - 1) : std::nullopt;
}

std::vector<bool> reach_of(const Robot& robot, const AppliedEffect& effect) {
  const std::optional<int> joint = joint_of(robot, effect);
  std::vector<bool> reach(static_cast<std::size_t>(robot.joint_count()), !joint);
  if (!joint) return reach;
  const Transformation& transform = effect.effect->transform;
  const bool moves_links = transform.robot != nullptr || transform.sample != nullptr;
  const bool turns_parent = effect.effect->id == "rotor_reaction";
  if (effect.effect->site == SiteKind::joint && !moves_links && !turns_parent) {
    reach[static_cast<std::size_t>(*joint)] = true;
    return reach;
  }
  const auto mark_path = [&](int link) {
    for (; link > 0; link = robot.links[static_cast<std::size_t>(link)].parent) {
      reach[static_cast<std::size_t>(link) - 1] = true;
    }
  };
  mark_path(*joint + 1);
  for (int link = *joint + 2; moves_links && link < robot.link_count(); ++link) {
    int before = link;
    while (before > *joint + 1) before = robot.links[static_cast<std::size_t>(before)].parent;
    if (before == *joint + 1) mark_path(link);
  }
  return reach;
}

std::vector<Modulation> modulations(const Robot& robot, const std::vector<AppliedEffect>& effects) {
  std::vector<Modulation> list;
  for (std::size_t k = 0; k < effects.size(); ++k) {
    const AppliedEffect& a = effects[k];
    const std::optional<int> joint = joint_of(robot, a);
    if (!a.effect->is_payload) list.push_back({k, Signal::time, joint.value_or(-1)});
    if (a.effect->site == SiteKind::whole) {
      for (int j = 0; j < robot.joint_count(); ++j) list.push_back({k, Signal::row, j});
    }
    if (!joint) continue;
    for (const Signal signal : joint_signals) list.push_back({k, signal, *joint});
  }
  return list;
}

std::vector<std::optional<Variation>> variations(const BlockFits& fits,
                                                 const std::vector<Term>& terms,
                                                 const Eigen::VectorXd& own_gain) {
  const Tally& tally = fits.tally();
  const auto effects = static_cast<std::size_t>(own_gain.size());
  std::vector<std::optional<Variation>> result(effects);
  double tried = 0.0;
  for (const Modulation& m : tally.modulations) {
    if (m.hypothesis >= effects) continue;
    tried += static_cast<double>(tally.hypotheses[m.hypothesis].value.size());
  }
  const double least = limit_for(least_z(false_alarms, tried), fits.blocks());
  const FitsAround now(fits, terms);
  for (std::size_t k = 0; k < tally.modulations.size(); ++k) {
    const Modulation& m = tally.modulations[k];
    if (m.hypothesis >= effects) continue;
    const Eigen::Index n = tally.hypotheses[m.hypothesis].value.size();
    Term term;
    for (Eigen::Index p = 0; p < n; ++p) term.columns.push_back(tally.first_modulated[k] + p);
    term.nonnegative.assign(term.columns.size(), false);
    for (const Term& own : terms) {
      const bool same = !own.columns.empty() && own.columns.front() == tally.first[m.hypothesis];
      if (same) {
        term.from_block = own.from_block;
        term.to_block = own.to_block;
      }
    }
    // Of a transformation there is no term.
    fits.limit_to_time_of(tally.hypotheses[m.hypothesis], term);
    const double gain = (now.error() - now.with(term)).sum();
    const double share = gain / own_gain[static_cast<Eigen::Index>(m.hypothesis)];
    if (!(share > material_share)) continue;
    std::vector<Term> richer = terms;
    richer.push_back(term);
    const Fit fit = fits.fit(richer);
    const double z =
        errors_from_zero(fit.value.tail(n), fit.standard_error.tail(n)).abs().maxCoeff();
    if (!(z > least)) continue;
    std::optional<Variation>& best = result[m.hypothesis];
    if (!best || share > best->share) best = Variation{m.signal, m.joint, share, z};
  }
  return result;
}

}  // namespace shapeid::diagnosis
