#include "shapeid/proofs/certificate/cone.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "shapeid/proofs/certificate/linear.hpp"

namespace shapeid::certificate {
namespace {

using Places = std::vector<std::size_t>;

/// Rows and columns that have to do with one another: one link, unless columns couple links.
struct Block {
  Places rows, columns;
};

std::vector<Block> blocks(const Eigen::MatrixXd& U) {
  const auto links = static_cast<std::size_t>(U.rows() / 10);
  Places group(links);
  for (std::size_t l = 0; l < links; ++l) group[l] = l;
  std::vector<std::size_t> link_of(static_cast<std::size_t>(U.cols()), links);
  for (Eigen::Index j = 0; j < U.cols(); ++j) {
    std::size_t& own = link_of[static_cast<std::size_t>(j)];
    for (Eigen::Index i = 0; i < U.rows(); ++i) {
      if (U(i, j) == 0.0) continue;
      const auto link = static_cast<std::size_t>(i / 10);
      if (own == links) own = link;
      // By value: what is replaced lies in the range.
      const std::size_t from = group[link], to = group[own];
      std::replace(group.begin(), group.end(), from, to);
    }
  }
  std::vector<Block> found(links);
  for (std::size_t l = 0; l < links; ++l) {
    for (std::size_t i = 0; i < 10; ++i) found[group[l]].rows.push_back(10 * l + i);
  }
  for (std::size_t j = 0; j < link_of.size(); ++j) {
    if (link_of[j] < links) found[group[link_of[j]]].columns.push_back(j);
  }
  return found;
}

/// min over m >= 0 of || B m - b ||^2, by columns.
class NonnegativeLeastSquares {
 public:
  NonnegativeLeastSquares(std::vector<Vector> B, Vector b) : B_(std::move(B)), b_(std::move(b)) {
    m_.resize(B_.size());
    rest_ = b_;
  }

  const Vector& solve() {
    while (const auto j = entering()) {
      passive_.push_back(*j);
      move_to_target();
    }
    return m_;
  }

  /// b - B m
  [[nodiscard]] const Vector& rest() const { return rest_; }

 private:
  /// The column that reduces the distance fastest; empty at the minimum.
  [[nodiscard]] std::optional<std::size_t> entering() const {
    std::optional<std::size_t> best;
    Rational steepest;
    for (std::size_t j = 0; j < B_.size(); ++j) {
      if (std::find(passive_.begin(), passive_.end(), j) != passive_.end()) continue;
      const Rational slope = dot(B_[j], rest_);
      if (slope <= steepest) continue;
      steepest = slope;
      best = j;
    }
    return best;
  }

  void move_to_target() {
    for (;;) {
      const Vector target = least_squares();
      std::optional<Rational> step;
      for (std::size_t k = 0; k < passive_.size(); ++k) {
        if (sgn(target[k]) > 0) continue;
        const Rational& mass = m_[passive_[k]];
        const Rational until = mass / (mass - target[k]);
        if (!step || until < *step) step = until;
      }
      for (std::size_t k = 0; k < passive_.size(); ++k) {
        Rational& mass = m_[passive_[k]];
        mass = step ? Rational(mass + *step * (target[k] - mass)) : target[k];
      }
      if (!step) break;
      std::erase_if(passive_, [&](std::size_t j) { return sgn(m_[j]) == 0; });
    }
    rest_ = b_;
    for (const std::size_t j : passive_) {
      for (std::size_t i = 0; i < rest_.size(); ++i) rest_[i] -= B_[j][i] * m_[j];
    }
  }

  [[nodiscard]] Vector least_squares() const {
    std::vector<Vector> gram(passive_.size(), Vector(passive_.size()));
    Vector right(passive_.size());
    for (std::size_t k = 0; k < passive_.size(); ++k) {
      for (std::size_t l = 0; l < passive_.size(); ++l) {
        gram[k][l] = dot(B_[passive_[k]], B_[passive_[l]]);
      }
      right[k] = dot(B_[passive_[k]], b_);
    }
    return certificate::solve(std::move(gram), std::move(right));
  }

  std::vector<Vector> B_;
  Vector b_, m_, rest_;
  Places passive_;
};

/// A power of two about as large as the largest entry of the row.
double unit_of_row(const Eigen::MatrixXd& U, std::size_t row) {
  if (U.cols() == 0) return 1.0;
  const double largest = U.row(static_cast<Eigen::Index>(row)).cwiseAbs().maxCoeff();
  return largest > 0.0 ? std::exp2(std::ilogb(largest)) : 1.0;
}

}  // namespace

NearestBody nearest_body(const MassProblem& p, const Eigen::VectorXd& Phi) {
  NearestBody nearest{Vector(static_cast<std::size_t>(p.U.cols())), 0,
                      Vector(static_cast<std::size_t>(p.U.rows()))};
  for (const Block& block : blocks(p.U)) {
    if (block.rows.empty()) continue;
    Vector units, b;
    for (const std::size_t i : block.rows) {
      units.push_back(exact(unit_of_row(p.U, i)));
      b.push_back(exact(Phi[static_cast<Eigen::Index>(i)]) / units.back());
    }
    std::vector<Vector> B;
    for (const std::size_t j : block.columns) {
      B.emplace_back();
      for (std::size_t k = 0; k < block.rows.size(); ++k) {
        const double u =
            p.U(static_cast<Eigen::Index>(block.rows[k]), static_cast<Eigen::Index>(j));
        B.back().emplace_back(exact(u) / units[k]);
      }
    }
    NonnegativeLeastSquares least(std::move(B), std::move(b));
    const Vector& m = least.solve();
    for (std::size_t k = 0; k < m.size(); ++k) nearest.m[block.columns[k]] = m[k];
    for (std::size_t k = 0; k < block.rows.size(); ++k) {
      nearest.plane[block.rows[k]] = -least.rest()[k] / units[k];
    }
    nearest.square_distance += dot(least.rest(), least.rest());
  }
  return nearest;
}

bool separates(const Vector& plane, const MassProblem& p, const Eigen::VectorXd& Phi) {
  for (Eigen::Index j = 0; j < p.U.cols(); ++j) {
    if (sgn(dot(plane, exact(Eigen::VectorXd(p.U.col(j))))) < 0) return false;
  }
  return sgn(dot(plane, exact(Phi))) < 0;
}

}  // namespace shapeid::certificate
