#if __FINITE_MATH_ONLY__ != 0
#error "what is not finite is looked for: compile without -ffast-math or -ffinite-math-only"
#endif

#include "shapeid/fast/sample_rows.hpp"

#include <string>

#include "shapeid/fast/regressor.hpp"
#include "shapeid/models/contract.hpp"

namespace shapeid::fast {
namespace {

[[maybe_unused]] Violation why_other_sizes(const Sample& s, int joints, std::size_t contacts) {
  if (has_sizes(s, joints, contacts)) return std::nullopt;
  return "q, dq, ddq or tau does not have an entry for each joint, or there is not a flag for each "
         "contact, or a force";
}

// Squares of rows up to this size add up over any log without overflow.
constexpr double largest_square = 1e290;

/// A product with zero is zero, or else not a number.
template <typename Derived>
double zero_if_finite(const Eigen::MatrixBase<Derived>& v) noexcept {
  return (0.0 * v).sum();
}

bool is_finite(const Sample& s) noexcept {
  double zero = 0.0 * s.time + zero_if_finite(s.q) + zero_if_finite(s.dq) + zero_if_finite(s.ddq) +
                zero_if_finite(s.tau) + zero_if_finite(s.base_angular_velocity) +
                zero_if_finite(s.base_angular_acceleration) + zero_if_finite(s.base_specific_force);
  for (const Eigen::Vector3d& f : s.contact_force) zero += zero_if_finite(f);
  return zero == 0.0;
}

bool base_alone(const Robot& robot, const BodyModel& model) {
  return robot.root == Root::floating && model.free_links == std::vector<int>{0};
}

}  // namespace

bool has_sizes(const Sample& s, int joints, std::size_t contacts) noexcept {
  return s.q.size() == joints && s.dq.size() == joints && s.ddq.size() == joints &&
         s.tau.size() == joints && (s.in_contact.empty() || s.in_contact.size() == contacts) &&
         (s.contact_force.empty() || s.contact_force.size() == contacts);
}

SampleRows::SampleRows(const Robot& robot, const BodyModel& model, ContactTreatment contacts,
                       const Eigen::VectorXd& weight)
    : contacts_(contacts),
      free_links_(model.free_links),
      kinematics_(robot),
      known_(robot, model.known),
      measured_(robot),
      jacobian_(robot),
      elimination_(weight, jacobian_.most_rows()),
      F_(robot.dof()),
      rows_(robot.dof(), 10 * static_cast<Eigen::Index>(free_links_.size()) + 1) {
  SHAPEID_CONTRACT(why_malformed(model, robot));
  if (base_alone(robot, model)) six_rows_.emplace(robot, weight);
}

Verdict SampleRows::update(const Sample& sample) noexcept {
  SHAPEID_CONTRACT(why_other_sizes(sample, kinematics_.link_count() - 1, measured_.contacts()));
  first_ = count_ = 0;
  constant_ = 0.0;
  if (!is_finite(sample)) return Verdict::not_finite;
  kinematics_.start(sample);
  F_ = -known_(kinematics_);
  F_.tail(sample.tau.size()) += sample.tau;
  if (contacts_ == ContactTreatment::measured && !measured_.add_to(F_, kinematics_, sample)) {
    return Verdict::no_contact_forces;
  }
  const std::vector<bool>& unknown =
      contacts_ == ContactTreatment::project ? sample.in_contact : nothing_touches_;
  by_six_rows_ = six_rows_ && (*six_rows_)(kinematics_, unknown, F_, six_);
  if (by_six_rows_) {
    rows_.topRows<6>() = six_.transposed.transpose();
    count_ = 6;
    constant_ = six_.constant;
  } else {
    project(sample);
  }
  // Finite numbers may be so large that their squares are not. A NaN is not below either.
  if (rows().squaredNorm() + constant_ < largest_square) return Verdict::taken;
  count_ = 0;
  return Verdict::not_finite;
}

void SampleRows::project(const Sample& sample) noexcept {
  const Eigen::Index dof = rows_.rows(), columns = rows_.cols();
  rows_.setZero();
  Eigen::Index column = 0;
  for (const int link : free_links_) {
    write_columns(kinematics_, link, rows_.middleCols<10>(column));
    column += 10;
  }
  rows_.col(columns - 1) = F_;
  if (contacts_ == ContactTreatment::project) {
    jacobian_.update(kinematics_, sample);
  }
  first_ = elimination_(jacobian_.transposed(), rows_);
  count_ = dof - first_;
  // Rows that no rank rule could judge are not to be trusted, however finite they look.
  constant_ = zero_if_finite(jacobian_.transposed());
}

}  // namespace shapeid::fast
