#include "shapeid/models/row_steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "shapeid/models/error.hpp"

namespace shapeid {

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Times of a clock that began in 1970 are whole numbers of 0.24 us, and steps of 2 ms one of two
// neighbouring ones. Either is off by so much that a grid of such steps would leave the rows within
// a minute, and values between rows be taken for measured ones.
double median_row_step(const std::deque<MeasuredRow>& head) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < head.size(); ++i) steps.push_back(head[i].time - head[i - 1].time);
  if (steps.empty()) return 0.0;
  const double middle = median(steps);
  const double rounding = std::numeric_limits<double>::epsilon() *
                          std::max(std::abs(head.front().time), std::abs(head.back().time));
  constexpr double little = 1e-7;  // of a step: twenty minutes later a twentieth of one at 500 Hz
  if (rounding <= little * middle) return middle;
  double sum = 0.0, count = 0.0;
  for (const double step : steps) {
    if (!(std::abs(step - middle) <= rounding)) continue;
    sum += step;
    count += 1.0;
  }
  return sum / count;
}

Eigen::VectorXd median_steps(const std::deque<MeasuredRow>& head, const ChannelPlan& plan,
                             const std::string& path) {
  Eigen::VectorXd steps(static_cast<Eigen::Index>(plan.channels.size()));
  for (Eigen::Index c = 0; c < steps.size(); ++c) {
    std::vector<double> own;
    std::optional<double> last;
    for (const MeasuredRow& row : head) {
      if (std::isnan(row.values[c])) continue;
      if (last) own.push_back(row.time - *last);
      last = row.time;
    }
    if (own.empty()) {
      const Channel& channel = plan.channels[static_cast<std::size_t>(c)];
      throw InputError({path, 0, channel.from},
                       channel.hold_group < 0 ? "is empty" : "is held and never changes",
                       fmt::format("{} needs measurements from the log's beginning", channel.name));
    }
    steps[c] = median(std::move(own));
  }
  return steps;
}

}  // namespace shapeid
