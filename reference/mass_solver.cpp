// Derivation, scaling and the finiteness of the method: docs/derivations/mass-problem.md.
#include "shapeid/reference/mass_solver.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "shapeid/models/error.hpp"

namespace shapeid::reference {
namespace {

// Data and answer are double. In between, sums are formed in long double (64 bits of mantissa on
// x86): which of two nearly parallel shapes carries the mass is decided by differences of the size
// lambda, and double rounding there is worth up to eps / 1e-12 of the mass.
using Real = long double;
using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
using Vector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;
using Places = std::vector<Eigen::Index>;

constexpr Real eps = std::numeric_limits<Real>::epsilon();

/// The problem in the variables x_j = d_j m_j with d_j^2 = lambda / V_j:
/// minimise || B x - b ||^2 + || x ||^2 over x >= 0.
struct ScaledProblem {
  Matrix B;      ///< A D^-1, A = W^(1/2) Y U reduced to a triangle's rows
  Vector b;      ///< W^(1/2) F likewise
  Vector d;      ///< diagonal of D
  Vector norms;  ///< of the columns of B
};

ScaledProblem scale(const MassProblem& problem) {
  const Vector root = problem.W.cast<Real>().cwiseSqrt();
  Matrix Y = root.asDiagonal() * problem.Y.cast<Real>();
  ScaledProblem s;
  s.b = root.cwiseProduct(problem.F.cast<Real>());
  if (Y.rows() > Y.cols()) {
    // Rows below the triangle are orthogonal to every column: they change f by a constant only.
    const Eigen::HouseholderQR<Matrix> qr(Y);
    s.b = (qr.householderQ().adjoint() * s.b).eval().head(Y.cols());
    Y = qr.matrixQR().topRows(Y.cols()).triangularView<Eigen::Upper>();
  }
  s.B = Y * problem.U.cast<Real>();
  s.norms = s.B.colwise().norm();
  // For lambda = 0 (or next to it) a floor that no gradient in double can tell from zero: it is a
  // hundredth of an eps of the term || a_j ||^2 m_j. K's condition then stays below 1e9 sqrt(n),
  // and the refinement in solve_kkt() converges.
  constexpr Real floor = 1e-9L;
  s.d = (static_cast<Real>(problem.lambda) * problem.V.cast<Real>().cwiseInverse())
            .cwiseSqrt()
            .cwiseMax(floor * s.norms);
  s.d = (s.d.array() > 0).select(s.d, Vector::Ones(s.d.size()));  // a column of zeros, lambda = 0
  s.B = s.B * s.d.cwiseInverse().asDiagonal();
  s.norms = s.norms.cwiseQuotient(s.d);
  return s;
}

/// Residual b - B x and masses (scaled) where the passive shapes alone minimise f.
struct KktPoint {
  Vector r;
  Vector x;  ///< one entry a passive shape, of any sign
};

/// (K), the KKT system of one step, with m_j = 0 for every shape that is not passive:
///     [ I      B_P ] [ r ]   [ b ]
///     [ B_P^T  -I  ] [ x ] = [ 0 ]
/// Its eigenvalues are +-sqrt(1 + sigma^2), so it is never singular. It is that of two
/// least-squares problems, || B_P x - b ||^2 + || x ||^2 in x and || B_P^T r ||^2 + || r - b ||^2
/// in r; the one with fewer unknowns is factored, and B^T B is never formed.
class KktSystem {
 public:
  explicit KktSystem(const Eigen::MatrixXd& B) : B_is_wide_(B.cols() > B.rows()) {
    const Eigen::Index unknowns = std::min(B.rows(), B.cols());
    Eigen::MatrixXd stacked(B.rows() + B.cols(), unknowns);
    stacked << (B_is_wide_ ? Eigen::MatrixXd(B.transpose()) : B),
        Eigen::MatrixXd::Identity(unknowns, unknowns);
    qr_.compute(stacked);
  }

  /// Solves K [r; x] = [b1; b2].
  void solve(const Eigen::VectorXd& b1, const Eigen::VectorXd& b2, Eigen::VectorXd& r,
             Eigen::VectorXd& x) const {
    if (B_is_wide_) {
      x = -solve_least_squares(b2, b1, r);
    } else {
      r = solve_least_squares(b1, -b2, x);
    }
  }

