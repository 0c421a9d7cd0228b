#include "shapeid/app/relaxed_optima.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/QR>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "shapeid/models/inertia.hpp"
#include "shapeid/proofs/certificate/floor.hpp"
#include "shapeid/reference/mass_solver.hpp"

namespace shapeid::app {
namespace {

using certificate::Guess;
using Matrix10 = Eigen::Matrix<double, 10, 10>;

/// m: about how far from the links' origins their mass is, so that Sigma's entries are of one size.
double length_of(const MassProblem& p) {
  constexpr double usual = 0.1;
  double square = 0.0, mass = 0.0;
  for (Eigen::Index l = 0; l < p.U.rows(); l += 10) {
    square += 0.5 * (p.U.row(l + 4) + p.U.row(l + 7) + p.U.row(l + 9)).sum() / 3.0;
    mass += p.U.row(l).sum();
  }
  return square > 0.0 && mass > 0.0 ? std::sqrt(square / mass) : usual;
}

/// || A s - b ||^2 - mu (sum of log det Sigma_l + log (largest trace - sum of traces)) over the ten
/// entries s of each link's Sigma in units of kg and `length`. Bodies that the data do not see
/// would grow without end; the trace keeps them finite.
class Barrier {
 public:
  explicit Barrier(const MassProblem& p) : links_(p.Y.cols() / 10) {
    const double length = length_of(p);
    const Eigen::Vector4d unit(length, length, length, 1.0);
    for (int j = 0, k = 0; j < 4; ++j) {
      for (int i = 0; i <= j; ++i, ++k) {
        Eigen::Matrix4d E = Eigen::Matrix4d::Zero();
        E(i, j) = E(j, i) = 1.0;
        entries_[static_cast<std::size_t>(k)] = E;
        parameters_.col(k) = from_pseudo_inertia(unit.asDiagonal() * E * unit.asDiagonal()).values;
      }
    }
    const Eigen::VectorXd root = p.W.cwiseSqrt();
    A_ = root.asDiagonal() * p.Y;
    for (Eigen::Index l = 0; l < links_; ++l) {
      A_.middleCols<10>(10 * l) = (A_.middleCols<10>(10 * l) * parameters_).eval();
    }
    b_ = root.cwiseProduct(p.F);
    AtA_ = A_.transpose() * A_;
  }

  [[nodiscard]] double size() const { return b_.squaredNorm(); }
  /// What the barrier leaves open at its minimum, over mu.
  [[nodiscard]] double order() const { return 4.0 * static_cast<double>(links_); }
  [[nodiscard]] double data(const Eigen::VectorXd& s) const { return (A_ * s - b_).squaredNorm(); }

  [[nodiscard]] Eigen::VectorXd start() const {
    Eigen::VectorXd s(10 * links_);
    for (Eigen::Index l = 0; l < links_; ++l) s.segment<10>(10 * l) = entries_of_unit();
    return s;
  }

  [[nodiscard]] Eigen::VectorXd Phi(const Eigen::VectorXd& s) const {
    Eigen::VectorXd Phi(s.size());
    for (Eigen::Index l = 0; l < links_; ++l) {
      Phi.segment<10>(10 * l) = parameters_ * s.segment<10>(10 * l);
    }
    return Phi;
  }

  /// Newton's method from s; false if it stalls before the minimum is near enough for its residual
  /// to be dual feasible.
  bool descend(Eigen::VectorXd& s, double mu) const {
    constexpr int most_steps = 60;
    constexpr double near_enough = 1e-2;  // squared, in the barrier's own metric; 1 suffices
    for (int step = 0; step < most_steps; ++step) {
      Eigen::VectorXd slope = 2.0 * (A_.transpose() * (A_ * s - b_));
      Eigen::MatrixXd H = 2.0 * AtA_;
      double rest = largest_trace;
      Eigen::VectorXd traces = Eigen::VectorXd::Zero(s.size());
      for (Eigen::Index l = 0; l < links_; ++l) {
        const Eigen::Matrix4d P = sigma(s, l).inverse();
        for (int k = 0; k < 10; ++k) {
          const Eigen::Matrix4d PE = P * entries_[static_cast<std::size_t>(k)];
          slope[10 * l + k] -= mu * PE.trace();
          for (int j = 0; j < 10; ++j) {
            H(10 * l + k, 10 * l + j) +=
                mu * (PE * P * entries_[static_cast<std::size_t>(j)]).trace();
          }
        }
        traces.segment<10>(10 * l) = entries_of_unit();
        rest -= sigma(s, l).trace();
      }
      slope += mu / rest * traces;
      H += mu / (rest * rest) * traces * traces.transpose();
      const Eigen::VectorXd move = -H.ldlt().solve(slope);
      const double decrement = -slope.dot(move);
      if (!std::isfinite(decrement)) return false;
      double length = 1.0;
      const double here = *value(s, mu);
      for (;; length *= 0.5) {
        const auto there = value(s + length * move, mu);
        if (there && *there <= here - 0.1 * length * decrement) break;
        if (length < 1e-10) return decrement <= near_enough * mu;
      }
      s += length * move;
      if (decrement <= near_enough * mu) return true;
    }
    return false;
  }

