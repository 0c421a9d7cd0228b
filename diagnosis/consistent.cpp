#include "shapeid/diagnosis/consistent.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <memory>
#include <utility>

#include "shapeid/diagnosis/body_sums.hpp"
#include "shapeid/diagnosis/candidates.hpp"
#include "shapeid/diagnosis/chance.hpp"
#include "shapeid/diagnosis/credibility.hpp"
#include "shapeid/diagnosis/fits.hpp"
#include "shapeid/diagnosis/load_places.hpp"
#include "shapeid/diagnosis/shape_masses.hpp"
#include "shapeid/reference/identify.hpp"

namespace shapeid::diagnosis {
namespace {

class Solver {
 public:
  /// `loads`: the links that carry them, in the order of the sums.
  Solver(const Robot& robot, const BodySums& sums, const std::vector<int>& loads,
         const LoopSettings& settings, const LoopResult& loop)
      : sums_(sums),
        settings_(settings),
        expected_mass_(settings.expected_mass > 0.0 ? settings.expected_mass : 1.0),
        volume_of_point_(settings.shapes.shapes.empty() ? 1.0
                                                        : shape_volumes(settings.shapes).mean()),
        shapes_(settings.shapes) {
    const BodyModel& shapes = settings.shapes;
    // Every load is a link of its own behind the robot's.
    for (std::size_t i = 0; i < loads.size(); ++i) {
      rooms_.push_back(room_for_load(robot, loads[i]));
      shapes_.free_links.push_back(robot.link_count() + static_cast<int>(i));
    }
    for (std::size_t i = 0; i < rooms_.size(); ++i) {
      for (const Eigen::Vector3d& place : first_places(rooms_[i])) add_point(shapes_, i, place);
    }
    const Eigen::VectorXd given = stacked_parameters(robot);
    prior_ = Eigen::VectorXd::Zero(sums.bodies());
    given_ = prior_;
    for (std::size_t i = 0; i < shapes.free_links.size(); ++i) {
      const Eigen::Index from = Eigen::Index{10} * shapes.free_links[i];
      const auto at = 10 * static_cast<Eigen::Index>(i);
      given_.segment<10>(at) = given.segment<10>(from);
      prior_.segment<10>(at) =
          std::sqrt(loop.prior) * settings.size.segment<10>(from).cwiseInverse();
    }
  }

  /// Y and F of the mass problem, W of ones.
  [[nodiscard]] MassProblem problem_of(const Eliminated& eliminated) const {
    const Eigen::Index n = sums_.bodies();
    MassProblem problem;
    problem.Y.resize(eliminated.rows.rows() + n, n);
    problem.Y << eliminated.rows.leftCols(n), Eigen::MatrixXd(prior_.asDiagonal());
    problem.F.resize(problem.Y.rows());
    problem.F << eliminated.rows.rightCols<1>(), prior_.cwiseProduct(given_);
    problem.W = Eigen::VectorXd::Ones(problem.Y.rows());
    return problem;
  }

  [[nodiscard]] std::unique_ptr<ShapeMasses> divide(const Eliminated& eliminated) const {
    BodyModel shapes = shapes_;
    while (add_places(eliminated, shapes)) continue;
    return masses_of(shapes, eliminated, settings_.divisions);
  }

  /// What the data say by themselves of links, loads and effects, without given inertias and
  /// bodies. `sums`: of the same links and loads.
  [[nodiscard]] reference::Determination determination(const BodySums& sums) const {
    Eigen::VectorXd size(sums.links() + sums.linear());
    size << reference::natural_sizes(settings_.shapes, settings_.expected_mass),
        sums.linear_sizes();
    return reference::determine(sums.blocks(size), size);
  }

 private:
  [[nodiscard]] std::unique_ptr<ShapeMasses> masses_of(const BodyModel& shapes,
                                                       const Eliminated& eliminated,
                                                       int divisions) const {
    MassProblem problem = problem_of(eliminated);
    problem.U = shape_columns(shapes);
    problem.V = shape_volumes(shapes);
    problem.lambda = std::min(default_lambda(problem, expected_mass_), most_lambda(problem.V));
    problem.mass_bound = 10.0 * expected_mass_;
    DivisionOptions division;
    division.most_divisions = divisions;
    division.expected_mass = expected_mass_;
    return std::make_unique<ShapeMasses>(shapes, std::move(problem), division, settings_.rows.path);
  }

