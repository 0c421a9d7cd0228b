#include "shapeid/diagnosis/fits.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <numeric>
#include <shared_mutex>
#include <tuple>
#include <utility>

namespace shapeid::diagnosis {

SumWithError sum_with_error(const Eigen::VectorXd& values) {
  const Eigen::Index n = values.size();
  if (n < 2) return {values.sum(), std::numeric_limits<double>::infinity()};
  const Eigen::VectorXd d = values.array() - values.mean();
  double variance = d.squaredNorm();
  // Newey and West (1987), Bartlett weights; anticorrelation is not allowed to shrink the error.
  constexpr Eigen::Index lags = 2;
  for (Eigen::Index lag = 1; lag <= std::min(lags, n - 1); ++lag) {
    const double weight = 1.0 - static_cast<double>(lag) / (lags + 1.0);
    variance += 2.0 * weight * std::max(0.0, d.head(n - lag).dot(d.tail(n - lag)));
  }
  variance *= static_cast<double>(n) / static_cast<double>(n - 1);
  return {values.sum(), std::sqrt(variance)};
}

Gain gain_of(const Eigen::VectorXd& before, const Eigen::VectorXd& after) {
  const Eigen::VectorXd difference = before - after;
  // A block that both fit without error tells nothing.
  const Eigen::ArrayXd sum = before + after;
  const Eigen::VectorXd relative = (sum > 0.0).select(difference.array() / sum, 0.0);
  return {difference.sum() / before.sum(),
          std::max(sum_with_error(difference).t(), sum_with_error(relative).t())};
}

double worth(double share) {
  return share < 1.0 ? share / (1.0 - share) : std::numeric_limits<double>::infinity();
}

Eigen::VectorXd wide_sizes(const Tally& tally) {
  constexpr double wide = 30.0;  // of a usual size
  std::vector<double> sizes;
  for (const AppliedEffect& hypothesis : tally.hypotheses) {
    for (const Parameter& parameter : hypothesis.effect->parameters) {
      sizes.push_back(wide * parameter.size);
    }
  }
  return Eigen::Map<const Eigen::VectorXd>(sizes.data(), std::ssize(sizes));
}

Eigen::ArrayXd errors_from_zero(const Eigen::VectorXd& value, const Eigen::VectorXd& error) {
  return (value.array() == 0.0).select(0.0, value.array() / error.array());
}

double squares_sum(const Fit& before, const Fit& after) {
  return after.left > 0.0 ? (before.left - after.left) / (after.left / after.freedom)
                          : std::numeric_limits<double>::infinity();
}

BlockFits::BlockFits(Tally tally, const Eigen::VectorXd& given, const Eigen::VectorXd& size,
                     int folds)
    : tally_(std::move(tally)) {
  const Eigen::Index p = tally_.columns();
  Eigen::VectorXd x = Eigen::VectorXd::Zero(p);
  x.head(tally_.inertial) = given;
  Eigen::VectorXd diagonal = Eigen::VectorXd::Zero(p);
  for (Block& block : tally_.blocks) {
    if (block.reference) ++first_block_;
    freedom_ += block.freedom;
    // F <- F - Y Phi_given
    Eigen::MatrixXd& G = block.sums;
    least_.push_back(least_share * least_share * G(p, p));
    const Eigen::VectorXd Gx = G.topLeftCorner(p, p) * x;
    G(p, p) += x.dot(Gx) - 2.0 * x.dot(G.col(p).head(p));
    G.col(p).head(p) -= Gx;
    G.row(p).head(p) = G.col(p).head(p).transpose();
    diagonal += G.diagonal().head(p);
  }
  scale_ = diagonal.cwiseSqrt();
  const double tiny = std::numeric_limits<double>::min();
  scale_ = (scale_.array() > tiny).select(scale_, 1.0);
  for (Block& block : tally_.blocks) {
    block.sums.topRows(p).array().colwise() /= scale_.array();
    block.sums.leftCols(p).array().rowwise() /= scale_.transpose().array();
  }
  Eigen::VectorXd sizes = Eigen::VectorXd::Constant(p, std::numeric_limits<double>::infinity());
  const Eigen::VectorXd wide = wide_sizes(tally_);
  sizes.head(tally_.inertial) = size;
  sizes.segment(tally_.inertial, wide.size()) = wide;
  precision_ = sizes.cwiseProduct(scale_).cwiseAbs2().cwiseInverse();
  assign_folds(folds);
}

void BlockFits::assign_folds(int stretches) {
  fold_.resize(tally_.blocks.size());
  // What differs from run to run, as warmth does, would be known to a fit that lacks a stretch of
  // one alone.
  constexpr int enough_logs = 3;
  int logs = 0;
  for (std::size_t b = first_block_; b < fold_.size(); ++b) {
    if (b == first_block_ || tally_.blocks[b].log != tally_.blocks[b - 1].log) ++logs;
    fold_[b] = logs - 1;
  }
  folds_ = logs;
  if (logs < enough_logs) {
    folds_ = std::clamp(stretches, 2, std::max(2, static_cast<int>(log_blocks())));
    deal_in_stretches(first_block_, fold_.size());
  }
  // What came and what went are known to a fit by the stretches of either log that it has.
  deal_in_stretches(0, first_block_);
}

void BlockFits::deal_in_stretches(std::size_t from, std::size_t to) {
  for (std::size_t b = from; b < to; ++b) {
    fold_[b] = static_cast<int>((b - from) * static_cast<std::size_t>(folds_) / (to - from));
  }
}

void BlockFits::limit_to_time_of(const AppliedEffect& effect, Term& term) const {
  if (!effect.acts_in_reference()) term.from_block = std::max(term.from_block, first_block_);
  if (!effect.acts_in_log()) term.to_block = std::min(term.to_block, first_block_);
}

double BlockFits::square_of_noise(double error) const { return error / std::max(1.0, freedom_); }

int BlockFits::fold_of(std::size_t block) const { return fold_[block]; }

const Eigen::MatrixXd& BlockFits::sums(int left_out, std::size_t from, std::size_t to) const {
  const std::tuple key{left_out, from, to};
  {
    const std::shared_lock lock(cache_->mutex);
    const auto place = cache_->sums.find(key);
    if (place != cache_->sums.end()) return place->second;
  }
  const std::unique_lock lock(cache_->mutex);
  const auto [place, is_new] = cache_->sums.try_emplace(key);
  if (is_new) {
    const Eigen::Index size = tally_.columns() + 1;
    place->second = Eigen::MatrixXd::Zero(size, size);
    for (std::size_t b = from; b < to; ++b) {
      if (left_out < 0 || fold_of(b) != left_out) place->second += tally_.blocks[b].sums;
    }
  }
  return place->second;
}

double BlockFits::sum_between(int left_out, std::size_t from, std::size_t to, Eigen::Index i,
                              Eigen::Index j) const {
  const std::size_t last = tally_.blocks.size();
  to = std::min(to, last);
  // Sums of a log, or of both, are asked for many times, those from a load's moment on seldom.
  const bool starts = from == 0 || from == first_block_;
  const bool ends = to == last || to == first_block_;
  if (starts && ends && from < to) return sums(left_out, from, to)(i, j);
  double sum = 0.0;
  for (std::size_t b = from; b < to; ++b) {
    if (left_out < 0 || fold_of(b) != left_out) sum += tally_.blocks[b].sums(i, j);
  }
  return sum;
}

BlockFits::Columns BlockFits::listed(const std::vector<Term>& terms) {
  Columns list;
  for (const Term& term : terms) {
    list.index.insert(list.index.end(), term.columns.begin(), term.columns.end());
    list.from.insert(list.from.end(), term.columns.size(), term.from_block);
    list.to.insert(list.to.end(), term.columns.size(), term.to_block);
  }
  return list;
}

Eigen::MatrixXd BlockFits::normal(const Columns& a, const Columns& b, int left_out) const {
  const std::size_t last = tally_.blocks.size();
  const auto at_once = [last](const Columns& list) {
    return std::ranges::all_of(list.from, [](std::size_t f) { return f == 0; }) &&
           std::ranges::all_of(list.to, [last](std::size_t t) { return t >= last; });
  };
  const Eigen::MatrixXd& all = sums(left_out, 0, last);
  if (at_once(a) && at_once(b)) return all(a.index, b.index);
  Eigen::MatrixXd N(a.count(), b.count());
  for (Eigen::Index j = 0; j < b.count(); ++j) {
    for (Eigen::Index i = 0; i < a.count(); ++i) {
      const auto ui = static_cast<std::size_t>(i), uj = static_cast<std::size_t>(j);
      const std::size_t from = std::max(a.from[ui], b.from[uj]);
      const std::size_t to = std::min(a.to[ui], b.to[uj]);
      N(i, j) = from == 0 && to >= last ? all(a.index[ui], b.index[uj])
                                        : sum_between(left_out, from, to, a.index[ui], b.index[uj]);
    }
  }
  return N;
}

Eigen::VectorXd BlockFits::target(const Columns& a, int left_out) const {
  const Eigen::Index F = tally_.columns();
  Eigen::VectorXd g(a.count());
  for (Eigen::Index i = 0; i < a.count(); ++i) {
    const auto u = static_cast<std::size_t>(i);
    g[i] = sum_between(left_out, a.from[u], a.to[u], a.index[u], F);
  }
  return g;
}

Eigen::VectorXd BlockFits::ridge(const Columns& a) const {
  Eigen::VectorXd r(a.count());
  for (Eigen::Index i = 0; i < a.count(); ++i) {
    const Eigen::Index column = a.index[static_cast<std::size_t>(i)];
    // What strengthens the prior of inertias must not freeze effects.
    r[i] = regularity + (column < tally_.inertial ? prior_ : 1.0) * precision_[column];
  }
  return r;
}

Eigen::LDLT<Eigen::MatrixXd> BlockFits::factored(const Columns& a, int left_out) const {
  Eigen::MatrixXd N = normal(a, a, left_out);
  N.diagonal() += ridge(a);
  return N.ldlt();
}

Eigen::VectorXd BlockFits::solve(const Columns& a, int left_out) const {
  return factored(a, left_out).solve(target(a, left_out));
}

/// G (x, -1) in the rows of the listed columns and of F; columns that are not active yet count as
/// zero.
Eigen::VectorXd BlockFits::gradient_on(const Columns& a, const Eigen::VectorXd& x,
                                       std::size_t block) const {
  const Eigen::MatrixXd& G = tally_.blocks[block].sums;
  std::vector<Eigen::Index> index = a.index;
  index.push_back(tally_.columns());
  Eigen::VectorXd full(a.count() + 1);
  full << x, -1.0;
  for (Eigen::Index i = 0; i < a.count(); ++i) {
    if (!a.acts(i, block)) full[i] = 0.0;
  }
  return G(index, index) * full;
}

double BlockFits::error_on(const Columns& a, const Eigen::VectorXd& x, std::size_t block) const {
  return error_of(a, x, block, gradient_on(a, x, block));
}

double BlockFits::error_of(const Columns& a, const Eigen::VectorXd& x, std::size_t block,
                           const Eigen::VectorXd& gradient) {
  double error = -gradient[a.count()];
  for (Eigen::Index i = 0; i < a.count(); ++i) {
    if (a.acts(i, block)) error += x[i] * gradient[i];
  }
  return error;
}

Eigen::VectorXd BlockFits::above_rounding(Eigen::VectorXd errors) const {
  for (Eigen::Index b = 0; b < errors.size(); ++b) {
    errors[b] = std::max(errors[b], least_[static_cast<std::size_t>(b)]);
  }
  return errors;
}

Fit BlockFits::fit(const std::vector<Term>& terms) const {
  const Columns a = listed(terms);
  const Eigen::LDLT<Eigen::MatrixXd> factor = factored(a, -1);
  const Eigen::VectorXd x = factor.solve(target(a, -1));

  const auto count = static_cast<Eigen::Index>(tally_.blocks.size());
  double left = 0.0;
  Eigen::MatrixXd scores = Eigen::MatrixXd::Zero(a.count(), count);
  for (Eigen::Index b = 0; b < count; ++b) {
    const auto block = static_cast<std::size_t>(b);
    const Eigen::VectorXd g = gradient_on(a, x, block);
    left += error_of(a, x, block, g);
    for (Eigen::Index i = 0; i < a.count(); ++i) {
      if (a.acts(i, block)) scores(i, b) = g[i];
    }
  }
  left = std::max(left, std::accumulate(least_.begin(), least_.end(), 0.0));
  const Eigen::MatrixXd influence = factor.solve(scores);
  Fit fit{x,
          {},
          Eigen::VectorXd(a.count()),
          left,
          std::max(1.0, freedom_ - static_cast<double>(a.count()))};
  fit.standard_error = errors_of_independent_noise(a, factor, left / fit.freedom);
  for (Eigen::Index i = 0; i < a.count(); ++i) {
    const double s = scale_[a.index[static_cast<std::size_t>(i)]];
    fit.value[i] /= s;
    fit.between_blocks[i] = sum_with_error(influence.row(i).transpose()).error / s;
    fit.standard_error[i] = std::max(fit.standard_error[i] / s, fit.between_blocks[i]);
  }
  return fit;
}

/// Of a fit to rows whose noise has one variance and is independent but for the filter.
Eigen::VectorXd BlockFits::errors_of_independent_noise(const Columns& a,
                                                       const Eigen::LDLT<Eigen::MatrixXd>& factor,
                                                       double variance) const {
  // The prior's part of N holds a number, and moves with no noise: N^-1 (N - R) N^-1.
  const Eigen::MatrixXd inverse = factor.solve(Eigen::MatrixXd::Identity(a.count(), a.count()));
  const Eigen::VectorXd data = inverse.diagonal() - inverse.cwiseAbs2().transpose() * ridge(a);
  return (variance * data.array().max(0.0)).sqrt();
}

Eigen::VectorXd BlockFits::held_out(const std::vector<Term>& terms) const {
  const Columns a = listed(terms);
  Eigen::VectorXd errors(blocks());
  int fold = -1;
  Eigen::VectorXd x;
  for (Eigen::Index b = 0; b < blocks(); ++b) {
    const auto block = static_cast<std::size_t>(b);
    if (fold_of(block) != fold) {
      fold = fold_of(block);
      x = solve(a, fold);
    }
    errors[b] = error_on(a, x, block);
  }
  return above_rounding(std::move(errors));
}

Eigen::VectorXd BlockFits::given_error() const {
  Eigen::VectorXd errors(blocks());
  for (Eigen::Index b = 0; b < blocks(); ++b) {
    const Eigen::Index p = tally_.columns();
    errors[b] = tally_.blocks[static_cast<std::size_t>(b)].sums(p, p);
  }
  return errors;
}

std::vector<BlockFits::Promise> BlockFits::promises(const std::vector<Term>& terms,
                                                    const std::vector<Term>& candidates) const {
  const Columns a = listed(terms);
  // How much of a candidate the masses contain is asked of the data alone.
  const Eigen::LDLT<Eigen::MatrixXd> bare(
      normal(a, a, -1) + regularity * Eigen::MatrixXd::Identity(a.count(), a.count()));
  const Eigen::LDLT<Eigen::MatrixXd> factor = factored(a, -1);
  const Eigen::VectorXd x = factor.solve(target(a, -1));
  std::vector<Promise> promises;
  for (const Term& candidate : candidates) {
    const Columns c = listed({candidate});
    const Eigen::MatrixXd B = normal(a, c, -1);
    const Eigen::MatrixXd C = normal(c, c, -1);
    Eigen::MatrixXd schur = C - B.transpose() * factor.solve(B);
    schur.diagonal() += ridge(c);
    const Eigen::VectorXd g = target(c, -1) - B.transpose() * x;
    const double left = (C - B.transpose() * bare.solve(B)).trace();
    promises.push_back({g.dot(schur.ldlt().solve(g)), left / std::max(C.trace(), regularity)});
  }
  return promises;
}

std::vector<Eigen::MatrixXd> BlockFits::moves(const std::vector<Term>& terms,
                                              const std::vector<Term>& candidates) const {
  const Columns a = listed(terms);
  const Eigen::LDLT<Eigen::MatrixXd> factor = factored(a, -1);
  const Eigen::VectorXd unit = scale_(a.index).cwiseInverse();
  std::vector<Eigen::MatrixXd> moves;
  for (const Term& candidate : candidates) {
    const Columns c = listed({candidate});
    moves.push_back(unit.asDiagonal() * factor.solve(normal(a, c, -1)) *
                    scale_(c.index).asDiagonal());
  }
  return moves;
}

BlockFits::Beside BlockFits::beside(const std::vector<Term>& terms, const Term& candidate) const {
  const Columns a = listed(terms), c = listed({candidate});
  const Eigen::LDLT<Eigen::MatrixXd> factor = factored(a, -1);
  const Eigen::MatrixXd B = normal(a, c, -1);
  const Eigen::VectorXd unit = scale_(c.index);
  return {
      unit.asDiagonal() * (normal(c, c, -1) - B.transpose() * factor.solve(B)) * unit.asDiagonal(),
      unit.cwiseProduct(target(c, -1) - B.transpose() * factor.solve(target(a, -1)))};
}

SumWithError BlockFits::along(const std::vector<Term>& terms, const Term& candidate,
                              const Eigen::VectorXd& numbers) const {
  std::vector<Term> all = terms;
  all.push_back(candidate);
  const Columns a = listed(terms), c = listed({candidate}), both = listed(all);
  const Eigen::VectorXd direction = scale_(c.index).cwiseProduct(numbers);
  const Eigen::LDLT<Eigen::MatrixXd> factor = factored(a, -1);
  const Eigen::VectorXd B = normal(a, c, -1) * direction;
  const Eigen::VectorXd moved = factor.solve(B);
  const double own = direction.dot(normal(c, c, -1) * direction) - B.dot(moved);
  if (!(own > 0.0)) return {};
  const double size = (direction.dot(target(c, -1)) - moved.dot(target(a, -1))) / own;
  Eigen::VectorXd x(both.count());
  x << factor.solve(target(a, -1) - B * size), direction * size;
  Eigen::VectorXd influence(std::ssize(tally_.blocks));
  for (Eigen::Index b = 0; b < influence.size(); ++b) {
    const auto block = static_cast<std::size_t>(b);
    Eigen::VectorXd g = gradient_on(both, x, block).head(both.count());
    for (Eigen::Index i = 0; i < both.count(); ++i) {
      if (!both.acts(i, block)) g[i] = 0.0;
    }
    influence[b] = (direction.dot(g.tail(c.count())) - moved.dot(g.head(a.count()))) / own;
  }
  return {size, sum_with_error(influence).error};
}

Eigen::Index BlockFits::numbers_shown(const Term& term) const {
  const Columns c = listed({term});
  const Eigen::MatrixXd N = normal(c, c, -1);
  const Eigen::ArrayXd length = N.diagonal().cwiseMax(0.0).cwiseSqrt();
  const Eigen::VectorXd unit = (length > 0.0).select(length.inverse(), 0.0);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(unit.asDiagonal() * N *
                                                             unit.asDiagonal());
  const Eigen::VectorXd& squares = eigen.eigenvalues();
  const double rounding = regularity * static_cast<double>(N.rows());
  return std::max<Eigen::Index>(1, (squares.array() > rounding).count());
}

double BlockFits::contained(const std::vector<Term>& terms, const Term& inner,
                            const Term& outer) const {
  std::vector<Term> all = terms;
  const double free_before = promises(all, {inner}).front().free_share;
  all.push_back(outer);
  const double free_after = promises(all, {inner}).front().free_share;
  return free_before > 0.0 ? 1.0 - free_after / free_before : 1.0;
}

}  // namespace shapeid::diagnosis
