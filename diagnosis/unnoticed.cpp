#include "shapeid/diagnosis/unnoticed.hpp"

#include <algorithm>
#include <cmath>

#include "shapeid/diagnosis/candidates.hpp"
#include "shapeid/diagnosis/loop_state.hpp"

namespace shapeid::diagnosis {
namespace {

/// E[theta^2] of each number of a hypothesis, by a fit whose last numbers these are.
Eigen::VectorXd mean_squares(const AppliedEffect& hypothesis, const Fit& fit) {
  Eigen::VectorXd squares(hypothesis.value.size());
  for (Eigen::Index p = 0; p < squares.size(); ++p) {
    const Parameter& parameter = hypothesis.effect->parameters[static_cast<std::size_t>(p)];
    const Eigen::Index at = fit.value.size() - squares.size() + p;
    const double theta = parameter.nonnegative ? std::max(fit.value[at], 0.0) : fit.value[at];
    squares[p] = std::pow(theta, 2) + std::pow(fit.standard_error[at], 2);
  }
  return squares;
}

/// The same of a hypothesis that the data say nothing of: lengths, angles and times, which have a
/// range, have their usual size; a rotor or a force, which depends on the robot, as much as moves
/// no inertial number (`moves`, a column a number of the hypothesis) further than by what it could
/// have (`sizes`).
Eigen::VectorXd mean_squares_if_hidden(const AppliedEffect& hypothesis,
                                       const Eigen::MatrixXd& moves, const Eigen::VectorXd& sizes) {
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(moves.cols());
  for (Eigen::Index p = 0; p < squares.size(); ++p) {
    const Parameter& parameter = hypothesis.effect->parameters[static_cast<std::size_t>(p)];
    const double furthest = moves.col(p).cwiseAbs().cwiseQuotient(sizes).maxCoeff();
    if (std::isfinite(parameter.limit)) {
      squares[p] = std::pow(parameter.size, 2);
    } else if (furthest > 0.0) {
      squares[p] = std::pow(furthest, -2);
    }
  }
  return squares;
}

}  // namespace

Unnoticed unnoticed(const Robot& robot, const Recording& log, const Recording* reference,
                    const LoopSettings& settings, const LoopResult& loop,
                    const Consistent& consistent) {
  LoopState state(robot, log, reference, settings);
  state.result = loop;
  state.result.model = consistent.model;
  Unnoticed result{consistent.Phi_error,
                   std::vector<std::string>(static_cast<std::size_t>(consistent.Phi_error.size()))};
  if (state.masses.columns.empty()) return result;
  std::vector<AppliedEffect> hypotheses = consistent.model.effects;
  const std::size_t present = hypotheses.size();
  for (const AppliedEffect& a : all_hypotheses(robot)) {
    if (!has_place_of(consistent.model.effects, a)) hypotheses.push_back(a);
  }
  const BlockFits fits = state.tallied(hypotheses);
  std::vector<Term> terms = state.terms_of_model(fits, present);
  std::vector<Term> others;
  for (std::size_t k = present; k < hypotheses.size(); ++k) {
    others.push_back(term_of(robot, fits.tally(), k));
  }
  const std::vector<BlockFits::Promise> promises = fits.promises(terms, others);
  const std::vector<Eigen::MatrixXd> moves = fits.moves(terms, others);
  Eigen::VectorXd most = Eigen::VectorXd::Zero(std::ssize(state.masses.columns));
  const Eigen::VectorXd sizes = settings.size(state.masses.columns);
  for (std::size_t k = 0; k < others.size(); ++k) {
    terms.push_back(others[k]);
    const Eigen::MatrixXd own_moves = moves[k].topRows(most.size());
    const AppliedEffect& hypothesis = hypotheses[present + k];
    const Eigen::VectorXd squares = promises[k].hidden()
                                        ? mean_squares_if_hidden(hypothesis, own_moves, sizes)
                                        : mean_squares(hypothesis, fits.fit(terms));
    terms.pop_back();
    const Eigen::VectorXd added = own_moves.cwiseAbs2() * squares;
    for (Eigen::Index i = 0; i < most.size(); ++i) {
      if (!(added[i] > most[i])) continue;
      most[i] = added[i];
      const Eigen::Index number = state.masses.columns[static_cast<std::size_t>(i)];
      result.error[number] = std::hypot(consistent.Phi_error[number], std::sqrt(added[i]));
      result.effect[static_cast<std::size_t>(number)] = others[k].id;
    }
  }
  return result;
}

void allow_for_filter(const Eigen::VectorXd& moves, const std::vector<int>& free_links,
                      Unnoticed& unnoticed) {
  for (const int link : free_links) {
    for (Eigen::Index number = Eigen::Index{10} * link; number < Eigen::Index{10} * link + 10;
         ++number) {
      unnoticed.error[number] = std::hypot(unnoticed.error[number], moves[number]);
    }
  }
}

bool is_far_from_given(const Robot& robot, const Consistent& consistent,
                       const Eigen::VectorXd& error, int link) {
  const double given = robot.links[static_cast<std::size_t>(link)].inertia.mass();
  if (!(given > 0.0)) return false;
  const Eigen::Index number = Eigen::Index{10} * link;
  const double found = consistent.model.Phi[number];
  constexpr double factor = 2.0, errors = 3.0;
  return (found < given / factor || found > factor * given) &&
         std::abs(found - given) > errors * error[number];
}

bool is_surely_far_from_given(const Robot& robot, const std::vector<int>& free_links,
                              const Consistent& consistent, const Eigen::VectorXd& error,
                              std::size_t place) {
  return consistent.data.determined.at(10 * place) &&
         is_far_from_given(robot, consistent, error, free_links.at(place));
}

}  // namespace shapeid::diagnosis