  /// The density term grows with the weight of the rows, and of a log without noise that has no
  /// end. Even density must not outweigh the given mass of a link whose mass no row feels.
  [[nodiscard]] double most_lambda(const Eigen::VectorXd& V) const {
    constexpr double beside_given = 1e-4;
    double weakest = std::numeric_limits<double>::infinity();
    for (Eigen::Index i = 0; i < sums_.links(); i += 10) {
      weakest = std::min(weakest, prior_[i] * prior_[i]);
    }
    return beside_given * weakest * V.sum();
  }

  void add_point(BodyModel& shapes, std::size_t load, const Eigen::Vector3d& place) const {
    const int body = shapes_.free_links[shapes_.free_links.size() - rooms_.size() + load];
    shapes.shapes.push_back(
        {body, make_point(place, volume_of_point_), std::to_string(shapes.shapes.size())});
  }

  /// For each load the point at which its mass would lower the error most. False, and none, where
  /// all that further points could gain is nothing beside the error (the objective is convex: no
  /// more than the slope at the best point times the mass that goes there).
  [[nodiscard]] bool add_places(const Eliminated& eliminated, BodyModel& shapes) const {
    constexpr double nothing = 1e-4;
    constexpr std::size_t most = 40;  // points a load
    if (shapes.shapes.size() >= shapes_.shapes.size() + most * rooms_.size()) return false;
    const Eigen::VectorXd Phi = masses_of(shapes, eliminated, 0)->Phi();
    const MassProblem rows = problem_of(eliminated);
    const Eigen::VectorXd left = rows.Y * Phi - rows.F;
    const Eigen::VectorXd gradient = 2.0 * rows.Y.transpose() * left;
    double gain = 0.0;
    BodyModel more = shapes;
    for (std::size_t i = 0; i < rooms_.size(); ++i) {
      const Eigen::Index own = sums_.links() + 10 * static_cast<Eigen::Index>(i);
      const SteepestPlace best = steepest_place(gradient.segment<10>(own), rooms_[i]);
      gain -= best.slope * (Phi[own] > 0.0 ? Phi[own] : expected_mass_);
      add_point(more, i, best.place);
    }
    if (!(gain > nothing * left.squaredNorm())) return false;
    shapes = std::move(more);
    return true;
  }

