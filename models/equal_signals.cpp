#include "shapeid/models/equal_signals.hpp"

#include <cmath>
#include <limits>

namespace shapeid {

EqualSignals::EqualSignals(const ChannelPlan& plan, int joints)
    : plan_(plan),
      first_(Eigen::VectorXd::Constant(static_cast<Eigen::Index>(plan.channels.size()),
                                       std::numeric_limits<double>::quiet_NaN())),
      changes_(plan.channels.size(), false) {
  for (const int kind : {plan.q, plan.dq, plan.tau}) watch_pairs(kind, joints);
  for (const int kind : {plan.gyro, plan.accel}) watch_pairs(kind, 3);
}

void EqualSignals::watch_pairs(int first, int count) {
  if (first < 0) return;
  for (int a = first; a < first + count; ++a) {
    for (int b = a + 1; b < first + count; ++b) equal_.emplace_back(a, b);
  }
}

void EqualSignals::add(const MeasuredRow& row) {
  ++rows_;
  if (equal_.empty()) return;
  std::erase_if(equal_, [&](const auto& pair) {
    const double a = row.values[pair.first], b = row.values[pair.second];
    return !std::isnan(a) && !std::isnan(b) && a != b;
  });
  for (Eigen::Index c = 0; c < first_.size(); ++c) {
    const double value = row.values[c];
    if (std::isnan(first_[c])) first_[c] = value;
    if (!std::isnan(value) && value != first_[c]) changes_[static_cast<std::size_t>(c)] = true;
  }
}

std::vector<std::pair<std::string, std::string>> EqualSignals::found() const {
  constexpr int enough_rows = 100;
  std::vector<std::pair<std::string, std::string>> names;
  if (rows_ < enough_rows) return names;
  const auto column = [&](int channel) {
    return plan_.channels[static_cast<std::size_t>(channel)].from;
  };
  for (const auto& [a, b] : equal_) {
    if (!changes_[static_cast<std::size_t>(a)] || !changes_[static_cast<std::size_t>(b)]) continue;
    names.emplace_back(column(a), column(b));
  }
  return names;
}

}  // namespace shapeid
