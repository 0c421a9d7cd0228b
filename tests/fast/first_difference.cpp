#include "shapeid/tests/fast/first_difference.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <span>

#include "shapeid/models/inertia.hpp"
#include "shapeid/reference/regressor.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid::test {
namespace {

/// 17 digits: enough to type the numbers in again.
std::string numbers(std::span<const double> v) {
  std::string text;
  for (const double x : v) text += fmt::format(" {:.17g}", x);
  return text;
}

template <typename Dense>
std::string numbers(const Dense& v) {
  return numbers(std::span<const double>(v.data(), static_cast<std::size_t>(v.size())));
}

std::string name_of(JointKind kind) {
  switch (kind) {
    case JointKind::revolute:
      return "revolute";
    case JointKind::continuous:
      return "continuous";
    case JointKind::prismatic:
      return "prismatic";
  }
  return "unknown";
}

std::string input(const Robot& robot, const Sample& s) {
  std::string text = robot.root == Root::floating ? "floating root\n" : "fixed root\n";
  for (int i = 1; i < robot.link_count(); ++i) {
    const Link& link = robot.links[static_cast<std::size_t>(i)];
    const Eigen::Matrix4d placement = link.joint.placement.matrix();
    text += fmt::format("link {} on {}, {}, axis{}, placement by columns{}\n", i, link.parent,
                        name_of(link.joint.kind), numbers(link.joint.axis), numbers(placement));
  }
  text += fmt::format("omega{}\nalpha{}\nspecific force{}\n", numbers(s.base_angular_velocity),
                      numbers(s.base_angular_acceleration), numbers(s.base_specific_force));
  text += fmt::format("q{}\ndq{}\nddq{}\ntau{}\n", numbers(s.q), numbers(s.dq), numbers(s.ddq),
                      numbers(s.tau));
  for (std::size_t c = 0; c < s.in_contact.size(); ++c) {
    const Contact& contact = robot.contacts[c];
    const Eigen::Matrix4d frame = contact.frame.matrix();
    text += fmt::format("{} contact of kind {} on link {}, frame by columns{}\n",
                        s.in_contact[c] ? "touching" : "free", static_cast<int>(contact.kind),
                        contact.link, numbers(frame));
  }
  return text;
}

}  // namespace

std::string first_difference(const Eigen::MatrixXd& fast, const Eigen::MatrixXd& reference,
                             double scale, Eigen::Index size, const Robot& robot,
                             const Sample& sample) {
  if (fast.rows() != reference.rows() || fast.cols() != reference.cols()) {
    return fmt::format("fast is {} x {}, reference {} x {}\n{}", fast.rows(), fast.cols(),
                       reference.rows(), reference.cols(), input(robot, sample));
  }
  for (Eigen::Index row = 0; row < fast.rows(); ++row) {
    for (Eigen::Index column = 0; column < fast.cols(); ++column) {
      const double ours = fast(row, column), theirs = reference(row, column);
      const double error = scaled(std::abs(ours - theirs), scale, size);
      if (error < few_hundred_eps) continue;  // a NaN is not
      return fmt::format("row {}, column {}: fast {:.17g}, reference {:.17g}, scaled {:.3g}\n{}",
                         row, column, ours, theirs, error, input(robot, sample));
    }
  }
  return {};
}

std::string first_difference(const Eigen::MatrixXd& Y, const Robot& robot,
                             const std::vector<int>& links, const Sample& sample) {
  const Eigen::MatrixXd expected = reference::regressor(robot, sample);
  // What errors are measured against: the whole wrench on a link, of which a joint feels a part.
  // Let loose, the root feels it whole.
  Robot loose = robot;
  loose.root = Root::floating;
  const Eigen::MatrixXd wrenches = reference::regressor(loose, sample);
  const auto columns = 10 * static_cast<Eigen::Index>(links.size());
  if (Y.rows() != expected.rows() || Y.cols() != columns) {
    return fmt::format("{} x {} instead of {} x {}", Y.rows(), Y.cols(), expected.rows(), columns);
  }
  for (Eigen::Index row = 0; row < Y.rows(); ++row) {
    for (Eigen::Index column = 0; column < columns; ++column) {
      const Eigen::Index parameter = column % 10;
      const Eigen::Index link = links[static_cast<std::size_t>(column / 10)];
      const double ours = Y(row, column), theirs = expected(row, 10 * link + parameter);
      const double error = scaled(std::abs(ours - theirs),
                                  wrenches.middleCols<10>(10 * link).norm(), robot.link_count());
      if (error < few_hundred_eps) continue;  // a NaN is not
      return fmt::format("row {}, link {}, {}: fast {:.17g}, reference {:.17g}, scaled {:.3g}\n{}",
                         row, link, parameter_names[static_cast<std::size_t>(parameter)], ours,
                         theirs, error, input(robot, sample));
    }
  }
  return {};
}

}  // namespace shapeid::test