  const BodySums& sums_;
  const LoopSettings& settings_;
  double expected_mass_;    ///< where no link is free a load is all that is sought
  double volume_of_point_;  ///< as a link's shapes have, so that points count no other way
  BodyModel shapes_;        ///< with the points at which loads are sought first
  std::vector<Box> rooms_;  ///< one a load
  Eigen::VectorXd prior_, given_;
};

/// Which effects have columns, those that are bodies first.
std::vector<std::size_t> loads_first(const std::vector<AppliedEffect>& effects) {
  std::vector<std::size_t> list;
  for (const bool load : {true, false}) {
    for (std::size_t k = 0; k < effects.size(); ++k) {
      const Effect& effect = *effects[k].effect;
      if (!effect.transform.any() && effect.is_payload == load) list.push_back(k);
    }
  }
  return list;
}

/// Values of these effects, one after the other, back to their places.
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
/// that is by less, may be none any more without it. A load without mass is none.
std::size_t impossible(const std::vector<AppliedEffect>& effects, const std::vector<Found>& found) {
  std::size_t worst = effects.size();
  double lowest = 0.0;
  for (std::size_t k = 0; k < effects.size(); ++k) {
    const Found* known = found_for(effects[k], found);
    for (std::size_t p = 0; p < effects[k].effect->parameters.size(); ++p) {
      const auto at = static_cast<Eigen::Index>(p);
      const double value = effects[k].value[at];
      const bool is_none = effects[k].effect->is_payload ? !(value > 0.0) : value < 0.0;
      if (!effects[k].effect->parameters[p].nonnegative || !is_none) continue;
      const double error = known != nullptr ? known->standard_error[at] : 0.0;
      const double errors = error > 0.0 ? value / error : -std::numeric_limits<double>::infinity();
      if (worst < effects.size() && errors >= lowest) continue;
      worst = k;
      lowest = errors;
    }
  }
  return worst;
}

/// Phi and theta of all tenths but one; -1: of all. `masses`: none if there are no bodies.
Eigen::VectorXd answer_without(int tenth, const BodySums& sums, const Solver& solver,
                               const ShapeMasses* masses) {
  const Eliminated eliminated = sums.rows_without(tenth);
  Eigen::VectorXd Phi;
  if (masses != nullptr) {
    const MassProblem problem = solver.problem_of(eliminated);
    Phi = masses->Phi_of(problem.Y, problem.F);
  }
  Eigen::VectorXd answer(Phi.size() + sums.linear());
  answer << Phi, eliminated.effects(Phi);
  return answer;
}

/// By these a delete-a-tenth jackknife goes: errors are about the answer of all tenths, and not
/// about the mean of those without one, which may stay at a bound together.
struct Jackknife {
  Eigen::VectorXd answer;
  Eigen::MatrixXd without_tenths;
};

Jackknife jackknife(const BodySums& sums, const Solver& solver, const ShapeMasses* masses) {
  Jackknife result{answer_without(-1, sums, solver, masses), {}};
  result.without_tenths.resize(result.answer.size(), tenths);
  for (int tenth = 0; tenth < tenths; ++tenth) {
    result.without_tenths.col(tenth) = answer_without(tenth, sums, solver, masses);
  }
  return result;
}

Eigen::VectorXd errors_of(const Eigen::VectorXd& answer, const Eigen::MatrixXd& without_tenths) {
  constexpr double factor = (tenths - 1.0) / tenths;
  return (factor * (without_tenths.colwise() - answer).rowwise().squaredNorm()).cwiseSqrt();
}

/// Of the load whose numbers begin at `from`, as one body: how large it is without each tenth, one
/// being the answer of all, by what it does in its rows. The error of that.
double error_of_size(const Eigen::MatrixXd& rows, const Jackknife& all, Eigen::Index from) {
  const Eigen::MatrixXd own = rows.middleCols(from, 10);
  const Eigen::VectorXd force = own * all.answer.segment<10>(from);
  const double square = force.squaredNorm();
  if (!(square > 0.0)) return std::numeric_limits<double>::infinity();
  const Eigen::VectorXd sizes =
      (own * all.without_tenths.middleRows(from, 10)).transpose() * force / square;
  return errors_of(Eigen::VectorXd::Ones(1), sizes.transpose())[0];
}

reference::Determination of_links(reference::Determination all, Eigen::Index links) {
  all.value.conservativeResize(links);
  all.standard_error.conservativeResize(links);
  all.natural_size.conservativeResize(links);
  all.determined.resize(static_cast<std::size_t>(links));
  return all;
}

/// The jackknife's errors of effects; where too few tenths have a column, those that it has by the
/// scatter between blocks (`between_blocks`, as values).
Eigen::VectorXd trusted(Eigen::VectorXd errors, const BodySums& sums,
                        const std::vector<std::size_t>& linear,
                        const std::vector<AppliedEffect>& between_blocks) {
  constexpr int fewest = 5;
  const Eigen::ArrayXi held = sums.tenths_with_columns();
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
    const std::vector<std::size_t> linear = loads_first(effects);
    std::vector<AppliedEffect> columns;
    std::vector<int> loads;
    for (const std::size_t k : linear) {
      columns.push_back(effects[k]);
      if (effects[k].effect->is_payload) loads.push_back(effects[k].site);
    }
    // Behind them what a change of each applied transformation does.
    std::ranges::copy_if(effects, std::back_inserter(columns),
                         [](const AppliedEffect& a) { return a.effect->transform.any(); });
    TallyOptions options;
    options.stride = settings.stride;
    options.threads = settings.threads;
    options.weight = loop.weight;
    constexpr double blocks = 40.0;
    options.block_seconds = log.duration() / blocks;
    Tally tally = empty_tally(robot, columns);
    if (reference != nullptr) {
      TallyOptions of_reference = options;
      of_reference.stride = log.stride_for(*reference, settings.stride);
      add_to_tally(tally, robot, settings.rows, result.model.in_reference(), *reference,
                   of_reference, true);
    }
    add_to_tally(tally, robot, settings.rows, result.model, log, options, false);
    const BodySums sums(shapes, with_first(tally, linear.size()));
    const Solver solver(robot, sums, loads, settings, loop);
    const Eliminated eliminated = sums.rows_without(-1);
    // With every link trusted and no load there is no mass to solve for.
    std::unique_ptr<ShapeMasses> masses;
    if (sums.bodies() > 0) masses = solver.divide(eliminated);
    const Eigen::VectorXd Phi = masses ? masses->Phi() : Eigen::VectorXd();
    Eigen::VectorXd answer(sums.links() + sums.linear());
    answer << Phi, eliminated.effects(Phi);
    put_back(answer.tail(sums.linear()), linear, effects);
    if (const std::size_t bad = impossible(effects, loop.found); bad < effects.size()) {
      const auto at = static_cast<std::ptrdiff_t>(bad);
      result.dropped.push_back(effects[bad]);
      effects.erase(effects.begin() + at);
      continue;
    }
    result.model.Phi = all_parameters(shapes, answer.head(sums.links()));
    // What a transformation's numbers are is not known better than the masses: with these held,
    // masses that they stand for would have no error.
    const BodySums all_free(shapes, std::move(tally));
    reference::Determination data;
    if (sums.bodies() > 0) data = solver.determination(all_free);
    const Jackknife tried = jackknife(all_free, solver, masses.get());
    const Eigen::VectorXd errors = errors_of(tried.answer, tried.without_tenths);
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
    put_back(trusted(errors.segment(sums.links(), sums.linear()), sums, linear, error_places),
             linear, error_places);
    // A load's numbers that no data tell apart are as the points have it that were tried. Rounding
    // may leave of "not at all" an error that no load could have.
    constexpr double no_knowledge = 100.0;  // usual sizes
    for (std::size_t i = 0; i < loads.size(); ++i) {
      AppliedEffect& load = error_places[linear[i]];
      load.value = load.value.cwiseMax(
          data.standard_error.segment<10>(sums.links() + 10 * static_cast<Eigen::Index>(i)));
      for (Eigen::Index p = 0; p < load.value.size(); ++p) {
        const double size = load.effect->parameters[static_cast<std::size_t>(p)].size;
        if (load.value[p] > no_knowledge * size) {
          load.value[p] = std::numeric_limits<double>::infinity();
        }
      }
    }
    // A number that no row feels is zero with every tenth, and not known to be.
    for (std::size_t k = 0; k < effects.size(); ++k) {
      const Eigen::ArrayXd error = error_places[k].value.array();
      const auto is_unfelt = error == 0.0 && effects[k].value.array() == 0.0;
      result.effect_error.emplace_back(
          is_unfelt.select(std::numeric_limits<double>::infinity(), error));
    }
    if (sums.links() > 0) result.data = of_links(std::move(data), sums.links());
    result.load_size_error.assign(effects.size(), 0.0);
    for (std::size_t i = 0; i < loads.size(); ++i) {
      const Eigen::Index own = sums.links() + 10 * static_cast<Eigen::Index>(i);
      result.load_size_error[linear[i]] = error_of_size(eliminated.rows, tried, own);
    }
    return result;
  }
}

void mark_faded(const Recording& log, const LoopSettings& settings, const Consistent& consistent,
                LoopResult& loop) {
  for (std::size_t k = 0; k < consistent.model.effects.size(); ++k) {
    const AppliedEffect& a = consistent.model.effects[k];
    if (a.effect->transform.any()) continue;  // kept as screened
    const double choices = periods_told_apart(log, a);
    const double z = a.effect->is_payload ? 1.0 / consistent.load_size_error[k]
                                          : differs_from_zero(*a.effect, a.value,
                                                              consistent.effect_error[k], choices);
    const double tried = static_cast<double>(loop.hypotheses) * choices;
    for (Found& f : loop.found) {
      if (same_place(f.effect, a)) f.faded = !(z > least_z(settings.rule.false_alarms, tried));
    }
  }
}

}  // namespace shapeid::diagnosis
