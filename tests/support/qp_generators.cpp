#include "shapeid/tests/support/qp_generators.hpp"

#include <algorithm>
#include <cmath>

#include "shapeid/tests/support/generators.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid::test {
namespace {

enum class Role { positive, held, degenerate };

struct DrawnColumn {
  Role role = Role::positive;
  bool second_link = false;
  Eigen::VectorXd u;      // ten entries
  double mass = 1.0;      // if positive
  double slope = 1.0;     // z relative to the column and the gradient, if held
  double volume = 1.0;    // of its scaled column
  double scale = 1.0;     // u -> scale u, m -> m / scale, V -> V / scale^2
  double distance = 0.0;  // from the column before it on the same link; 0: independent
};

struct DrawnRow {
  Eigen::VectorXd y;  // twenty entries
  double rho = 1.0;
  double weight = 1.0;
};

rc::Gen<double> maybe(bool wanted, rc::Gen<double> gen, double otherwise) {
  return wanted ? std::move(gen) : rc::gen::just(otherwise);
}

rc::Gen<DrawnColumn> column(const PlantedStyle& style) {
  const auto roles = style.degenerate
                         ? rc::gen::element(Role::positive, Role::held, Role::degenerate)
                         : rc::gen::element(Role::positive, Role::held);
  const auto distance = rc::gen::mapcat(rc::gen::arbitrary<bool>(), [](bool twin) {
    return maybe(twin, magnitude(1e-14, 1e-2), 0.0);
  });
  return rc::gen::build<DrawnColumn>(
      rc::gen::set(&DrawnColumn::role, roles), rc::gen::set(&DrawnColumn::second_link),
      rc::gen::set(&DrawnColumn::u, vector(10, 1.0)),
      rc::gen::set(&DrawnColumn::mass, magnitude(0.01, 10.0)),
      rc::gen::set(&DrawnColumn::slope, magnitude(style.near_parallel ? 1e-12 : 1e-2, 1.0)),
      rc::gen::set(&DrawnColumn::volume, magnitude(0.1, 10.0)),
      rc::gen::set(&DrawnColumn::scale, maybe(style.badly_scaled, magnitude(1e-4, 1e4), 1.0)),
      rc::gen::set(&DrawnColumn::distance, style.near_parallel ? distance : rc::gen::just(0.0)));
}

rc::Gen<DrawnRow> row(const PlantedStyle& style) {
  return rc::gen::build<DrawnRow>(
      rc::gen::set(&DrawnRow::y, vector(20, 1.0)), rc::gen::set(&DrawnRow::rho, real(-1.0, 1.0)),
      rc::gen::set(&DrawnRow::weight, maybe(style.badly_scaled, magnitude(1e-4, 1e4), 1.0)));
}

PlantedProblem planted_from(const std::vector<DrawnRow>& rows, std::vector<DrawnColumn> columns,
                            bool two_links, double relative_lambda) {
  PlantedProblem planted;
  MassProblem& p = planted.problem;
  const Eigen::Index n_Phi = two_links ? 20 : 10;
  const auto n_rows = static_cast<Eigen::Index>(rows.size());
  const auto n = static_cast<Eigen::Index>(columns.size());
  p.Y.resize(n_rows, n_Phi);
  p.W.resize(n_rows);
  Eigen::VectorXd rho(n_rows);
  for (Eigen::Index i = 0; i < n_rows; ++i) {
    const DrawnRow& drawn = rows[static_cast<std::size_t>(i)];
    p.Y.row(i) = drawn.y.head(n_Phi).transpose();
    rho[i] = drawn.rho;
    p.W[i] = drawn.weight;
  }
  const Eigen::VectorXd g_all = p.Y.transpose() * p.W.cwiseProduct(rho);
  p.lambda = relative_lambda * g_all.norm();

  p.U = Eigen::MatrixXd::Zero(n_Phi, n);
  p.V.resize(n);
  planted.m = planted.z = Eigen::VectorXd::Zero(n);
  Eigen::VectorXd before[2];
  for (Eigen::Index j = 0; j < n; ++j) {
    const DrawnColumn& drawn = columns[static_cast<std::size_t>(j)];
    const Eigen::Index link = two_links && drawn.second_link ? 1 : 0;
    const Eigen::VectorXd g = g_all.segment(10 * link, 10);
    Eigen::VectorXd u = drawn.u;
    if (drawn.distance > 0.0 && before[link].size() > 0) u = before[link] + drawn.distance * u;
    before[link] = u;
    p.V[j] = drawn.volume;
    if (g.squaredNorm() > 0.0) {  // rows that do not feel the link leave m_j = z_j = 0
      if (drawn.role == Role::positive) planted.m[j] = drawn.mass;
      if (drawn.role == Role::held) planted.z[j] = drawn.slope * g.norm();
      const double along = 0.5 * planted.z[j] - p.lambda * planted.m[j] / p.V[j];
      u += g * (along - u.dot(g)) / g.squaredNorm();
    }
    p.U.col(j).segment(10 * link, 10) = drawn.scale * u;
    planted.m[j] /= drawn.scale;
    planted.z[j] *= drawn.scale;
    p.V[j] /= drawn.scale * drawn.scale;
  }
  p.F = p.Y * (p.U * planted.m) - rho;
  p.mass_bound = 2.0 * planted.m.sum() + 1.0;
  return planted;
}

}  // namespace

