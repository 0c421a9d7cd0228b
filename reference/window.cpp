#include "shapeid/reference/window.hpp"

#include <utility>

#include "shapeid/reference/projection.hpp"
#include "shapeid/reference/triangle.hpp"

namespace shapeid::reference {
namespace {

[[maybe_unused]] Violation why_other_links(const std::vector<int>& window_links,
                                           const BodyModel& model) {
  if (model.free_links == window_links) return std::nullopt;
  return "the model's free links are not those of the window";
}

}  // namespace

Window::Window(const Robot& robot, const BodyModel& model, ContactTreatment contacts,
               Eigen::VectorXd weight)
    : robot_(&robot),
      contacts_(contacts),
      weight_(std::move(weight)),
      known_(model.known),
      free_links_(model.free_links) {
  SHAPEID_CONTRACT(why_malformed(model, robot));
  SHAPEID_CONTRACT(why_no_weight(weight_, robot.dof()));
  // A triangle costs one pass over all rows: with room for several triangles it is made seldom.
  constexpr Eigen::Index triangles = 4;
  const Eigen::Index columns = 10 * static_cast<Eigen::Index>(free_links_.size()) + 1;
  rows_.resize(triangles * columns + robot.dof(), columns);
}

void Window::add(const Sample& sample) {
  add(sample_rows(*robot_, known_, free_links_, contacts_, sample));
}

void Window::add(const SampleRows& rows) {
  // Without rows in J this only multiplies by W^(1/2).
  const ContactFreeRows free = eliminate_contacts(rows.Y, rows.F, rows.J, weight_);
  add_rows(free.Y, free.F);
}

void Window::add_rows(const Eigen::MatrixXd& Y, const Eigen::VectorXd& F) {
  if (used_ + Y.rows() > rows_.rows()) reduce();
  rows_.block(used_, 0, Y.rows(), Y.cols()) = Y;  // (5)
  rows_.block(used_, Y.cols(), F.rows(), 1) = F;
  used_ += Y.rows();
  ++samples_;
}

void Window::clear() {
  used_ = 0;
  samples_ = 0;
}

Eigen::MatrixXd Window::Y() const { return rows_.topRows(used_).leftCols(rows_.cols() - 1); }

Eigen::VectorXd Window::F() const { return rows_.topRows(used_).rightCols<1>(); }

MassProblem Window::problem(const BodyModel& model) const {
  SHAPEID_CONTRACT(why_other_links(free_links_, model));
  MassProblem p;
  p.Y = Y();
  p.F = F();
  p.W = Eigen::VectorXd::Ones(used_);
  p.U = shape_columns(model);
  p.V = shape_volumes(model);
  SHAPEID_CONTRACT(why_malformed(p));
  return p;
}

// Exact, not an approximation: [Y F] = Q R with Q^T Q = 1, so || Y x - F || = || R (x, -1) || for
// every x. Normal equations, minimum and objective (its constant included: the last row of R) stay.
void Window::reduce() {
  const Eigen::MatrixXd R = triangle(rows_.topRows(used_));
  rows_.topRows(R.rows()) = R;
  used_ = R.rows();
}

}  // namespace shapeid::reference
