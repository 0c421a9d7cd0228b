#include "shapeid/models/row_steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
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

double median_row_step(const std::deque<MeasuredRow>& head) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < head.size(); ++i) steps.push_back(head[i].time - head[i - 1].time);
  return steps.empty() ? 0.0 : median(std::move(steps));
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
