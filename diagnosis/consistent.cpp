#include "shapeid/diagnosis/consistent.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "shapeid/diagnosis/candidates.hpp"
#include "shapeid/diagnosis/chance.hpp"
#include "shapeid/diagnosis/credibility.hpp"
#include "shapeid/diagnosis/fits.hpp"
#include "shapeid/diagnosis/shape_masses.hpp"
#include "shapeid/reference/identify.hpp"

namespace shapeid::diagnosis {
namespace {

constexpr int tenths = 10;

/// Sums over [Y_free, E, F], with known links moved to F.
class Sums {
 public:
  Sums(const BodyModel& shapes, Tally tally, const std::vector<bool>& since)
      : tally_(std::move(tally)),
        target_(tally_.columns()),
        effects_(tally_.columns() - tally_.inertial),
        precision_((wider * wide_sizes(tally_)).cwiseAbs2().cwiseInverse()) {
    for (const int link : shapes.free_links) {
      for (Eigen::Index p = 0; p < 10; ++p) kept_.push_back(Eigen::Index{10} * link + p);
    }
    for (Eigen::Index e = 0; e <= effects_; ++e) kept_.push_back(tally_.inertial + e);
    known_ = Eigen::VectorXd::Zero(target_ + 1);
    known_.head(tally_.inertial) = shapes.known;
    for (Block& block : tally_.blocks) {
      reduce(block, since);
      if (block.reference) ++reference_blocks_;
    }
  }

  /// Rows of [Y_free, E, F] with each block's squares. `size`: of Y's and E's numbers. What is
  /// smaller than the sums' own rounding counts as nothing.
  [[nodiscard]] std::vector<reference::RowBlock> blocks(const Eigen::VectorXd& size) const {
    Eigen::VectorXd scale(std::ssize(kept_));
    scale << size, 1.0;
    std::vector<reference::RowBlock> list;
    for (const Block& block : tally_.blocks) {
      const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scale.asDiagonal() * block.sums *
                                                                 scale.asDiagonal());
      const Eigen::VectorXd& squares = eigen.eigenvalues();
      const double rounding = static_cast<double>(squares.size()) *
                              std::numeric_limits<double>::epsilon() * squares.maxCoeff();
      const Eigen::VectorXd length = (squares.array() > rounding).select(squares, 0.0).cwiseSqrt();
      list.push_back({length.asDiagonal() * eigen.eigenvectors().transpose() *
                      scale.cwiseInverse().asDiagonal()});
    }
    return list;
  }

  /// Of each effect's column the number with which it alone would be as large as F.
  [[nodiscard]] Eigen::VectorXd effect_sizes() const {
    const Eigen::MatrixXd G = without(-1);
    const double F = G(G.rows() - 1, G.cols() - 1);
    return (F / G.diagonal().segment(masses(), effects_).array().max(1e-30 * F)).sqrt();
  }

  [[nodiscard]] Eigen::Index effects() const { return effects_; }
  /// One over the variance of each effect's number before any data: enough to leave a number that
  /// no data show at zero, and nothing to any other (rotors of a hundred usual sizes are found
  /// here).
  [[nodiscard]] const Eigen::VectorXd& precision() const { return precision_; }
  [[nodiscard]] Eigen::Index masses() const { return std::ssize(kept_) - effects_ - 1; }

  /// Of all blocks but a tenth of each log; -1: of all. Were the two logs one, a tenth of a long
  /// reference and a short log would hold all that came since.
  [[nodiscard]] Eigen::MatrixXd without(int tenth) const {
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(std::ssize(kept_), std::ssize(kept_));
    for (std::size_t b = 0; b < tally_.blocks.size(); ++b) {
      if (tenth_of(b) != tenth) sum += tally_.blocks[b].sums;
    }
    return sum;
  }

  /// In how many tenths each effect's column is anything at all.
  [[nodiscard]] Eigen::ArrayXi tenths_with_effects() const {
    Eigen::ArrayXXd squares = Eigen::ArrayXXd::Zero(effects_, tenths);
    for (std::size_t b = 0; b < tally_.blocks.size(); ++b) {
      squares.col(tenth_of(b)) +=
          tally_.blocks[b].sums.diagonal().segment(masses(), effects_).array();
    }
    constexpr double hardly_any = 1e-6;  // of all
    const Eigen::ArrayXd least = hardly_any * squares.rowwise().sum();
    return (squares > least.replicate(1, tenths)).cast<int>().rowwise().sum();
  }

 private:
  static constexpr double wider = 1e4;