 private:
  static constexpr double largest_trace = 1e6;  // kg: beyond any robot, in units of its size

  /// Entries of the unit matrix; also what the trace multiplies the entries with.
  static Vector10 entries_of_unit() {
    Vector10 s;
    s << 1, 0, 1, 0, 0, 1, 0, 0, 0, 1;
    return s;
  }

  [[nodiscard]] Eigen::Matrix4d sigma(const Eigen::VectorXd& s, Eigen::Index link) const {
    Eigen::Matrix4d Sigma = Eigen::Matrix4d::Zero();
    for (int k = 0; k < 10; ++k) Sigma += s[10 * link + k] * entries_[static_cast<std::size_t>(k)];
    return Sigma;
  }

  /// Empty outside of the cone.
  [[nodiscard]] std::optional<double> value(const Eigen::VectorXd& s, double mu) const {
    double logs = 0.0, rest = largest_trace;
    for (Eigen::Index l = 0; l < links_; ++l) {
      const Eigen::Matrix4d Sigma = sigma(s, l);
      const Eigen::LLT<Eigen::Matrix4d> factor(Sigma);
      if (factor.info() != Eigen::Success) return std::nullopt;
      const Eigen::Matrix4d L = factor.matrixL();
      logs += 2.0 * L.diagonal().array().log().sum();
      rest -= Sigma.trace();
    }
    if (!(rest > 0.0)) return std::nullopt;
    return data(s) - mu * (logs + std::log(rest));
  }

  Eigen::Index links_;
  std::array<Eigen::Matrix4d, 10> entries_;
  Matrix10 parameters_;  ///< Phi of a link from its entries
  Eigen::MatrixXd A_, AtA_;
  Eigen::VectorXd b_;
};

}  // namespace

Guess least_over_masses(const StatedProblem& stated) {
  if (stated.others.values.cols() > 0 || stated.masses.Y.cols() == 0) return {};
  // What the other nine parameters of each link can explain is taken out; masses remain.
  const MassProblem& p = stated.masses;
  const Eigen::Index links = p.Y.cols() / 10;
  const Eigen::VectorXd root = p.W.cwiseSqrt();
  const Eigen::MatrixXd A = root.asDiagonal() * p.Y;
  const Eigen::VectorXd b = root.cwiseProduct(p.F);
  Eigen::MatrixXd rest(A.rows(), 9 * links);
  for (Eigen::Index l = 0; l < links; ++l) {
    rest.middleCols<9>(9 * l) = A.middleCols<9>(10 * l + 1);
  }
  const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> without(rest);
  const auto remains = [&](const Eigen::VectorXd& v) -> Eigen::VectorXd {
    return v - rest * without.solve(v);
  };
  MassProblem masses;
  masses.Y.setZero(A.rows(), 10 * links);
  masses.U.setZero(10 * links, links);
  for (Eigen::Index l = 0; l < links; ++l) {
    masses.Y.col(10 * l) = remains(A.col(10 * l));
    masses.U(10 * l, l) = 1.0;
  }
  masses.F = remains(b);
  masses.W = Eigen::VectorXd::Ones(A.rows());
  masses.V = Eigen::VectorXd::Ones(links);
  Guess guess{reference::solve_masses(masses).Phi, {}};
  const Eigen::VectorXd others = without.solve(b - A * guess.parameters);
  for (Eigen::Index l = 0; l < links; ++l) {
    guess.parameters.segment<9>(10 * l + 1) = others.segment<9>(9 * l);
  }
  return guess;
}

std::vector<Guess> path_to_least_over_bodies(const StatedProblem& stated) {
  if (stated.others.values.cols() > 0 || stated.masses.Y.cols() == 0) return {};
  const Barrier barrier(stated.masses);
  constexpr double shrink = 0.1, gap = 1e-9, least = 1e-18;
  Eigen::VectorXd s = barrier.start();
  std::vector<Guess> path;
  double mu = barrier.size() / barrier.order();
  while (mu > least * barrier.size()) {
    if (!barrier.descend(s, mu)) break;
    path.push_back({barrier.Phi(s), {}});
    if (mu * barrier.order() < gap * barrier.data(s)) break;
    mu *= shrink;
  }
  return path;
}

Guess least_over_bodies(const StatedProblem& stated) {
  const std::vector<Guess> path = path_to_least_over_bodies(stated);
  for (auto guess = path.rbegin(); guess != path.rend(); ++guess) {
    if (certificate::floor_of_bodies(stated, guess->parameters, guess->others)) return *guess;
  }
  return path.empty() ? Guess{} : path.back();
}

}  // namespace shapeid::app
