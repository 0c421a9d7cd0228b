#include "shapeid/fast/contact.hpp"

#include <Eigen/Geometry>

#include <cstddef>

#include "shapeid/models/contract.hpp"

namespace shapeid::fast {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

[[maybe_unused]] Violation why_other_contacts(const Sample& sample, std::size_t contacts) {
  if (sample.in_contact.empty() || sample.in_contact.size() == contacts) return std::nullopt;
  return "not a flag for each contact";
}

/// The axes of the moments that a contact holds, by columns in base axes, after the three forces.
Matrix3d held_axes(const Contact& contact, const Matrix3d& R) noexcept {
  Matrix3d axes = Matrix3d::Identity();
  if (contact.kind == ContactKind::line) {
    axes.leftCols<2>().noalias() = R * contact.frame.linear().rightCols<2>();
  }
  return axes;
}

Vector3d place_of(const Contact& contact, Kinematics& kinematics) noexcept {
  const LinkPose& link = kinematics.pose(contact.link);
  return link.R * contact.frame.translation() + link.p;
}

}  // namespace

ContactJacobian::ContactJacobian(const Robot& robot) : contacts_(robot.contacts) {
  Eigen::Index most = 0;
  for (const Contact& contact : contacts_) most += force_numbers(contact.kind);
  transposed_.setZero(robot.dof(), most);
}

void ContactJacobian::update(Kinematics& kinematics, const Sample& sample) noexcept {
  SHAPEID_CONTRACT(why_other_contacts(sample, contacts_.size()));
  rows_ = 0;
  const int base_dof = kinematics.base_dof();
  for (std::size_t c = 0; c < sample.in_contact.size(); ++c) {
    if (!sample.in_contact[c]) continue;
    const Contact& contact = contacts_[c];
    const Vector3d point = place_of(contact, kinematics);
    const Eigen::Index moments = force_numbers(contact.kind) - 3;
    const Matrix3d held = held_axes(contact, kinematics.pose(contact.link).R);
    auto JT = transposed_.middleCols(rows_, 3 + moments);
    JT.setZero();
    if (base_dof != 0) {
      JT.topLeftCorner<3, 3>().setIdentity();
      for (int k = 0; k < 3; ++k) JT.block<3, 1>(3, k) = point.cross(Vector3d::Unit(k));
      JT.block(3, 3, 3, moments) = held.leftCols(moments);
    }
    for (int i = contact.link; i != 0; i = kinematics.parent(i)) {
      const Vector3d z = kinematics.axis_in_base(i);
      auto row = JT.row(base_dof + i - 1);
      if (kinematics.slides(i)) {
        row.head<3>() = z;
      } else {
        row.head<3>() = z.cross(point - kinematics.pose(i).p);
        for (Eigen::Index k = 0; k < moments; ++k) row[3 + k] = z.dot(held.col(k));
      }
    }
    rows_ += 3 + moments;
  }
}

bool MeasuredForces::add_to(Eigen::VectorXd& force, Kinematics& kinematics,
                            const Sample& sample) const noexcept {
  if (sample.contact_force.size() != contacts_.size()) return false;
  const int base_dof = kinematics.base_dof();
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    const Vector3d& f = sample.contact_force[c];
    const Vector3d point = place_of(contacts_[c], kinematics);
    if (base_dof != 0) {
      force.head<3>() += f;
      force.segment<3>(3) += point.cross(f);
    }
    for (int i = contacts_[c].link; i != 0; i = kinematics.parent(i)) {
      const Vector3d z = kinematics.axis_in_base(i);
      const double share =
          kinematics.slides(i) ? z.dot(f) : z.dot((point - kinematics.pose(i).p).cross(f));
      force[base_dof + i - 1] += share;
    }
  }
  return true;
}

}  // namespace shapeid::fast
