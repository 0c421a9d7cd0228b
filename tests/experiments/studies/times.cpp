#include "shapeid/tests/experiments/studies/times.hpp"

#include <fmt/format.h>

#include <chrono>

#include "shapeid/reference/triangle.hpp"
#include "shapeid/reference/window.hpp"
#include "shapeid/tests/experiments/data/motions.hpp"
#include "shapeid/tests/experiments/page/statistics.hpp"
#include "shapeid/tests/experiments/studies/contest.hpp"

namespace shapeid::experiments {
namespace {

double microseconds(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return 1e6 * std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

Findings times(Form form) {
  const double seconds = form == Form::full ? 5.0 : 0.4;
  const test::Quadruped quadruped = test::bundled_quadruped();
  const Robot& robot = quadruped.robot;
  const auto motion = simulated(robot, {gaits().front(), seconds, 1, {}});
  const std::vector<Sample> samples = measured(quadruped, motion, seconds, {});
  const auto fitted = windows(robot, quadruped.base, samples, published_window);

  // What every method needs before it starts, in both of our implementations.
  std::vector<double> fast_rows, reference_rows;
  for (std::size_t k = 0; k + published_window <= samples.size(); k += published_window) {
    const std::vector<Sample> ten(samples.begin() + static_cast<long>(k),
                                  samples.begin() + static_cast<long>(k + published_window));
    fast_rows.push_back(microseconds(
        [&] { static_cast<void>(windows(robot, quadruped.base, ten, published_window)); }));
    reference_rows.push_back(microseconds([&] {
      reference::Window window(robot, quadruped.base, ContactTreatment::project,
                               Eigen::VectorXd::Ones(robot.dof()));
      for (const Sample& sample : ten) window.add(sample);
      Eigen::MatrixXd both(window.Y().rows(), 11);
      both << window.Y(), window.F();
      static_cast<void>(reference::triangle(both));
    }));
  }
  Findings findings;
  const double fast_us = spread(fast_rows).median, reference_us = spread(reference_rows).median;
  findings.set("time.rows.fast_us", fast_us);
  findings.set("time.rows.reference_us", reference_us);
  Table rows = {{"method", "solve alone, us", "window, us", "window by `reference`, us"}};
  for (const Contestant& c : contestants(base_setting(quadruped))) {
    std::vector<double> solves;
    solves.reserve(fitted.size());
    for (const TimedWindow& window : fitted) {
      solves.push_back(microseconds([&] { static_cast<void>(c.method->solve(window.f)); }));
    }
    const double solve = spread(solves).median;
    findings.set("time." + c.key + ".solve_us", solve);
    findings.set("time." + c.key + ".window_us", solve + fast_us);
    rows.push_back({c.words, fmt::format("{:.3g}", solve), fmt::format("{:.3g}", solve + fast_us),
                    fmt::format("{:.3g}", solve + reference_us)});
  }
  findings.tables["times"] = rows;
  return findings;
}

}  // namespace shapeid::experiments
