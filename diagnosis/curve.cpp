#include "shapeid/diagnosis/curve.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace shapeid::diagnosis {
namespace {

constexpr std::array<std::pair<const char*, CurveSignal>, 4> prefixes = {
    {{"q.", CurveSignal::position},
     {"dq.", CurveSignal::speed},
     {"ddq.", CurveSignal::acceleration},
     {"tau.", CurveSignal::load}}};

}  // namespace

bool can_follow(const Effect& effect) {
  return effect.site == SiteKind::joint && effect.parameters.size() == 1 &&
         effect.columns != nullptr && !effect.filters_load && !effect.code.torque.empty();
}

std::string variable_name(const CurveVariable& variable, const Robot& robot) {
  const auto* const prefix = std::find_if(
      prefixes.begin(), prefixes.end(), [&](const auto& p) { return p.second == variable.signal; });
  return prefix->first + robot.joint(variable.joint).name;
}

std::optional<CurveVariable> find_variable(const std::string& name, const Robot& robot) {
  for (const auto& [prefix, signal] : prefixes) {
    for (int joint = 0; joint < robot.joint_count(); ++joint) {
      if (name == prefix + robot.joint(joint).name) return CurveVariable{signal, joint};
    }
  }
  return std::nullopt;
}

double value_of(const CurveVariable& variable, const Instant& instant) {
  switch (variable.signal) {
    case CurveSignal::position:
      return instant.sample.q[variable.joint];
    case CurveSignal::speed:
      return instant.sample.dq[variable.joint];
    case CurveSignal::acceleration:
      return instant.sample.ddq[variable.joint];
    case CurveSignal::load:
      break;
  }
  return instant.load[variable.joint];
}

Eigen::VectorXd knot_shares(const Eigen::VectorXd& at, double x) {
  Eigen::VectorXd shares = Eigen::VectorXd::Zero(at.size());
  const Eigen::Index behind = std::upper_bound(at.begin(), at.end(), x) - at.begin();
  if (behind == 0 || behind == at.size()) {
    shares[std::max<Eigen::Index>(behind - 1, 0)] = 1.0;
    return shares;
  }
  shares[behind] = (x - at[behind - 1]) / (at[behind] - at[behind - 1]);
  shares[behind - 1] = 1.0 - shares[behind];
  return shares;
}

Eigen::VectorXd force_of(const Curve& curve, const Instant& instant) {
  const double number = knot_shares(curve.at, value_of(curve.over, instant)).dot(curve.number);
  return number * curve.law.effect->columns(instant, curve.law.site, curve.law.shape).col(0);
}

}  // namespace shapeid::diagnosis