rc::Gen<PlantedProblem> planted_problem(const PlantedStyle& style) {
  const auto rows = rc::gen::mapcat(rc::gen::inRange(1, 26), [style](int count) {
    return rc::gen::container<std::vector<DrawnRow>>(static_cast<std::size_t>(count), row(style));
  });
  const auto columns =
      rc::gen::mapcat(rc::gen::inRange(0, style.most_shapes + 1), [style](int count) {
        return rc::gen::container<std::vector<DrawnColumn>>(static_cast<std::size_t>(count),
                                                            column(style));
      });
  const auto lambda = maybe(!style.zero_lambda, magnitude(1e-12, 1.0), 0.0);
  // rapidcheck starts small and grows; here every case may as well be of full size.
  return rc::gen::resize(
      rc::kNominalSize,
      rc::gen::map(rc::gen::tuple(rows, columns, rc::gen::arbitrary<bool>(), lambda),
                   [](const auto& t) { return std::apply(planted_from, t); }));
}

Eigen::VectorXd gradient_terms(const MassProblem& p, const Eigen::VectorXd& m) {
  const Eigen::MatrixXd Y = p.Y.cwiseAbs(), U = p.U.cwiseAbs();
  const Eigen::VectorXd residual = Y * (U * m) + p.F.cwiseAbs();
  return U.transpose() * (Y.transpose() * p.W.cwiseProduct(residual)) +
         p.lambda * m.cwiseQuotient(p.V);
}

double objective_terms(const MassProblem& p, const Eigen::VectorXd& m) {
  const Eigen::VectorXd residual = p.Y.cwiseAbs() * (p.U.cwiseAbs() * m) + p.F.cwiseAbs();
  return residual.dot(p.W.cwiseProduct(residual)) +
         p.lambda * m.cwiseAbs2().cwiseQuotient(p.V).sum();
}

double scaled_mass_difference(const MassProblem& p, const Eigen::VectorXd& m1,
                              const Eigen::VectorXd& m2) {
  const Eigen::VectorXd D = (p.lambda * p.V.cwiseInverse()).cwiseSqrt();
  const Eigen::VectorXd terms = gradient_terms(p, m1).cwiseMax(gradient_terms(p, m2));
  return scaled(D.cwiseProduct(m1 - m2).norm(), terms.cwiseQuotient(D).norm(),
                p.F.size() + p.shapes());
}

double scaled_objective_difference(const MassProblem& p, const Eigen::VectorXd& m1,
                                   const Eigen::VectorXd& m2) {
  return scaled(std::abs(objective(p, m1).total() - objective(p, m2).total()),
                std::max(objective_terms(p, m1), objective_terms(p, m2)), p.F.size() + p.shapes());
}

}  // namespace shapeid::test
