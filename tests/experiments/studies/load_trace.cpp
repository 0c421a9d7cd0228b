#include "shapeid/tests/experiments/studies/load_trace.hpp"

#include <stdexcept>

#include "shapeid/fast/division.hpp"
#include "shapeid/tests/experiments/methods/division_floor.hpp"
#include "shapeid/tests/experiments/methods/mass_columns.hpp"

namespace shapeid::experiments {

DivisionOptions default_division() {
  DivisionOptions options;
  options.expected_mass = 1.0;
  return options;
}

LoadTrace trace_load(const BodyModel& area, const DataTerm& f, const InertialParameters& truth,
                     const DivisionOptions& options, int most, double lambda_share) {
  DivisionOptions watched = options;
  watched.most_divisions = most;
  const double V0 = shape_volumes(area).sum(), M0 = options.expected_mass;
  fast::Division division(area, watched);
  division.set_lambda(lambda_share * f.size() * V0 / (M0 * M0));
  const Eigen::MatrixXd R = triangle_of(f);
  if (division.start(R) != fast::Outcome::solved) throw std::runtime_error("window declined");

  LoadTrace trace;
  const auto look = [&] {
    const Vector10 Phi = division.masses().Phi();
    trace.errors.push_back(load_error(Phi, truth));
    trace.f.push_back(f.value(Phi));
  };
  look();
  int small_steps = 0;
  trace.published_stop = most;
  bool stopped = false, stuck = false;
  for (int k = 1; k <= most; ++k) {
    const Eigen::VectorXd volumes = division.masses().V();
    stuck = stuck || division.divide() != fast::Division::Step::divided;
    look();
    if (stuck) {
      trace.smallest.push_back(0.0);
      continue;
    }
    const fast::Division::Cut& cut = division.history().back();
    trace.smallest.push_back(volumes[cut.place] / V0);
    small_steps = cut.step.maxCoeff() < options.step ? small_steps + 1 : 0;
    if (!stopped && small_steps >= options.patience) {
      trace.published_stop = k;
      stopped = true;
    }
  }
  constexpr double gap = 1e-3;
  trace.floor = limit_of_divisions(area, f, gap).floor;
  return trace;
}

}  // namespace shapeid::experiments
