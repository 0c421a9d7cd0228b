// Why k1, k2, eps and patience have the defaults they have: the tables of
// docs/derivations/division.md, and what that page concludes from them.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <tuple>
#include <vector>

#include "shapeid/models/inertia.hpp"
#include "shapeid/reference/division.hpp"
#include "shapeid/tests/support/any_model.hpp"
#include "shapeid/tests/support/load_problem.hpp"

namespace shapeid::reference {
namespace {

constexpr int loads = 11, divisions = 50;

/// Errors after one division, against the load that made the rows.
struct Errors {
  double place = 0.0;   // mm
  double tensor = 0.0;  // about the centre of mass, relative
  double objective = 0.0;
  double step = 0.0;  // the largest group of the step
};

using Path = std::vector<Errors>;

/// 1 kg of 4 cm anywhere in a region of 40 x 20 x 5 cm, 40 samples, divided 50 times.
Path path_of(int load, double noise, double k2) {
  const Eigen::Vector3d region(0.4, 0.2, 0.05), middle(0.05, 0.02, 0.1), side(0.04, 0.04, 0.04);
  test::Draw draw(static_cast<std::uint64_t>(load) + 1);
  const Eigen::Vector3d room = 0.5 * (region - side);
  const Eigen::Vector3d place = draw.vector(1.0).cwiseProduct(room) + middle;
  const InertialParameters truth = test::cuboid_body(1.0, place, side);
  MassProblem problem = test::load_window(draw, 40, truth, noise);
  const BodyModel model = test::one_cuboid(middle, region);
  test::use_shapes(problem, model, 1.0);
  Path path;
  (void)divide_and_solve(
      model, problem, {.k2 = k2, .step = 0.0, .most_divisions = divisions, .expected_mass = 1.0},
      [&](const DivisionRun& run) {
        if (run.history.empty()) return;
        const InertialParameters found{Vector10(run.solution.Phi)};
        const Eigen::Matrix3d I = truth.tensor_about_centre();
        path.push_back({1e3 * (found.centre_of_mass() - truth.centre_of_mass()).norm(),
                        (found.tensor_about_centre() - I).norm() / I.norm(),
                        run.solution.value.data, run.history.back().step.maxCoeff()});
      });
  return path;
}

/// Divisions until `patience` steps in a row are below eps; all of them if that never happens.
int stop_of(const Path& path, double eps, int patience) {
  int small = 0;
  for (std::size_t k = 0; k < path.size(); ++k) {
    small = path[k].step < eps ? small + 1 : 0;
    if (small >= patience) return static_cast<int>(k) + 1;
  }
  return divisions;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

template <class Number>
double median_over(const std::vector<Path>& paths, Number number) {
  std::vector<double> values;
  values.reserve(paths.size());
  for (const Path& path : paths) values.push_back(static_cast<double>(number(path)));
  return median(values);
}

/// Paths of all loads, computed once for each noise and k2.
const std::vector<Path>& paths_of(double noise, double k2) {
  static std::map<std::tuple<double, double>, std::vector<Path>> known;
  std::vector<Path>& paths = known[{noise, k2}];
  for (int load = static_cast<int>(paths.size()); load < loads; ++load) {
    paths.push_back(path_of(load, noise, k2));
  }
  return paths;
}

const DivisionOptions defaults;

TEST(Defaults, K2) {
  fmt::print("medians over {} loads after {} divisions\n", loads, divisions);
  fmt::print("noise   k2      place mm  tensor    objective\n");
  for (const double noise : {0.0, 0.01, 0.05}) {
    for (const double k2 : {0.0, 1e-6, 1e-4, 1e-2, 1.0}) {
      const auto& paths = paths_of(noise, k2);
      fmt::print("{:<7g} {:<7g} {:<9.2g} {:<9.2g} {:.4g}\n", noise, k2,
                 median_over(paths, [](const Path& p) { return p.back().place; }),
                 median_over(paths, [](const Path& p) { return p.back().tensor; }),
                 median_over(paths, [](const Path& p) { return p.back().objective; }));
    }
  }
  const auto objective = [](const Path& p) { return p.back().objective; };
  const auto tensor = [](const Path& p) { return p.back().tensor; };
  // Without k2 the objective goes further down, and under noise the tensor gets worse for it.
  EXPECT_LT(median_over(paths_of(0.0, 0.0), objective),
            median_over(paths_of(0.0, defaults.k2), objective));
  EXPECT_LT(median_over(paths_of(0.05, defaults.k2), tensor),
            median_over(paths_of(0.05, 0.0), tensor));
}

TEST(Defaults, Stop) {
  fmt::print("medians over {} loads, k2 = {:g}\n", loads, defaults.k2);
  fmt::print("noise   eps     patience  divisions  place mm  tensor\n");
  const auto at_stop = [](double eps, int patience, double Errors::*error) {
    return [=](const Path& p) {
      return p[static_cast<std::size_t>(stop_of(p, eps, patience)) - 1].*error;
    };
  };
  for (const double noise : {0.0, 0.01, 0.05}) {
    const auto& paths = paths_of(noise, defaults.k2);
    for (const double eps : {1e-2, 1e-3, 1e-4}) {
      for (const int patience : {1, 3, 6}) {
        fmt::print("{:<7g} {:<7g} {:<9} {:<10} {:<9.2g} {:.2g}\n", noise, eps, patience,
                   median_over(paths, [&](const Path& p) { return stop_of(p, eps, patience); }),
                   median_over(paths, at_stop(eps, patience, &Errors::place)),
                   median_over(paths, at_stop(eps, patience, &Errors::tensor)));
      }
    }
    // The default stop comes before the limit. Under noise, dividing on gains nothing that could
    // be seen: the place is as good as after all divisions, to within a tenth.
    EXPECT_LT(
        median_over(paths,
                    [](const Path& p) { return stop_of(p, defaults.step, defaults.patience); }),
        divisions);
    if (noise > 0.0) {
      EXPECT_LT(median_over(paths, at_stop(defaults.step, defaults.patience, &Errors::place)),
                1.1 * median_over(paths, [](const Path& p) { return p.back().place; }));
    }
  }
}

}  // namespace
}  // namespace shapeid::reference
