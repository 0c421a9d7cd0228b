#include "shapeid/diagnosis/body_sums.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <limits>
#include <utility>

#include "shapeid/diagnosis/fits.hpp"

namespace shapeid::diagnosis {
namespace {

// Effects have a prior so wide that it leaves a number that no data show at zero, and does nothing
// to any other (rotors of a hundred usual sizes are found here).
constexpr double wider = 1e4;

/// `G`: sums over [bodies, effects, F]. `precision`: of the effects' numbers before any data.
Eliminated eliminate(const Eigen::MatrixXd& G, Eigen::Index bodies,
                     const Eigen::VectorXd& precision) {
  const Eigen::Index effects = precision.size();
  Eigen::MatrixXd outer(bodies + 1, bodies + 1);
  outer.topLeftCorner(bodies, bodies) = G.topLeftCorner(bodies, bodies);
  outer.topRightCorner(bodies, 1) = G.topRightCorner(bodies, 1);
  outer.bottomLeftCorner(1, bodies) = G.bottomLeftCorner(1, bodies);
  outer(bodies, bodies) = G(G.rows() - 1, G.cols() - 1);
  Eigen::MatrixXd cross(effects, bodies + 1);
  cross << G.block(bodies, 0, effects, bodies), G.block(bodies, G.cols() - 1, effects, 1);
  Eliminated result{{}, Eigen::MatrixXd::Zero(effects, bodies + 1)};
  if (effects > 0) {
    Eigen::MatrixXd E = G.block(bodies, bodies, effects, effects);
    E.diagonal() = (1.0 + regularity) * E.diagonal() + precision;
    result.gain = E.ldlt().solve(cross);
    outer -= cross.transpose() * result.gain;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(outer);
  result.rows =
      eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal() * eigen.eigenvectors().transpose();
  return result;
}

}  // namespace

Eigen::VectorXd Eliminated::effects(const Eigen::VectorXd& Phi) const {
  Eigen::VectorXd x(Phi.size() + 1);
  x << -Phi, 1.0;
  return gain * x;
}

BodySums::BodySums(const BodyModel& shapes, Tally tally)
    : tally_(std::move(tally)),
      target_(tally_.columns()),
      linear_(tally_.columns() - tally_.inertial),
      links_(10 * std::ssize(shapes.free_links)) {
  const auto loads = std::count_if(tally_.hypotheses.begin(), tally_.hypotheses.end(),
                                   [](const AppliedEffect& a) { return a.effect->is_payload; });
  bodies_ = links_ + 10 * loads;
  precision_ = (wider * wide_sizes(tally_)).tail(effects()).cwiseAbs2().cwiseInverse();
  for (const int link : shapes.free_links) {
    for (Eigen::Index p = 0; p < 10; ++p) kept_.push_back(Eigen::Index{10} * link + p);
  }
  for (Eigen::Index e = 0; e <= linear_; ++e) kept_.push_back(tally_.inertial + e);
  known_ = Eigen::VectorXd::Zero(target_ + 1);
  known_.head(tally_.inertial) = shapes.known;
  for (Block& block : tally_.blocks) {
    reduce(block);
    if (block.reference) ++reference_blocks_;
  }
}

void BodySums::reduce(Block& block) const {
  Eigen::MatrixXd G = block.sums;
  const Eigen::Index F = target_;
  const Eigen::VectorXd Gx = G * known_;
  G(F, F) += known_.dot(Gx) - 2.0 * Gx[F];
  G.col(F).head(F) -= Gx.head(F);
  G.row(F).head(F) = G.col(F).head(F).transpose();
  block.sums = G(kept_, kept_);
  for (std::size_t k = 0; k < tally_.hypotheses.size(); ++k) {
    const AppliedEffect& effect = tally_.hypotheses[k];
    if (block.reference ? effect.acts_in_reference() : effect.acts_in_log()) continue;
    const Eigen::Index from = links_ + tally_.first[k] - tally_.inertial;
    const Eigen::Index n = tally_.hypotheses[k].value.size();
    block.sums.middleRows(from, n).setZero();
    block.sums.middleCols(from, n).setZero();
  }
}

int BodySums::tenth_of(std::size_t b) const {
  const std::size_t first = tally_.blocks[b].reference ? 0 : reference_blocks_;
  const std::size_t count =
      tally_.blocks[b].reference ? reference_blocks_ : tally_.blocks.size() - reference_blocks_;
  return static_cast<int>(tenths * (b - first) / count);
}

Eigen::MatrixXd BodySums::without(int tenth) const {
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(std::ssize(kept_), std::ssize(kept_));
  for (std::size_t b = 0; b < tally_.blocks.size(); ++b) {
    if (tenth_of(b) != tenth) sum += tally_.blocks[b].sums;
  }
  return sum;
}

Eliminated BodySums::rows_without(int tenth) const {
  return eliminate(without(tenth), bodies_, precision_);
}

std::vector<reference::RowBlock> BodySums::blocks(const Eigen::VectorXd& size) const {
  Eigen::VectorXd scale(std::ssize(kept_));
  scale << size, 1.0;
  std::vector<reference::RowBlock> list;
  for (const Block& block : tally_.blocks) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scale.asDiagonal() * block.sums *
                                                               scale.asDiagonal());
    const Eigen::VectorXd& squares = eigen.eigenvalues();
    const double rounding = static_cast<double>(squares.size()) *
                            std::numeric_limits<double>::epsilon() * squares.maxCoeff();
    const Eigen::VectorXd length = (squares.array() > rounding).select(squares, 0.0).cwiseSqrt();
    list.push_back({length.asDiagonal() * eigen.eigenvectors().transpose() *
                    scale.cwiseInverse().asDiagonal()});
  }
  return list;
}

Eigen::VectorXd BodySums::linear_sizes() const {
  const Eigen::MatrixXd G = without(-1);
  const double F = G(G.rows() - 1, G.cols() - 1);
  return (F / G.diagonal().segment(links_, linear_).array().max(1e-30 * F)).sqrt();
}

Eigen::ArrayXi BodySums::tenths_with_columns() const {
  Eigen::ArrayXXd squares = Eigen::ArrayXXd::Zero(linear_, tenths);
  for (std::size_t b = 0; b < tally_.blocks.size(); ++b) {
    squares.col(tenth_of(b)) += tally_.blocks[b].sums.diagonal().segment(links_, linear_).array();
  }
  constexpr double hardly_any = 1e-6;  // of all
  const Eigen::ArrayXd least = hardly_any * squares.rowwise().sum();
  return (squares > least.replicate(1, tenths)).cast<int>().rowwise().sum();
}

}  // namespace shapeid::diagnosis
