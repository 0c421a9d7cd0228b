#include "shapeid/tests/fast/triangle_cases.hpp"

#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "shapeid/fast/triangle.hpp"
#include "shapeid/tests/support/svd.hpp"

namespace shapeid::test {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// A random rotation of wrenches, six by six.
MatrixXd rotation_of_wrenches(Draw& draw) {
  MatrixXd random(6, 6);
  for (double& x : random.reshaped()) x = draw.sign();
  return Eigen::HouseholderQR<MatrixXd>(random).householderQ();
}

MatrixXd rows_of_motion(Draw& draw, int links, int samples) {
  MatrixXd Y(6 * samples, 10 * links);
  for (int i = 0; i < samples; ++i) {
    for (int l = 0; l < links; ++l) {
      const Eigen::Vector3d omega = draw.vector(2.0), alpha = draw.vector(20.0),
                            a = Eigen::Vector3d(0.0, 0.0, 9.81) + draw.vector(4.0);
      Y.block<6, 10>(Eigen::Index{6} * i, Eigen::Index{10} * l) =
          rotation_of_wrenches(draw) * body_rows(omega, alpha, a);
    }
  }
  return Y;
}

Vector10 any_cuboid(Draw& draw, double& volume) {
  const Eigen::Vector3d centre = draw.vector(0.2);
  const Eigen::Vector3d sides(draw.between(0.01, 0.1), draw.between(0.01, 0.1),
                              draw.between(0.01, 0.1));
  volume = sides.prod();
  return cuboid_body(1.0, centre, sides).values;
}

}  // namespace

TriangleCase compressed(const MassProblem& problem) {
  TriangleCase result;
  fast::Triangle triangle(problem.Y.cols());
  const VectorXd root = problem.W.cwiseSqrt();
  const MatrixXd Y = root.asDiagonal() * problem.Y;
  triangle.add(Y, root.cwiseProduct(problem.F));
  result.R = triangle.R();
  result.problem = problem;
  result.problem.Y = result.R.leftCols(problem.Y.cols());
  result.problem.F = result.R.rightCols<1>();
  result.problem.W = VectorXd::Ones(result.R.rows());
  for (Index j = 0; j < problem.shapes(); ++j) {
    Index row = 0;
    problem.U.col(j).cwiseAbs().maxCoeff(&row);
    result.links.push_back(static_cast<int>(row / 10));
  }
  return result;
}

TriangleCase body_case(std::uint64_t seed, const BodyStyle& style) {
  Draw draw(seed);
  const int samples = style.samples > 0 ? style.samples : 2 + 3 * style.links;
  const Index n = Index{style.links} * style.shapes_a_link;
  MassProblem p;
  p.Y = rows_of_motion(draw, style.links, samples);
  p.U = MatrixXd::Zero(Index{10} * style.links, n);
  p.V.resize(n);
  VectorXd truth = VectorXd::Zero(n);
  for (Index j = 0; j < n; ++j) {
    p.U.col(j).segment<10>(10 * (j % style.links)) = any_cuboid(draw, p.V[j]);
    if (draw.between(0.0, 1.0) < 1.0 / 3.0) truth[j] = draw.between(0.1, 2.0);
  }
  p.F = p.Y * (p.U * truth);
  const double size = p.F.norm() / std::sqrt(static_cast<double>(p.F.size()));
  for (double& f : p.F) f += style.noise * size * draw.normal();
  p.W = VectorXd::Ones(p.F.size());
  p.mass_bound = 2.0 * truth.sum() + 1.0;
  if (style.density_term && n > 0) p.lambda = default_lambda(p, truth.sum() + 1.0);
  return compressed(p);
}

TriangleCase permuted(const TriangleCase& given, const std::vector<int>& order) {
  TriangleCase result = given;
  result.problem.U = given.problem.U(Eigen::all, order);
  result.problem.V = given.problem.V(order);
  for (std::size_t i = 0; i < order.size(); ++i) {
    result.links[i] = given.links[static_cast<std::size_t>(order[i])];
  }
  return result;
}

// Centre and sides come back out of the unit parameters.
void divide(TriangleCase& given, int j, Draw& draw) {
  MassProblem& p = given.problem;
  const InertialParameters whole{Vector10(given.column(j))};
  const Eigen::Vector3d centre = whole.first_moment();
  const Eigen::Vector3d squares =
      whole.tensor().diagonal() -
      cuboid_body(1.0, centre, Eigen::Vector3d::Zero()).tensor().diagonal();
  Eigen::Vector3d sides =
      (6.0 * (Eigen::Vector3d::Constant(squares.sum()) - 2.0 * squares)).cwiseMax(0.0).cwiseSqrt();
  Index longest = 0;
  const double side = sides.maxCoeff(&longest);
  const double share = draw.between(0.2, 0.8);
  const Eigen::Vector3d along = side * Eigen::Vector3d::Unit(longest);
  sides[longest] = share * side;
  const Vector10 first = cuboid_body(1.0, centre - 0.5 * (1.0 - share) * along, sides).values;
  sides[longest] = (1.0 - share) * side;
  const Vector10 second = cuboid_body(1.0, centre + 0.5 * share * along, sides).values;

  const Index link = given.links[static_cast<std::size_t>(j)], last = p.shapes();
  p.U.conservativeResize(Eigen::NoChange, last + 1);
  p.V.conservativeResize(last + 1);
  p.U.col(last).setZero();
  p.U.col(j).segment<10>(10 * link) = first;
  p.U.col(last).segment<10>(10 * link) = second;
  p.V[last] = (1.0 - share) * p.V[j];
  p.V[j] *= share;
  given.links.push_back(static_cast<int>(link));
}

void load(const TriangleCase& given, fast::MassSolver& solver) {
  solver.set_lambda(given.problem.lambda);
  for (int j = 0; j < given.shapes(); ++j) {
    static_cast<void>(solver.append(given.links[static_cast<std::size_t>(j)], given.column(j),
                                    given.problem.V[j]));
  }
}

VectorXd any_start(std::uint64_t seed, const TriangleCase& given) {
  Draw draw(seed);
  VectorXd m(given.shapes());
  for (double& mass : m) mass = std::max(0.0, 2.0 * draw.sign());
  return m;
}

void start_at(const VectorXd& m, fast::MassSolver& solver) {
  for (Index j = 0; j < m.size(); ++j) {
    if (m[j] > 0.0) solver.start_at(static_cast<int>(j), m[j]);
  }
}

bool determines_parameters(const TriangleCase& given) {
  constexpr double good_margin = 1e-6;
  const VectorXd lengths = given.problem.Y.colwise().norm();
  if (!(lengths.minCoeff() > 0.0)) return false;
  const MatrixXd unit = given.problem.Y * lengths.cwiseInverse().asDiagonal();
  const VectorXd sigma = singular_values(unit);
  return sigma.minCoeff() > good_margin * sigma.maxCoeff();
}

}  // namespace shapeid::test
