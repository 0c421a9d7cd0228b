// Rows of rigid links, free of contact forces, by either of the two implementations.
#pragma once

#include <Eigen/Core>

#include <optional>
#include <vector>

#include "shapeid/fast/contact.hpp"
#include "shapeid/fast/inverse_dynamics.hpp"
#include "shapeid/fast/projection.hpp"
#include "shapeid/fast/regressor.hpp"
#include "shapeid/models/contact_treatment.hpp"
#include "shapeid/models/robot.hpp"
#include "shapeid/models/sample.hpp"
#include "shapeid/reference/kinematics.hpp"

namespace shapeid::diagnosis {

enum class Path { reference, fast };

/// How rows come about: what becomes of contact forces, and who computes. A treatment of contacts
/// alone is that of the reference.
struct RowSource {
  ContactTreatment contacts;
  Path path;
  RowSource(ContactTreatment contacts_, Path path_ = Path::reference)
      : contacts(contacts_), path(path_) {}
};

/// Y, Y Phi and J of a sample: `reference::regressor`, `reference::inverse_dynamics` and
/// `reference::contact_jacobian`, or the same by the fast path, which needs no motions. Not for
/// several threads at once.
class RigidRows {
 public:
  /// What the fast path needs of the robot is copied.
  RigidRows(const Robot& robot, Path path);

  /// dof x (10 per link). `robot` is that of the construction, `motions` are the sample's.
  [[nodiscard]] Eigen::MatrixXd regressor(const Robot& robot, const Sample& sample,
                                          const std::vector<reference::LinkMotion>& motions);
  /// dof, of `Phi`: 10 per link.
  [[nodiscard]] Eigen::VectorXd inverse_dynamics(const Robot& robot, const Sample& sample,
                                                 const std::vector<reference::LinkMotion>& motions,
                                                 const Eigen::VectorXd& Phi);
  /// Contact rows x dof.
  [[nodiscard]] Eigen::MatrixXd contact_jacobian(const Robot& robot, const Sample& sample,
                                                 const std::vector<reference::LinkMotion>& motions);

 private:
  struct Fast {
    explicit Fast(const Robot& robot);
    fast::Regressor regressor;
    fast::Kinematics kinematics;
    fast::ContactJacobian jacobian;
    Eigen::VectorXd Phi;  ///< what `dynamics` was made for
    std::optional<fast::InverseDynamics> dynamics;
  };
  std::optional<Fast> fast_;
};

/// What contact forces cannot change, of rows at a time. The fast path's basis is the reference's
/// up to a rotation, which no sum of squares feels.
class ContactFree {
 public:
  /// `weight`: diagonal of W, dof.
  ContactFree(const Robot& robot, const Eigen::VectorXd& weight, Path path);

  /// Q2^T W^(1/2) rows. `rows`: dof x any.
  [[nodiscard]] Eigen::MatrixXd operator()(const Eigen::MatrixXd& J, const Eigen::MatrixXd& rows);
  /// P force with P = I - J^T (J^T)^+. Only if the weight is one everywhere.
  [[nodiscard]] Eigen::MatrixXd beyond(const Eigen::MatrixXd& J, const Eigen::MatrixXd& force);

 private:
  Eigen::VectorXd weight_, root_;
  std::optional<fast::ContactElimination> fast_;
};

}  // namespace shapeid::diagnosis
