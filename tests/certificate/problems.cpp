#include "shapeid/tests/certificate/problems.hpp"

#include <Eigen/QR>

#include <cmath>

#include "shapeid/tests/support/generators.hpp"
#include "shapeid/tests/support/load_problem.hpp"
#include "shapeid/tests/support/qp_generators.hpp"

namespace shapeid::test {
namespace {

const Eigen::Vector3d region_lower(-0.2, -0.1, 0.05), region_upper(0.2, 0.1, 0.1);

Shape box(const Eigen::Vector3d& lower, const Eigen::Vector3d& upper) {
  return make_cuboid(upper - lower, Eigen::Isometry3d(Eigen::Translation3d(0.5 * (lower + upper))));
}

/// A column beside the masses, before it has rows.
struct DrawnColumn {
  double lower = 0.0, upper = 0.0;
  Eigen::VectorXd values;
};

rc::Gen<DrawnColumn> drawn_column() {
  const auto lower = rc::gen::element(-HUGE_VAL, -0.5, 0.0);
  const auto upper = rc::gen::element(HUGE_VAL, 0.25, 0.0);
  return rc::gen::build<DrawnColumn>(rc::gen::set(&DrawnColumn::lower, lower),
                                     rc::gen::set(&DrawnColumn::upper, upper),
                                     rc::gen::set(&DrawnColumn::values, vector(25, 1.0)));
}

}  // namespace

StatedProblem load_problem() {
  Draw draw(20240611);
  StatedProblem p{
      load_window(draw, 20, cuboid_body(1.0, {0.071, -0.033, 0.074}, {0.04, 0.04, 0.04}), 0.01),
      {},
      {{0, box(region_lower, region_upper)}}};
  fill_with_cuboids(p.masses, region_lower, region_upper, {6, 4, 2});
  p.masses.lambda = default_lambda(p.masses, 1.0);
  return p;
}

StatedProblem body_problem(int per_link) {
  constexpr Eigen::Index links = 13, samples = 60;
  Draw draw(7);
  StatedProblem p;
  MassProblem& q = p.masses;
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(18 * samples, 10 * links + 1);
  Eigen::VectorXd truth(10 * links);
  q.U = Eigen::MatrixXd::Zero(10 * links, links * per_link);
  q.V.resize(links * per_link);
  for (Eigen::Index l = 0; l < links; ++l) {
    truth.segment<10>(10 * l) = cuboid_body(1.0, draw.vector(0.05), {0.04, 0.05, 0.06}).values;
    MassProblem one;
    fill_with_cuboids(one, {-0.2, -0.1, -0.1}, {0.2, 0.1, 0.1}, {per_link, 1, 1});
    // Slices along x.
    q.U.block(10 * l, per_link * l, 10, per_link) = one.U;
    q.V.segment(per_link * l, per_link) = one.V;
    for (Eigen::Index s = 0; s < samples; ++s) {
      const auto Y = body_rows(draw.vector(2.0), draw.vector(20.0),
                               Eigen::Vector3d(0.0, 0.0, 9.81) + draw.vector(4.0));
      for (Eigen::Index i = 0; i < 18; ++i) {  // legs carry what their links need
        const Eigen::Index joint = 6 + l;
        if (i < 6 || i == joint) rows.row(18 * s + i).segment<10>(10 * l) = Y.row(i % 6);
      }
    }
  }
  rows.rightCols<1>() = rows.leftCols<10 * links>() * truth;
  for (double& force : rows.rightCols<1>().reshaped()) force += 0.1 * draw.normal();
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(rows);
  const Eigen::MatrixXd R = qr.matrixQR().topRows<10 * links>().triangularView<Eigen::Upper>();
  q.Y = R.leftCols<10 * links>();
  q.F = R.rightCols<1>();
  q.W = Eigen::VectorXd::Ones(q.F.size());
  q.lambda = default_lambda(q, 13.0);
  q.mass_bound = 130.0;
  return p;
}

StatedProblem one_point_problem() {
  StatedProblem p;
  p.masses.Y = Eigen::RowVectorXd::Unit(10, 0);
  p.masses.U = Eigen::VectorXd::Unit(10, 0);
  p.masses.F = p.masses.W = Eigen::VectorXd::Ones(1);
  p.masses.V = Eigen::VectorXd::Constant(1, 64.0);
  p.masses.lambda = 64.0;
  p.masses.mass_bound = 0.125;
  p.regions = {{0, make_point(Eigen::Vector3d::Zero(), 64.0)}};
  return p;
}

rc::Gen<StatedProblem> small_problem(bool zero_lambda) {
  PlantedStyle style;
  style.most_shapes = 4;
  style.zero_lambda = zero_lambda;
  style.degenerate = true;
  return rc::gen::apply(
      [](const PlantedProblem& planted, const std::vector<DrawnColumn>& columns) {
        StatedProblem p{planted.problem, {}, {}};
        const Eigen::Index rows = p.masses.F.size();
        const auto count = std::min(static_cast<Eigen::Index>(columns.size()), Eigen::Index{3});
        p.others.values.resize(rows, count);
        p.others.lower.resize(count);
        p.others.upper.resize(count);
        for (Eigen::Index k = 0; k < count; ++k) {
          const DrawnColumn& drawn = columns[static_cast<std::size_t>(k)];
          p.others.values.col(k) = drawn.values.head(rows);
          p.others.lower[k] = drawn.lower;
          p.others.upper[k] = drawn.upper;
        }
        p.masses.mass_bound = 0.0;
        return p;
      },
      planted_problem(style), rc::gen::container<std::vector<DrawnColumn>>(drawn_column()));
}

Answer honest_answer(const StatedProblem& p, const Eigen::VectorXd& m, const Eigen::VectorXd& x) {
  const Eigen::VectorXd Phi = p.masses.U * m;
  Eigen::VectorXd r = p.masses.Y * Phi - p.masses.F;
  if (x.size() > 0) r += p.others.values * x;
  const double density = p.masses.lambda * m.cwiseAbs2().cwiseQuotient(p.masses.V).sum();
  return {problem_digest(p), m, Phi, r.dot(p.masses.W.cwiseProduct(r)) + density, x};
}

}  // namespace shapeid::test
