#include "shapeid/diagnosis/fits_around.hpp"

#include <utility>

namespace shapeid::diagnosis {

FitsAround::FitsAround(const BlockFits& fits, std::vector<Term> terms)
    : fits_(fits), terms_(std::move(terms)), columns_(BlockFits::listed(terms_)) {
  for (int fold = 0; fold < fits_.folds(); ++fold) add_fold(fold);
  for (std::size_t b = 0; b < fits_.tally().blocks.size(); ++b) add_block(b);
  std::vector<Eigen::VectorXd> answers;
  for (const Fold& fold : folds_) answers.push_back(fold.x);
  error_ = fits_.above_rounding(errors_of(answers));
}

void FitsAround::add_fold(int fold) {
  Eigen::MatrixXd N = fits_.normal(columns_, columns_, fold);
  N.diagonal() += fits_.ridge(columns_);
  Fold& result = folds_.emplace_back(Fold{Eigen::LDLT<Eigen::MatrixXd>(N), {}});
  result.x = result.factor.solve(fits_.target(columns_, fold));
}

void FitsAround::add_block(std::size_t block) {
  std::vector<Eigen::Index> index = columns_.index;
  index.push_back(fits_.tally().columns());
  Eigen::MatrixXd& H = blocks_.emplace_back(fits_.tally().blocks[block].sums(index, index));
  for (Eigen::Index i = 0; i < columns_.count(); ++i) {
    if (columns_.acts(i, block)) continue;
    H.row(i).setZero();
    H.col(i).setZero();
  }
}

Eigen::VectorXd FitsAround::errors_of(const std::vector<Eigen::VectorXd>& answers) const {
  Eigen::VectorXd errors(fits_.blocks());
  Eigen::VectorXd full(columns_.count() + 1);
  for (Eigen::Index b = 0; b < errors.size(); ++b) {
    const auto at = static_cast<std::size_t>(b);
    full << answers[static_cast<std::size_t>(fits_.fold_of(at))], -1.0;
    errors[b] = full.dot(blocks_[at] * full);
  }
  return errors;
}

Eigen::VectorXd FitsAround::without(std::size_t term) const {
  return fixed_at(term, Eigen::VectorXd::Zero(std::ssize(terms_[term].columns)));
}

Eigen::VectorXd FitsAround::fixed_at(std::size_t term, const Eigen::VectorXd& value) const {
  Eigen::Index first = 0;
  for (std::size_t i = 0; i < term; ++i) first += std::ssize(terms_[i].columns);
  const Eigen::Index n = std::ssize(terms_[term].columns);
  const Eigen::VectorXd scaled = value.cwiseProduct(fits_.scale_(terms_[term].columns));
  const Eigen::MatrixXd unit =
      Eigen::MatrixXd::Identity(columns_.count(), columns_.count()).middleCols(first, n);
  std::vector<Eigen::VectorXd> answers;
  for (const Fold& fold : folds_) {
    // The answer moves along these columns of the inverse until the term's numbers are these.
    const Eigen::MatrixXd along = fold.factor.solve(unit);
    const Eigen::VectorXd step =
        along.middleRows(first, n).ldlt().solve(fold.x.segment(first, n) - scaled);
    Eigen::VectorXd& x = answers.emplace_back(fold.x - along * step);
    x.segment(first, n) = scaled;
  }
  return fits_.above_rounding(errors_of(answers));
}

Eigen::VectorXd FitsAround::with(const Term& more) const {
  const BlockFits::Columns added = BlockFits::listed({more});
  const Eigen::Index n = added.count();
  std::vector<Eigen::VectorXd> answers, steps;
  for (std::size_t k = 0; k < folds_.size(); ++k) {
    const Fold& fold = folds_[k];
    const int left_out = static_cast<int>(k);
    const Eigen::MatrixXd B = fits_.normal(columns_, added, left_out);
    const Eigen::MatrixXd back = fold.factor.solve(B);
    Eigen::MatrixXd schur = fits_.normal(added, added, left_out) - B.transpose() * back;
    schur.diagonal() += fits_.ridge(added);
    steps.emplace_back(schur.ldlt().solve(fits_.target(added, left_out) - B.transpose() * fold.x));
    answers.emplace_back(fold.x - back * steps.back());
  }
  Eigen::VectorXd errors = errors_of(answers);
  Eigen::VectorXd full(columns_.count() + 1);
  std::vector<Eigen::Index> index = columns_.index;
  index.push_back(fits_.tally().columns());
  for (Eigen::Index b = 0; b < errors.size(); ++b) {
    const auto block = static_cast<std::size_t>(b);
    if (block < more.from_block || block >= more.to_block) continue;
    const auto fold = static_cast<std::size_t>(fits_.fold_of(block));
    full << answers[fold], -1.0;
    for (Eigen::Index i = 0; i < columns_.count(); ++i) {
      if (!columns_.acts(i, block)) full[i] = 0.0;
    }
    const Eigen::MatrixXd& G = fits_.tally().blocks[block].sums;
    const Eigen::VectorXd& step = steps[fold];
    for (Eigen::Index p = 0; p < n; ++p) {
      const auto column = G.col(added.index[static_cast<std::size_t>(p)]);
      double along = 0.0;
      for (Eigen::Index i = 0; i < full.size(); ++i) {
        along += column[index[static_cast<std::size_t>(i)]] * full[i];
      }
      for (Eigen::Index o = 0; o < n; ++o) {
        along += 0.5 * column[added.index[static_cast<std::size_t>(o)]] * step[o];
      }
      errors[b] += 2.0 * step[p] * along;
    }
  }
  return fits_.above_rounding(std::move(errors));
}

}  // namespace shapeid::diagnosis
