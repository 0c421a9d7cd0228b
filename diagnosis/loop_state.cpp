#include "shapeid/diagnosis/loop_state.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "shapeid/diagnosis/candidates.hpp"
#include "shapeid/diagnosis/filter_error.hpp"
#include "shapeid/diagnosis/fits_around.hpp"
#include "shapeid/diagnosis/prior.hpp"
#include "shapeid/diagnosis/torque_columns.hpp"
#include "shapeid/models/error.hpp"

namespace shapeid::diagnosis {
namespace {

void keep_within_limits(AppliedEffect& a) {
  for (Eigen::Index p = 0; p < a.value.size(); ++p) {
    const Parameter& parameter = a.effect->parameters[static_cast<std::size_t>(p)];
    const double lower = parameter.nonnegative ? 0.0 : -parameter.limit;
    a.value[p] = std::clamp(a.value[p], lower, parameter.limit);
  }
}

}  // namespace

LoopState::LoopState(const Robot& robot_, const Recording& log_, const Recording* reference_,
                     const LoopSettings& settings_)
    : robot(robot_), log(log_), settings(settings_) {
  if (reference_ != nullptr) reference = *reference_;
  centre = stacked_parameters(robot);
  result.model.Phi = centre;
  result.weight = settings.weight.size() > 0 ? settings.weight
                                             : Eigen::VectorXd(Eigen::VectorXd::Ones(robot.dof()));
  tally_options.stride = settings.stride;
  tally_options.margin = settings.margin;
  tally_options.threads = settings.threads;
  tally_options.log_starts = settings.log_starts;
  tally_options.block_seconds = settings.block_seconds;
  if (tally_options.block_seconds <= 0.0) {
    constexpr double wanted_blocks = 40.0;
    tally_options.block_seconds = std::max(shortest_block, log.duration() / wanted_blocks);
  }
  masses = term_of_masses(settings.shapes.free_links);
  silent = silent_joints(robot, log);
}

BlockFits LoopState::tallied(const std::vector<AppliedEffect>& hypotheses,
                             const std::vector<Modulation>& modulations) {
  Tally tally = empty_tally(robot, hypotheses, modulations);
  tally_options.weight = result.weight;
  if (reference) {
    TallyOptions options = tally_options;
    options.log_starts.clear();
    options.stride = log.stride_for(*reference, settings.stride);
    add_to_tally(tally, robot, settings.rows, result.model.in_reference(), *reference, options,
                 true);
  }
  add_to_tally(tally, robot, settings.rows, result.model, log, tally_options, false);
  constexpr std::ptrdiff_t fewest_blocks = 8;
  const auto blocks = std::count_if(tally.blocks.begin(), tally.blocks.end(),
                                    [](const Block& b) { return !b.reference; });
  if (blocks < fewest_blocks) {
    throw Refusal(
        "too-short",
        fmt::format("the log gives {} block{} of {:.2g} s to hold out, at least {} are "
                    "needed",
                    blocks, blocks == 1 ? "" : "s", tally_options.block_seconds, fewest_blocks));
  }
  BlockFits fits(std::move(tally), centre, settings.size, settings.folds);
  fits.set_prior(result.prior);
  return fits;
}

void LoopState::fit_masses() {
  BlockFits fits = tallied({});
  result.prior = choose_prior(fits, {masses});
  set_masses(fits.fit({masses}));
  rigid = result.model;
}

void LoopState::correct() {
  if (settings.rough == nullptr) return;
  const auto error = [&](const RichModel& model, const Recording& smooth, const Recording& rough) {
    const Viewer viewer(robot, settings.rows, model.acting());
    return filter_error(viewer, model, smooth, rough, settings.cutoff);
  };
  std::vector<Eigen::VectorXd> of_reference;
  if (reference && settings.rough_reference != nullptr) {
    of_reference = error(result.model.in_reference(), *reference, *settings.rough_reference);
  }
  use_correction(error(result.model, log, *settings.rough), of_reference);
}

void LoopState::use_correction(const std::vector<Eigen::VectorXd>& of_log,
                               const std::vector<Eigen::VectorXd>& of_reference) {
  result.correction = of_log;
  log.set_correction(of_log);
  result.reference_correction = of_reference;
  if (reference) reference->set_correction(of_reference);
}

void LoopState::reweigh() {
  const Series left = left_by(result.model);
  // A joint that never counts has no rows to weigh.
  const auto of_rows = [](const Eigen::VectorXd& rms) -> Eigen::VectorXd {
    return rms.array().isNaN().select(0.0, rms);
  };
  const Eigen::VectorXd rms = of_rows(left.rms());
  const Eigen::VectorXd logged = of_rows(row_rms(left.predicted - left.residual, left.counted));
  // A row that fits far better than the others would otherwise be fitted to its last digit, and
  // all to their rounding where a log is exact.
  constexpr double least_of_mean = 0.02, any = 1e-12;
  const double floor = std::max({least_of_mean * rms.mean(), least_share * logged.mean(), any});
  Eigen::VectorXd sigma = rms.cwiseMax(floor);
  auto joints = sigma.tail(robot.joint_count());
  Eigen::VectorXd of_driven = joints;
  for (const int j : silent) of_driven[j] = std::numeric_limits<double>::infinity();
  for (const int j : silent) joints[j] = std::max(joints[j], of_driven.minCoeff());
  result.weight = sigma.cwiseAbs2().cwiseInverse();
}

Series LoopState::left_by(const RichModel& model) const {
  return series(robot, settings.rows, model, log, settings.stride);
}

std::optional<Rest> LoopState::rest_of_reference(const RichModel& model) const {
  if (!reference) return std::nullopt;
  return Rest{*reference, series(robot, settings.rows, model.in_reference(), *reference,
                                 log.stride_for(*reference, settings.stride))};
}

void LoopState::collect_effects() {
  result.model.effects.clear();
  for (Found& f : result.found) {
    if (f.effect.effect->transform.any()) keep_within_limits(f.effect);
    f.effect.to_first_order = f.effect.effect->filters_load && result.filters_to_first_order;
    result.model.effects.push_back(f.effect);
  }
}

SelectionRule LoopState::rule() const {
  constexpr double gravity = 9.81;
  SelectionRule rule = settings.rule;
  rule.threads = settings.threads;
  rule.most_force =
      std::min(rule.most_force, gravity * std::max(robot.mass(), settings.expected_mass));
  return rule;
}

double LoopState::mass_off_by(int link) const {
  const double over_given = result.model.Phi[Eigen::Index{10} * link] /
                            robot.links[static_cast<std::size_t>(link)].inertia.mass();
  if (!(over_given > 0.0)) return std::numeric_limits<double>::infinity();
  return std::max(over_given, 1.0 / over_given);
}

void LoopState::set_masses(const Fit& fit) {
  result.model.Phi = centre;
  for (std::size_t i = 0; i < masses.columns.size(); ++i) {
    result.model.Phi[masses.columns[i]] += fit.value[static_cast<Eigen::Index>(i)];
  }
}

bool LoopState::is_applied_transformation(const AppliedEffect& effect) const {
  return effect.effect->transform.any() && has_place_of(result.model.effects, effect);
}

Term LoopState::always(const Tally& tally) const {
  Term term = masses;
  for (std::size_t k = 0; k < tally.hypotheses.size(); ++k) {
    if (!is_applied_transformation(tally.hypotheses[k])) continue;
    const Term change = term_of(robot, tally, k);
    term.columns.insert(term.columns.end(), change.columns.begin(), change.columns.end());
  }
  term.nonnegative.assign(term.columns.size(), false);
  return term;
}

std::vector<Term> LoopState::terms_of_model(const BlockFits& fits, std::size_t effects) const {
  std::vector<Term> terms = {always(fits.tally())};
  for (std::size_t k = 0; k < effects; ++k) {
    const AppliedEffect& a = fits.tally().hypotheses[k];
    if (a.effect->transform.any()) continue;
    terms.push_back(term_of(robot, fits.tally(), k));
    fits.limit_to_time_of(a, terms.back());
  }
  return terms;
}

Eigen::VectorXd LoopState::held_out_of_model() {
  const BlockFits fits = tallied(result.model.effects);
  return fits.held_out(terms_of_model(fits, fits.tally().hypotheses.size()));
}

Eigen::VectorXd LoopState::held_out_of_log() {
  const BlockFits fits = tallied(result.model.effects);
  return fits.held_out(terms_of_model(fits, fits.tally().hypotheses.size()))
      .tail(fits.log_blocks());
}

LoopState::HeldOut LoopState::held_out_either_way() {
  const BlockFits fits = tallied(result.model.effects);
  std::vector<Term> terms = terms_of_model(fits, fits.tally().hypotheses.size());
  HeldOut error{fits.held_out(terms), {}};
  terms.front() = masses;
  error.as_written = fits.held_out(terms);
  return error;
}

std::vector<Gain> LoopState::gains() {
  std::vector<Gain> gains(result.found.size());
  const BlockFits fits = tallied(result.model.effects);
  const FitsAround around(fits, terms_of_model(fits, gains.size()));
  std::optional<HeldOut> with;
  std::size_t next = 1;  // after the masses
  for (std::size_t k = 0; k < gains.size(); ++k) {
    if (result.found[k].effect.effect->transform.any()) {
      if (!with) with = held_out_either_way();
      gains[k] = gain_as_it_is(k, *with);
    } else {
      gains[k] = gain_of(around.without(next++), around.error());
    }
  }
  return gains;
}

Gain LoopState::gain_as_it_is(std::size_t i, const HeldOut& with) {
  const std::vector<Found> all = result.found;
  result.found.erase(result.found.begin() + static_cast<std::ptrdiff_t>(i));
  collect_effects();
  const HeldOut without = held_out_either_way();
  result.found = all;
  collect_effects();
  const Gain as_written = gain_of(without.as_written, with.as_written);
  return as_written.share > 0.0 ? gain_of(without.moved_on, with.moved_on) : as_written;
}

std::vector<Gain> LoopState::gains_by_derivative() {
  const BlockFits fits = tallied(result.model.effects);
  std::vector<Term> terms = {masses};
  for (std::size_t k = 0; k < result.model.effects.size(); ++k) {
    const AppliedEffect& a = result.model.effects[k];
    terms.push_back(term_of(robot, fits.tally(), k));
    fits.limit_to_time_of(a, terms.back());
  }
  const FitsAround around(fits, std::move(terms));
  std::vector<Gain> gains(result.model.effects.size());
  for (std::size_t k = 0; k < gains.size(); ++k) {
    const AppliedEffect& a = result.model.effects[k];
    if (!a.effect->transform.any()) continue;
    gains[k] = gain_of(around.fixed_at(1 + k, -a.value), around.error());
  }
  return gains;
}

}  // namespace shapeid::diagnosis
