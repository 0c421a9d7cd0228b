#include "shapeid/tests/certificate/oracle.hpp"

#include <cmath>
#include <optional>
#include <stdexcept>

namespace shapeid::test {
namespace {

using Numbers = std::vector<mpq_class>;

/// 1/2 v^T H v - h^T v + k, with every unknown's bounds: f of all unknowns together. The first
/// `masses` of them add up to no more than `most`, if there is such a bound.
struct Quadratic {
  std::vector<Numbers> H;
  Numbers h;
  mpq_class k;
  std::vector<std::optional<mpq_class>> lower, upper;
  std::size_t masses;
  std::optional<mpq_class> most;

  [[nodiscard]] mpq_class sum_of_masses(const Numbers& v) const {
    mpq_class sum;
    for (std::size_t i = 0; i < masses; ++i) sum += v[i];
    return sum;
  }
  [[nodiscard]] mpq_class at(const Numbers& v) const {
    mpq_class value = k;
    for (std::size_t i = 0; i < v.size(); ++i) {
      for (std::size_t j = 0; j < v.size(); ++j) value += v[i] * H[i][j] * v[j] / 2;
      value -= h[i] * v[i];
    }
    return value;
  }
};

Quadratic quadratic(const StatedProblem& p) {
  const MassProblem& q = p.masses;
  const Eigen::Index n = q.shapes(), k = p.others.values.cols();
  std::vector<Numbers> A;  // rows of [Y U, C]
  for (Eigen::Index i = 0; i < q.Y.rows(); ++i) {
    Numbers row;
    for (Eigen::Index j = 0; j < n; ++j) {
      mpq_class entry;
      for (Eigen::Index l = 0; l < q.Y.cols(); ++l) {
        entry += mpq_class(q.Y(i, l)) * mpq_class(q.U(l, j));
      }
      row.push_back(entry);
    }
    for (Eigen::Index j = 0; j < k; ++j) row.emplace_back(p.others.values(i, j));
    A.push_back(row);
  }
  const auto size = static_cast<std::size_t>(n + k);
  Quadratic f{std::vector<Numbers>(size, Numbers(size)),
              Numbers(size),
              0,
              {},
              {},
              static_cast<std::size_t>(n),
              std::nullopt};
  if (q.mass_bound > 0.0) f.most = q.mass_bound;
  for (std::size_t r = 0; r < A.size(); ++r) {
    const mpq_class W(q.W[static_cast<Eigen::Index>(r)]), F(q.F[static_cast<Eigen::Index>(r)]);
    for (std::size_t i = 0; i < size; ++i) {
      for (std::size_t j = 0; j < size; ++j) f.H[i][j] += 2 * W * A[r][i] * A[r][j];
      f.h[i] += 2 * W * A[r][i] * F;
    }
    f.k += W * F * F;
  }
  for (Eigen::Index j = 0; j < n; ++j) {
    const auto i = static_cast<std::size_t>(j);
    f.H[i][i] += 2 * mpq_class(q.lambda) / mpq_class(q.V[j]);
    f.lower.emplace_back(0);
    f.upper.emplace_back();
  }
  const auto bound = [](double b) {
    return std::isfinite(b) ? std::optional<mpq_class>(b) : std::nullopt;
  };
  for (Eigen::Index j = 0; j < k; ++j) {
    f.lower.push_back(bound(p.others.lower[j]));
    f.upper.push_back(bound(p.others.upper[j]));
  }
  return f;
}

/// Solves the stationarity of the free unknowns, with the masses' sum free as well or at its bound;
/// false if it has no unique solution.
bool free_unknowns_solved(const Quadratic& f, const std::vector<bool>& free, bool at_most,
                          Numbers& v) {
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < v.size(); ++i) {
    if (free[i]) places.push_back(i);
  }
  std::vector<Numbers> T;
  for (const std::size_t i : places) {
    Numbers row;
    mpq_class right = f.h[i];
    for (std::size_t j = 0; j < v.size(); ++j) {
      if (!free[j]) right -= f.H[i][j] * v[j];
    }
    for (const std::size_t j : places) row.push_back(f.H[i][j]);
    if (at_most) row.emplace_back(i < f.masses ? 1 : 0);  // the multiplier's column
    row.push_back(right);
    T.push_back(row);
  }
  if (at_most) {  // masses that are not free are zero
    Numbers row;
    for (const std::size_t j : places) row.emplace_back(j < f.masses ? 1 : 0);
    row.emplace_back(0);
    row.push_back(*f.most);
    T.push_back(row);
  }
  for (std::size_t c = 0; c < T.size(); ++c) {
    std::size_t pivot = c;
    while (pivot < T.size() && T[pivot][c] == 0) ++pivot;
    if (pivot == T.size()) return false;
    std::swap(T[c], T[pivot]);
    for (std::size_t r = 0; r < T.size(); ++r) {
      if (r == c || T[r][c] == 0) continue;
      const mpq_class factor = T[r][c] / T[c][c];
      for (std::size_t j = c; j <= T.size(); ++j) T[r][j] -= factor * T[c][j];
    }
  }
  for (std::size_t c = 0; c < places.size(); ++c) v[places[c]] = T[c].back() / T[c][c];
  return true;
}

class Search {
 public:
  explicit Search(const Quadratic& f) : f_(f), v_(f.h.size()), free_(f.h.size(), false) {}

  std::optional<Numbers> run() {
    choose(0);
    return best_;
  }

 private:
  void choose(std::size_t i) {
    if (i == v_.size()) return consider();
    for (const auto& bound : {f_.lower[i], f_.upper[i]}) {
      if (!bound) continue;
      free_[i] = false;
      v_[i] = *bound;
      choose(i + 1);
    }
    free_[i] = true;
    choose(i + 1);
  }

  void consider() {
    consider(false);
    if (f_.most) consider(true);
  }

  void consider(bool at_most) {
    Numbers v = v_;
    if (!free_unknowns_solved(f_, free_, at_most, v)) return;
    if (f_.most && f_.sum_of_masses(v) > *f_.most) return;
    for (std::size_t i = 0; i < v.size(); ++i) {
      if ((f_.lower[i] && v[i] < *f_.lower[i]) || (f_.upper[i] && v[i] > *f_.upper[i])) return;
    }
    const mpq_class value = f_.at(v);
    if (best_ && value >= least_) return;
    least_ = value;
    best_ = v;
  }

  const Quadratic& f_;
  Numbers v_;
  std::vector<bool> free_;
  std::optional<Numbers> best_;
  mpq_class least_;
};

}  // namespace

mpq_class exact_objective(const StatedProblem& p, const Eigen::VectorXd& m,
                          const Eigen::VectorXd& x) {
  Numbers v;
  for (const double value : m) v.emplace_back(value);
  for (const double value : x) v.emplace_back(value);
  return quadratic(p).at(v);
}

ExactMinimum minimum_of_all_active_sets(const StatedProblem& p) {
  const Quadratic f = quadratic(p);
  const auto best = Search(f).run();
  if (!best) throw std::logic_error("free columns are dependent: no active set has a unique point");
  const auto n = static_cast<std::ptrdiff_t>(p.masses.shapes());
  return {f.at(*best), Numbers(best->begin(), best->begin() + n),
          Numbers(best->begin() + n, best->end())};
}

}  // namespace shapeid::test