  [[nodiscard]] int tenth_of(std::size_t b) const {
    const std::size_t first = tally_.blocks[b].reference ? 0 : reference_blocks_;
    const std::size_t count =
        tally_.blocks[b].reference ? reference_blocks_ : tally_.blocks.size() - reference_blocks_;
    return static_cast<int>(tenths * (b - first) / count);
  }

  void reduce(Block& block, const std::vector<bool>& since) const {
    Eigen::MatrixXd G = block.sums;
    const Eigen::Index F = target_;
    const Eigen::VectorXd Gx = G * known_;
    G(F, F) += known_.dot(Gx) - 2.0 * Gx[F];
    G.col(F).head(F) -= Gx.head(F);
    G.row(F).head(F) = G.col(F).head(F).transpose();
    block.sums = G(kept_, kept_);
    if (!block.reference) return;
    for (std::size_t k = 0; k < since.size(); ++k) {
      if (!since[k]) continue;
      const Eigen::Index from = masses() + tally_.first[k] - tally_.inertial;
      const Eigen::Index n = tally_.hypotheses[k].value.size();
      block.sums.middleRows(from, n).setZero();
      block.sums.middleCols(from, n).setZero();
    }
  }

  Tally tally_;
  std::size_t reference_blocks_ = 0;  ///< which come first
  Eigen::Index target_;               ///< column of F before anything is left out
  Eigen::Index effects_;
  Eigen::VectorXd precision_;
  std::vector<Eigen::Index> kept_;
  Eigen::VectorXd known_;
};

/// Rows with the sums' squares, after the effects have taken what they can.
struct Eliminated {
  Eigen::MatrixXd rows;  ///< [Y_free, F]
  Eigen::MatrixXd gain;  ///< theta = gain (Phi_free, -1) with the sign turned: see effects_of
};

/// `precision`: of the effects' numbers before any data.
Eliminated eliminate(const Eigen::MatrixXd& G, Eigen::Index masses,
                     const Eigen::VectorXd& precision) {
  const Eigen::Index effects = precision.size();
  Eigen::MatrixXd outer(masses + 1, masses + 1);
  outer.topLeftCorner(masses, masses) = G.topLeftCorner(masses, masses);
  outer.topRightCorner(masses, 1) = G.topRightCorner(masses, 1);
  outer.bottomLeftCorner(1, masses) = G.bottomLeftCorner(1, masses);
  outer(masses, masses) = G(G.rows() - 1, G.cols() - 1);
  Eigen::MatrixXd cross(effects, masses + 1);
  cross << G.block(masses, 0, effects, masses), G.block(masses, G.cols() - 1, effects, 1);
  Eliminated result{{}, Eigen::MatrixXd::Zero(effects, masses + 1)};
  if (effects > 0) {
    Eigen::MatrixXd E = G.block(masses, masses, effects, effects);
    E.diagonal() = (1.0 + regularity) * E.diagonal() + precision;
    result.gain = E.ldlt().solve(cross);
    outer -= cross.transpose() * result.gain;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(outer);
  result.rows =
      eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal() * eigen.eigenvectors().transpose();
  return result;
}

Eigen::VectorXd effects_of(const Eliminated& eliminated, const Eigen::VectorXd& Phi_free) {
  Eigen::VectorXd x(Phi_free.size() + 1);
  x << -Phi_free, 1.0;
  return eliminated.gain * x;
}

class Solver {
 public:
  Solver(const Robot& robot, const Sums& sums, const LoopSettings& settings, const LoopResult& loop)
      : sums_(sums), settings_(settings) {
    const BodyModel& shapes = settings.shapes;
    const Eigen::VectorXd given = stacked_parameters(robot);
    prior_ = Eigen::VectorXd::Zero(sums.masses());
    given_ = prior_;
    for (std::size_t i = 0; i < shapes.free_links.size(); ++i) {
      const Eigen::Index from = Eigen::Index{10} * shapes.free_links[i];
      const auto at = 10 * static_cast<Eigen::Index>(i);
      given_.segment<10>(at) = given.segment<10>(from);
      prior_.segment<10>(at) =
          std::sqrt(loop.prior) * settings.size.segment<10>(from).cwiseInverse();
    }
  }

  [[nodiscard]] Eliminated rows(int tenth) const {
    return eliminate(sums_.without(tenth), sums_.masses(), sums_.precision());
  }

  /// Y and F of the mass problem, W of ones.
  [[nodiscard]] MassProblem problem_of(const Eliminated& eliminated) const {
    const Eigen::Index n = sums_.masses();
    MassProblem problem;
    problem.Y.resize(eliminated.rows.rows() + n, n);
    problem.Y << eliminated.rows.leftCols(n), Eigen::MatrixXd(prior_.asDiagonal());
    problem.F.resize(problem.Y.rows());
    problem.F << eliminated.rows.rightCols<1>(), prior_.cwiseProduct(given_);
    problem.W = Eigen::VectorXd::Ones(problem.Y.rows());
    return problem;
  }

  [[nodiscard]] std::unique_ptr<ShapeMasses> divide(const Eliminated& eliminated) const {
    const BodyModel& shapes = settings_.shapes;
    MassProblem problem = problem_of(eliminated);
    problem.U = shape_columns(shapes);
    problem.V = shape_volumes(shapes);
    problem.lambda = default_lambda(problem, settings_.expected_mass);
    problem.mass_bound = 10.0 * settings_.expected_mass;
    DivisionOptions division;
    division.most_divisions = settings_.divisions;
    division.expected_mass = settings_.expected_mass;
    return std::make_unique<ShapeMasses>(shapes, std::move(problem), division, settings_.rows.path);
  }

  /// What the data say by themselves, without given inertias and bodies, effects fitted along.
  [[nodiscard]] reference::Determination determination() const {
    Eigen::VectorXd size(sums_.masses() + sums_.effects());
    size << reference::natural_sizes(settings_.shapes, settings_.expected_mass),
        sums_.effect_sizes();
    reference::Determination all = reference::determine(sums_.blocks(size), size);
    all.value.conservativeResize(sums_.masses());
    all.standard_error.conservativeResize(sums_.masses());
    all.determined.resize(static_cast<std::size_t>(sums_.masses()));
    return all;
  }

 private:
  const Sums& sums_;
  const LoopSettings& settings_;
  Eigen::VectorXd prior_, given_;
};

/// Values of all effects, one after the other, back to their places. Transformations keep theirs.
void put_back(const Eigen::VectorXd& theta, const std::vector<std::size_t>& linear,
              std::vector<AppliedEffect>& effects) {
  Eigen::Index column = 0;
  for (const std::size_t k : linear) {
    effects[k].value = theta.segment(column, effects[k].value.size());
    column += effects[k].value.size();
  }
}

const Found* found_for(const AppliedEffect& effect, const std::vector<Found>& found) {
  const auto at = std::find_if(found.begin(), found.end(),
                               [&](const Found& f) { return same_place(f.effect, effect); });
  return at == found.end() ? nullptr : &*at;
}

/// The effect with the parameter that cannot be negative and is by most of its errors: another,
/// that is by less, may be none any more without it.
std::size_t impossible(const std::vector<AppliedEffect>& effects, const std::vector<Found>& found) {
  std::size_t worst = effects.size();
  double lowest = 0.0;
  for (std::size_t k = 0; k < effects.size(); ++k) {
    const Found* known = found_for(effects[k], found);
    for (std::size_t p = 0; p < effects[k].effect->parameters.size(); ++p) {
      const auto at = static_cast<Eigen::Index>(p);
      const double value = effects[k].value[at];
      if (!effects[k].effect->parameters[p].nonnegative || !(value < 0.0)) continue;
      const double error = known != nullptr ? known->standard_error[at] : 0.0;
      const double errors = error > 0.0 ? value / error : -std::numeric_limits<double>::infinity();
      if (worst < effects.size() && errors >= lowest) continue;
      worst = k;
      lowest = errors;
    }
  }
  return worst;
}

/// Delete-a-tenth jackknife of `answer`, which is Phi_free and theta: about it, and not about the
/// mean of the tenths, which may stay at a bound together. `masses`: none if no link is free.
Eigen::VectorXd jackknife(const Solver& solver, const ShapeMasses* masses,
                          const Eigen::VectorXd& answer) {
  Eigen::MatrixXd answers(answer.size(), tenths);
  for (int tenth = 0; tenth < tenths; ++tenth) {
    const Eliminated eliminated = solver.rows(tenth);
    Eigen::VectorXd Phi;
    if (masses != nullptr) {
      const MassProblem problem = solver.problem_of(eliminated);
      Phi = masses->Phi_of(problem.Y, problem.F);
    }
    answers.col(tenth) << Phi, effects_of(eliminated, Phi);
  }
  constexpr double factor = (tenths - 1.0) / tenths;
  return (factor * (answers.colwise() - answer).rowwise().squaredNorm()).cwiseSqrt();
}

/// The jackknife's errors of effects; where too few tenths have a column, those that it has by the
/// scatter between blocks (`between_blocks`, as values).
Eigen::VectorXd trusted(Eigen::VectorXd errors, const Sums& sums,
                        const std::vector<std::size_t>& linear,
                        const std::vector<AppliedEffect>& between_blocks) {
  constexpr int fewest = 5;
  const Eigen::ArrayXi held = sums.tenths_with_effects();
  Eigen::Index column = 0;
  for (const std::size_t k : linear) {
    for (const double error : between_blocks[k].value) {
      if (held[column] < fewest && error > 0.0) errors[column] = error;
      ++column;
    }
  }
  return errors;
}

}  // namespace

Consistent make_consistent(const Robot& robot, const Recording& log, const Recording* reference,
                           const LoopSettings& settings, const LoopResult& loop) {
  const BodyModel& shapes = settings.shapes;
  Consistent result;
  result.model = loop.model;
  while (true) {
    std::vector<AppliedEffect>& effects = result.model.effects;
    std::vector<std::size_t> linear;
    std::vector<AppliedEffect> columns;
    std::vector<bool> since;
    for (std::size_t k = 0; k < effects.size(); ++k) {
      if (effects[k].effect->transform.any()) continue;
      linear.push_back(k);
      columns.push_back(effects[k]);
      since.push_back(effects[k].is_of_the_log_alone());
    }
    TallyOptions options;
    options.stride = settings.stride;
    options.weight = loop.weight;
    constexpr double blocks = 40.0;
    options.block_seconds = log.duration() / blocks;
    Tally tally = empty_tally(robot, columns);
    if (reference != nullptr) {
      RichModel earlier = result.model;
      std::erase_if(earlier.effects,
                    [](const AppliedEffect& a) { return a.is_of_the_log_alone(); });
      add_to_tally(tally, robot, settings.rows, earlier, *reference, options, true);
    }
    add_to_tally(tally, robot, settings.rows, result.model, log, options, false);
    const Sums sums(shapes, std::move(tally), since);
    const Solver solver(robot, sums, settings, loop);
    const Eliminated eliminated = solver.rows(-1);
    // With every link trusted there is no mass to solve for.
    std::unique_ptr<ShapeMasses> masses;
    if (sums.masses() > 0) masses = solver.divide(eliminated);
    const Eigen::VectorXd Phi = masses ? masses->Phi() : Eigen::VectorXd();
    const Eigen::VectorXd theta = effects_of(eliminated, Phi);
    put_back(theta, linear, effects);
    if (const std::size_t bad = impossible(effects, loop.found); bad < effects.size()) {
      const auto at = static_cast<std::ptrdiff_t>(bad);
      result.dropped.push_back(effects[bad]);
      effects.erase(effects.begin() + at);
      continue;
    }
    result.model.Phi = all_parameters(shapes, Phi);
    if (sums.masses() > 0) result.data = solver.determination();
    Eigen::VectorXd answer(Phi.size() + theta.size());
    answer << Phi, theta;
    const Eigen::VectorXd errors = jackknife(solver, masses.get(), answer);
    result.Phi_error = Eigen::VectorXd::Zero(result.model.Phi.size());
    for (std::size_t i = 0; i < shapes.free_links.size(); ++i) {
      result.Phi_error.segment<10>(Eigen::Index{10} * shapes.free_links[i]) =
          errors.segment<10>(10 * static_cast<Eigen::Index>(i));
    }
    std::vector<AppliedEffect> error_places = effects;
    for (std::size_t k = 0; k < effects.size(); ++k) {
      error_places[k].value.setZero();
      const Found* known = found_for(effects[k], loop.found);
      if (known != nullptr) error_places[k].value = known->standard_error;
    }
    put_back(trusted(errors.tail(sums.effects()), sums, linear, error_places), linear,
             error_places);
    for (const AppliedEffect& a : error_places) result.effect_error.push_back(a.value);
    return result;
  }
}

void mark_faded(const Recording& log, const LoopSettings& settings, const Consistent& consistent,
                LoopResult& loop) {
  for (std::size_t k = 0; k < consistent.model.effects.size(); ++k) {
    const AppliedEffect& a = consistent.model.effects[k];
    if (a.effect->transform.any()) continue;  // kept as screened
    const double choices = periods_told_apart(log, a);
    const double z = differs_from_zero(*a.effect, a.value, consistent.effect_error[k], choices);
    const double tried = static_cast<double>(loop.hypotheses) * choices;
    for (Found& f : loop.found) {
      if (same_place(f.effect, a)) f.faded = !(z > least_z(settings.rule.false_alarms, tried));
    }
  }
}

}  // namespace shapeid::diagnosis
