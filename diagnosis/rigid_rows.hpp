// Rows of rigid links, free of contact forces, by either of the two implementations.
#pragma once

#include <Eigen/Core>

#include <optional>

#include "shapeid/fast/contact.hpp"
#include "shapeid/fast/projection.hpp"
#include "shapeid/fast/regressor.hpp"
#include "shapeid/models/contact_treatment.hpp"
#include "shapeid/models/robot.hpp"
#include "shapeid/models/sample.hpp"

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

/// Y and J of a sample: `reference::regressor` and `reference::contact_jacobian`, or the same
/// matrices by the fast path. Not for several threads at once.
class RigidRows {
 public:
  /// What the fast path needs of the robot is copied.
  RigidRows(const Robot& robot, Path path);

  /// dof x (10 per link). `robot` is that of the construction.
  [[nodiscard]] Eigen::MatrixXd regressor(const Robot& robot, const Sample& sample);
  /// Contact rows x dof.
  [[nodiscard]] Eigen::MatrixXd contact_jacobian(const Robot& robot, const Sample& sample);

 private:
  struct Fast {
    explicit Fast(const Robot& robot);
    fast::Regressor regressor;
    fast::Kinematics kinematics;
    fast::ContactJacobian jacobian;
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
