#include "shapeid/tests/fast/expected_rows.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "shapeid/reference/contact.hpp"
#include "shapeid/reference/projection.hpp"
#include "shapeid/reference/regressor.hpp"
#include "shapeid/reference/sample_rows.hpp"
#include "shapeid/tests/fast/first_difference.hpp"
#include "shapeid/tests/support/scaled.hpp"
#include "shapeid/tests/support/svd.hpp"

namespace shapeid::test {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Lengths of the columns of W^(1/2) [Y F], every term positive and felt whole by the root: the
/// parts that joints feel, or that cancel, carry the rounding of the whole.
VectorXd column_sizes(const Robot& robot, const BodyModel& model, ContactTreatment contacts,
                      double largest_root, const Sample& s) {
  Robot loose = robot;
  loose.root = Root::floating;
  const MatrixXd Y = reference::regressor(loose, s);
  VectorXd sizes(10 * static_cast<Index>(model.free_links.size()) + 1);
  Index column = 0;
  for (const int link : model.free_links) {
    // A link's columns come of the same products.
    sizes.segment<10>(column).setConstant(Y.middleCols<10>(Index{10} * link).norm());
    column += 10;
  }
  double F = s.tau.norm() + (Y.cwiseAbs() * model.known.cwiseAbs()).norm();
  if (contacts == ContactTreatment::measured) {
    const double reach =
        reference::contact_jacobian(loose,
                                    [&] {
                                      Sample touching = s;
                                      touching.in_contact.assign(robot.contacts.size(), true);
                                      return touching;
                                    }())
            .norm();
    for (const Eigen::Vector3d& f : s.contact_force) F += reach * f.norm();
  }
  sizes[column] = F;
  return largest_root * sizes;
}

/// Columns of the joints that carry a touching contact.
std::vector<Index> standing_joints(const Robot& robot, const Sample& s) {
  std::vector<Index> joints;
  for (int link = 1; link < robot.link_count(); ++link) {
    for (std::size_t c = 0; c < s.in_contact.size(); ++c) {
      int i = robot.contacts[c].link;
      while (i > link) i = robot.links[static_cast<std::size_t>(i)].parent;
      if (s.in_contact[c] && i == link) {
        joints.push_back(robot.base_dof() + link - 1);
        break;
      }
    }
  }
  return joints;
}

/// How much an error of eps in J, of the size of the robot, turns the range of W^(1/2) J^T; and, if
/// stance legs can be solved for forces, how much is lost by that.
double condition_of(const Robot& robot, const BodyModel& model, const VectorXd& weight,
                    const Sample& s) {
  const MatrixXd J = reference::contact_jacobian(robot, s);
  if (J.rows() == 0) return 1.0;
  const VectorXd root = weight.cwiseSqrt();
  const MatrixXd A = root.asDiagonal() * J.transpose();
  const int rank = reference::contact_free_basis(J, weight).rank;
  if (rank == 0) return 1.0;
  const double smallest = singular_values(A)[rank - 1];
  const double reach = root.maxCoeff() * (1.0 + J.norm());
  double condition = reach / smallest;

  const std::vector<Index> standing = standing_joints(robot, s);
  if (robot.root != Root::floating || model.free_links != std::vector<int>{0} ||
      static_cast<Index>(standing.size()) != J.rows()) {
    return condition;
  }
  const MatrixXd A_s = A(standing, Eigen::all);
  const ThinSvd svd(A_s);
  const VectorXd& sigma = svd.sigma;
  if (sigma[sigma.size() - 1] > 0.0) {
    const MatrixXd H = svd.solve(MatrixXd::Identity(A_s.rows(), A_s.rows())).transpose() *
                       A.topRows(6).transpose();
    condition = std::max(condition, reach / sigma[sigma.size() - 1]) * (1.0 + H.squaredNorm());
  }
  return condition;
}

}  // namespace

ExpectedRows expected_rows(const Robot& robot, const BodyModel& model, ContactTreatment contacts,
                           const Eigen::VectorXd& weight, const Sample& sample) {
  const reference::SampleRows rows =
      reference::sample_rows(robot, model.known, model.free_links, contacts, sample);
  const auto free = reference::eliminate_contacts(rows.Y, rows.F, rows.J, weight);
  MatrixXd YF(free.Y.rows(), free.Y.cols() + 1);
  YF << free.Y, free.F;
  const double largest_root = std::sqrt(weight.size() > 0 ? weight.maxCoeff() : 1.0);
  const VectorXd sizes = column_sizes(robot, model, contacts, largest_root, sample);
  const double condition =
      contacts == ContactTreatment::project ? condition_of(robot, model, weight, sample) : 1.0;
  return {YF.transpose() * YF, condition * sizes * sizes.transpose()};
}

std::string first_difference(const Eigen::MatrixXd& gram, const ExpectedRows& expected,
                             const Robot& robot, const Sample& sample) {
  // Entries that may be zero in exact arithmetic as well as by their bound: no scale, no rounding.
  const MatrixXd scale = expected.rounding.cwiseMax(1e-290);
  return first_difference(gram.cwiseQuotient(scale), expected.gram.cwiseQuotient(scale), 1.0,
                          robot.dof() + robot.link_count(), robot, sample);
}

}  // namespace shapeid::test