 private:
  /// Of the stacked matrix's least-squares problem for [top; bottom]: its unknowns, and what it
  /// leaves of `top`.
  Eigen::VectorXd solve_least_squares(const Eigen::VectorXd& top, const Eigen::VectorXd& bottom,
                                      Eigen::VectorXd& unknowns) const {
    Eigen::VectorXd c(top.size() + bottom.size());
    c << top, bottom;
    c.applyOnTheLeft(qr_.householderQ().adjoint());
    auto head = c.head(bottom.size());
    unknowns = qr_.matrixQR().topRows(bottom.size()).triangularView<Eigen::Upper>().solve(head);
    head.setZero();
    c.applyOnTheLeft(qr_.householderQ());
    return c.head(top.size());
  }

  bool B_is_wide_;
  Eigen::HouseholderQR<Eigen::MatrixXd> qr_;
};

KktPoint solve_kkt(const ScaledProblem& s, const Places& passive) {
  const Eigen::Index k = s.b.size(), p = static_cast<Eigen::Index>(passive.size());
  const Matrix B = s.B(Eigen::all, passive);

  // Factors in double, residuals in long double: each round gains the digits that the condition
  // leaves (six or more), so a handful reaches the last one. It ends when it no longer gains.
  constexpr int most_rounds = 8;
  const KktSystem K(B.cast<double>());
  KktPoint at{Vector::Zero(k), Vector::Zero(p)};
  Eigen::VectorXd dr, dx;
  Real last = std::numeric_limits<Real>::infinity();
  for (int round = 0; round < most_rounds; ++round) {
    const Vector b1 = s.b - at.r - B * at.x, b2 = at.x - B.transpose() * at.r;
    K.solve(b1.cast<double>(), b2.cast<double>(), dr, dx);
    const Real size = std::hypot(dr.norm(), dx.norm());
    if (!std::isfinite(size)) {
      throw Refusal("not-finite", "the mass problem's numbers are none, or too large to be solved");
    }
    if (!(size < last / 2)) break;
    at.r += dr.cast<Real>();
    at.x += dx.cast<Real>();
    last = size;
    if (size <= eps * std::hypot(at.r.norm(), at.x.norm())) break;
  }
  return at;
}

/// Shapes that are not held at zero, and their (scaled) masses.
struct Iterate {
  std::vector<bool> is_passive;
  Vector x;

