#include "shapeid/tests/bench/problems/dense_problem.hpp"

#include "shapeid/reference/triangle.hpp"

namespace shapeid::bench {
namespace {

constexpr Eigen::Index per_link = 10;
constexpr double water = 1000.0;  // kg/m^3

void form_rows(const DenseProblem& problem, Eigen::MatrixXd& A) {
  const Eigen::MatrixXd& R = problem.triangle.Y;
  const Eigen::MatrixXd& U = problem.triangle.U;
  A.resize(R.rows(), U.cols());
  for (std::size_t link = 0; link + 1 < problem.first.size(); ++link) {
    const Eigen::Index row = per_link * static_cast<Eigen::Index>(link);
    const Eigen::Index from = problem.first[link];
    const Eigen::Index count = problem.first[link + 1] - from;
    const Eigen::Index reach = row + per_link;  // R is zero below
    // A product with ten terms an entry: too short for Eigen's blocked kernel.
    A.block(0, from, reach, count) =
        R.block<Eigen::Dynamic, per_link>(0, row, reach, per_link)
            .lazyProduct(U.block<per_link, Eigen::Dynamic>(row, from, per_link, count));
    A.block(reach, from, A.rows() - reach, count).setZero();
  }
}

/// Where Eigen's blocked kernel overtakes the plain product on the machines tried.
constexpr Eigen::Index small = 16;

void form_normal(const Prepared& rows, Eigen::MatrixXd& H, Eigen::VectorXd& g) {
  const Eigen::Index n = rows.A.cols();
  H.resize(n, n);
  if (n <= small) {
    H = rows.A.transpose().lazyProduct(rows.A);
  } else {
    H.triangularView<Eigen::Lower>() = rows.A.transpose() * rows.A;
    H.triangularView<Eigen::StrictlyUpper>() = H.transpose();
  }
  g.noalias() = -(rows.A.transpose() * rows.b);
}

}  // namespace

void prepare(const DenseProblem& problem, Form form, Prepared& out) {
  if (form == Form::triangle) return;
  form_rows(problem, out.A);
  out.b = problem.triangle.F;
  if (form == Form::normal) form_normal(out, out.H, out.g);
}

void carry_over(const DenseProblem& to, const Eigen::VectorXd& last, Eigen::VectorXd& start) {
  start.resize(to.triangle.shapes());
  start.head(last.size()) = last;
  if (!to.cut) return;
  const double whole = last[to.cut->place];
  start[to.cut->place] = to.cut->first_share * whole;
  start[last.size()] = whole - start[to.cut->place];
}

DenseProblem compressed(const MassProblem& problem, const BodyModel& model, Density density) {
  const Eigen::Index n = problem.Y.cols();
  Eigen::MatrixXd rows(problem.Y.rows(), n + 1);
  rows << problem.Y, problem.F;
  rows = problem.W.cwiseSqrt().asDiagonal() * rows;
  const Eigen::MatrixXd R = reference::triangle(rows);

  DenseProblem out;
  out.triangle = problem;
  const double unit = R.col(n).head(n).norm();
  out.triangle.Y = R.topLeftCorner(n, n) / unit;
  out.triangle.F = R.col(n).head(n) / unit;
  out.R = Eigen::MatrixXd::Zero(n + 1, n + 1);
  out.R.topLeftCorner(n, n) = out.triangle.Y;
  out.R.col(n).head(n) = out.triangle.F;
  out.triangle.W = Eigen::VectorXd::Ones(n);
  if (density == Density::design)
    out.triangle.lambda = default_lambda(out.triangle, water * out.triangle.V.sum());
  for (std::size_t j = 0; j < model.shapes.size(); ++j) {
    if (j == 0 || model.shapes[j].link != model.shapes[j - 1].link)
      out.first.push_back(static_cast<Eigen::Index>(j));
  }
  out.first.push_back(problem.shapes());
  return out;
}

}  // namespace shapeid::bench
