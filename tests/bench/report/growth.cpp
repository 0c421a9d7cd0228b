#include "shapeid/tests/bench/report/growth.hpp"

#include <fmt/format.h>

#include <cmath>
#include <vector>

namespace shapeid::bench {

Growth growth(const Results& results, const std::string& set, const std::string& solver,
              double from, double to) {
  std::vector<std::pair<double, double>> points;  // log n, log t
  double last_shapes = 0.0, last_seconds = 0.0;
  for (const int shapes : {7, 11, 30, 60, 100, 200, 300, 600, 1000}) {
    const Result* run = results.find(fmt::format("division{}{}/{}/solve", shapes, set, solver));
    if (run == nullptr) continue;
    const double seconds = run->median();
    const double middle = std::sqrt(last_shapes * shapes);
    if (last_shapes > 0.0 && last_shapes >= from && shapes <= to && seconds > last_seconds) {
      points.emplace_back(std::log(middle),
                          std::log((seconds - last_seconds) / (shapes - last_shapes)));
    }
    last_shapes = shapes;
    last_seconds = seconds;
  }
  Growth g;
  g.points = static_cast<int>(points.size());
  if (g.points < 2) return g;
  double mean_x = 0.0, mean_y = 0.0;
  for (const auto& [x, y] : points) mean_x += x / g.points, mean_y += y / g.points;
  double xx = 0.0, xy = 0.0;
  for (const auto& [x, y] : points) {
    xx += (x - mean_x) * (x - mean_x);
    xy += (x - mean_x) * (y - mean_y);
  }
  g.exponent = xy / xx;
  return g;
}

}  // namespace shapeid::bench