  [[nodiscard]] Places passive() const {
    Places places;
    for (std::size_t j = 0; j < is_passive.size(); ++j) {
      if (is_passive[j]) places.push_back(static_cast<Eigen::Index>(j));
    }
    return places;
  }
};

/// Goes from the iterate toward `target` until the first mass becomes zero, and holds it there.
/// False if nothing is in the way: then the iterate is the target.
bool step_is_blocked(Iterate& at, const Places& passive, const Vector& target) {
  Real length = 1;
  Eigen::Index blocking = -1;
  for (std::size_t i = 0; i < passive.size(); ++i) {
    const Real from = at.x[passive[i]], to = target[static_cast<Eigen::Index>(i)];
    if (to > 0) continue;
    const Real reach = from > 0 ? from / (from - to) : Real{0};
    if (blocking < 0 || reach < length) {
      length = reach;
      blocking = passive[i];
    }
  }
  for (std::size_t i = 0; i < passive.size(); ++i) {
    Real& x = at.x[passive[i]];
    x += length * (target[static_cast<Eigen::Index>(i)] - x);
    if (passive[i] == blocking || !(x > 0)) {
      x = 0;
      at.is_passive[static_cast<std::size_t>(passive[i])] = false;
    }
  }
  return blocking >= 0;
}

/// Where a held shape would lower f, steepest first; pairs (passive set, entering shape) that were
/// tried before are left out. -1 if there is none.
using Tried = std::set<std::pair<std::vector<bool>, Eigen::Index>>;
Eigen::Index entering_shape(const ScaledProblem& s, const Iterate& at, const Vector& r,
                            const Tried& tried) {
  // Rounding of B_j^T r over || B_j ||: a dot product of k terms, r itself from k + p terms.
  constexpr Real safety = 4;
  const Real rounding =
      safety * eps * static_cast<Real>(s.b.size() + at.x.size()) * (s.b.norm() + s.norms.dot(at.x));
  Eigen::Index best = -1;
  Real steepest = rounding;
  for (Eigen::Index j = 0; j < at.x.size(); ++j) {
    if (at.is_passive[static_cast<std::size_t>(j)] || s.norms[j] == 0) continue;
    const Real slope = s.B.col(j).dot(r) / s.norms[j];
    if (slope > steepest && !tried.contains({at.is_passive, j})) {
      steepest = slope;
      best = j;
    }
  }
  return best;
}

}  // namespace

MassSolution solve_masses(const MassProblem& problem) {
  return solve_masses(problem, Eigen::VectorXd::Zero(problem.shapes()));
}

MassSolution solve_masses(const MassProblem& problem, const Eigen::VectorXd& start) {
  SHAPEID_CONTRACT(why_malformed(problem));
  SHAPEID_CONTRACT(why_no_start(problem, start));
  const ScaledProblem s = scale(problem);
  Iterate at{{}, s.d.cwiseProduct(start.cast<Real>())};
  for (const double mass : start) at.is_passive.push_back(mass > 0.0);

  // Every solved passive set has a lower f than the one before, so none comes twice and the method
  // is finite: at most 2^n sets in theory, two or three times the passive shapes in practice. The
  // pairs in `tried` keep it finite under rounding too; the bound only catches a defect.
  const Eigen::Index most_iterations = 100 + 20 * (s.b.size() + s.d.size());
  Tried tried;
  MassSolution solution;
  while (true) {
    if (++solution.iterations > most_iterations) {
      throw Defect(fmt::format("{} KKT systems did not solve a mass problem of {} shapes",
                               most_iterations, problem.shapes()));
    }
    const Places passive = at.passive();
    const KktPoint point = solve_kkt(s, passive);
    if (step_is_blocked(at, passive, point.x)) continue;
    const Eigen::Index entering = entering_shape(s, at, point.r, tried);
    if (entering < 0) break;
    tried.insert({at.is_passive, entering});
    at.is_passive[static_cast<std::size_t>(entering)] = true;
  }

  solution.m = at.x.cwiseQuotient(s.d).cast<double>();
  solution.Phi = problem.U * solution.m;
  solution.value = objective(problem, solution.m);
  solution.active = at.is_passive;
  solution.active.flip();
  return solution;
}

Violation why_no_start(const MassProblem& problem, const Eigen::VectorXd& start) {
  if (start.size() != problem.shapes()) {
    return fmt::format("{} masses for {} shapes", start.size(), problem.shapes());
  }
  if (!start.allFinite()) return "a mass of the start is not finite";
  if (start.size() > 0 && start.minCoeff() < 0.0) {
    return fmt::format("the start has a negative mass ({:g} kg)", start.minCoeff());
  }
  return std::nullopt;
}

double KktResidual::worst() const { return std::max({primal, dual, complementarity}); }

KktResidual kkt_residual(const MassProblem& problem, const Eigen::VectorXd& m) {
  KktResidual residual;
  if (m.size() == 0) return residual;
  const Eigen::MatrixXd Y = problem.Y.cwiseAbs(), U = problem.U.cwiseAbs();
  const Eigen::VectorXd mass = m.cwiseAbs();
  // The gradient with every term made positive: what its rounding is relative to.
  const Eigen::VectorXd terms =
      2.0 * (U.transpose() *
             (Y.transpose() * problem.W.cwiseProduct(Y * (U * mass) + problem.F.cwiseAbs()))) +
      2.0 * problem.lambda * mass.cwiseQuotient(problem.V);
  const Eigen::VectorXd z = gradient(problem, m);
  for (Eigen::Index j = 0; j < m.size(); ++j) {
    if (terms[j] == 0.0) continue;  // a shape that no row feels
    residual.dual = std::max(residual.dual, -z[j] / terms[j]);
    if (m[j] > 0.0) {
      residual.complementarity = std::max(residual.complementarity, std::abs(z[j]) / terms[j]);
    }
  }
  const double lowest = m.minCoeff();
  if (lowest < 0.0) residual.primal = -lowest / mass.maxCoeff();
  return residual;
}

}  // namespace shapeid::reference
