// Linear fits and their held-out errors, from sums alone.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <cstddef>
#include <limits>
#include <map>
#include <memory>
#include <shared_mutex>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "shapeid/diagnosis/tally.hpp"

namespace shapeid::diagnosis {

/// Relative to a column of unit length: keeps a factorisation regular where columns coincide, and
/// is far below what any noise leaves open.
inline constexpr double regularity = 1e-10;

/// Of the logged torque: no sensor is as good, and in sums of squares what is less is rounding.
inline constexpr double least_share = 1e-6;

/// Effects have a prior, too, so wide that it only matters where data say nothing: the standard
/// deviation of each number, all hypotheses one after the other.
[[nodiscard]] Eigen::VectorXd wide_sizes(const Tally& tally);

/// One hypothesis contains another if this share of its columns is in the other's span.
inline constexpr double nested_share = 0.9999;

/// Columns that enter a fit together, from a block on (a payload that comes late, a change since
/// the reference log) or up to one (what went since then).
struct Term {
  std::string id;
  std::vector<Eigen::Index> columns;
  std::vector<bool> nonnegative;  ///< one a column
  std::size_t from_block = 0;
  std::size_t to_block = std::numeric_limits<std::size_t>::max();  ///< the first without it
};

struct Fit {
  Eigen::VectorXd value;  ///< one a column of the terms, in their order
  /// By how it differs from block to block (cluster-robust, neighbours correlated); never less than
  /// that of noise that is independent but for the filter: blocks are few, and of a number that few
  /// of them determine they show too little scatter.
  Eigen::VectorXd standard_error;
  Eigen::VectorXd between_blocks;  ///< the former alone
  double left = 0.0;               ///< squared error of all blocks
  double freedom = 0.0;            ///< how many numbers the noise in that has
};

/// Standard errors by which each number differs from zero; none of one that is zero because no data
/// show it, whose error is zero, too.
[[nodiscard]] Eigen::ArrayXd errors_from_zero(const Eigen::VectorXd& value,
                                              const Eigen::VectorXd& error);

/// What a term took away of the squared error, `before` without and `after` with it, in squares of
/// independent noise: of nothing the sum of the squares of its numbers, normal ones.
[[nodiscard]] double squares_sum(const Fit& before, const Fit& after);

/// Sum with an error that allows for correlation of neighbours.
struct SumWithError {
  double sum = 0.0, error = 0.0;
  [[nodiscard]] double t() const { return error > 0.0 ? sum / error : 0.0; }
};
[[nodiscard]] SumWithError sum_with_error(const Eigen::VectorXd& values);

/// How much less squared error per block one fit has than another, and how sure that is. `t` is the
/// larger of two: of the differences, which a few violent blocks may drown, and of the differences
/// relative to each block's own error.
struct Gain {
  double share = 0.0, t = 0.0;
};
[[nodiscard]] Gain gain_of(const Eigen::VectorXd& before, const Eigen::VectorXd& after);
/// The squared error that comes back without what gains this share, in those of what is left.
[[nodiscard]] double worth(double share);

/// Fewer causes are taken for more unless these gain more than this many standard errors of the
/// difference.
inline constexpr double not_worse_t = 2.0;

class BlockFits {
 public:
  /// Unknown inertial parameters are deviations from `given` (10 per link), with a prior of zero
  /// mean and standard deviation `size` / sqrt(prior). Blocks are held out in `folds` contiguous
  /// groups; of three logs and more, in these.
  BlockFits(Tally tally, const Eigen::VectorXd& given, const Eigen::VectorXd& size, int folds);

  void set_prior(double prior) { prior_ = prior; }
  [[nodiscard]] double prior() const { return prior_; }
  [[nodiscard]] int folds() const { return folds_; }
  [[nodiscard]] const Tally& tally() const { return tally_; }
  /// The log's blocks; those before are of a reference log.
  [[nodiscard]] std::size_t first_block() const { return first_block_; }
  [[nodiscard]] Eigen::Index log_blocks() const {
    return static_cast<Eigen::Index>(tally_.blocks.size() - first_block_);
  }
  /// Of both logs: each is held out.
  [[nodiscard]] Eigen::Index blocks() const { return std::ssize(tally_.blocks); }
  /// The term counts in the blocks in which the effect acts, and no longer in others.
  void limit_to_time_of(const AppliedEffect& effect, Term& term) const;

  /// Of one number, where so much squared error is left in all blocks. What differs by less is no
  /// evidence, be it so in every block.
  [[nodiscard]] double square_of_noise(double error) const;

  /// All blocks in; deviations for inertial columns.
  [[nodiscard]] Fit fit(const std::vector<Term>& terms) const;
  /// Weighted squared error of every block, each predicted by the fit without its fold.
  [[nodiscard]] Eigen::VectorXd held_out(const std::vector<Term>& terms) const;
  /// The same without fitting: the given model.
  [[nodiscard]] Eigen::VectorXd given_error() const;

  /// How many of a term's numbers the log can show at all: its independent columns, at least 1. Of
  /// a load on a link that turns about one fixed axis these are three of ten.
  [[nodiscard]] Eigen::Index numbers_shown(const Term& term) const;

  /// How much one more term would lower the squared error of the fit of all blocks, roughly, and
  /// what share of the term's columns the others leave free: 0 for one that they already contain.
  struct Promise {
    double gain = 0.0, free_share = 0.0;
    /// The others say nearly the same: its numbers may be as large as they like.
    [[nodiscard]] bool hidden() const { return free_share < 1e-4; }
    /// The data cannot tell it from the others: that columns differ by a thousandth of their length
    /// is no evidence, for measured motion does not make them better than that. (Whether one
    /// hypothesis is in another's span is BlockFits::contained(), with nested_share.)
    [[nodiscard]] bool contained() const { return free_share < 1e-6; }
  };
  [[nodiscard]] std::vector<Promise> promises(const std::vector<Term>& terms,
                                              const std::vector<Term>& candidates) const;
  /// By how much the fitted numbers of the terms fall when one of a candidate's rises by one of its
  /// unit: for each candidate terms' columns x its own.
  [[nodiscard]] std::vector<Eigen::MatrixXd> moves(const std::vector<Term>& terms,
                                                   const std::vector<Term>& candidates) const;
  /// The normal equations of one more term's numbers, in their units, the others fitted along.
  struct Beside {
    Eigen::MatrixXd normal;  ///< of the data, without a prior of the term's own
    Eigen::VectorXd target;
  };
  [[nodiscard]] Beside beside(const std::vector<Term>& terms, const Term& candidate) const;
  /// How large a combination of a term's columns is beside the others, one being `numbers`, with
  /// its error between blocks.
  [[nodiscard]] SumWithError along(const std::vector<Term>& terms, const Term& candidate,
                                   const Eigen::VectorXd& numbers) const;
  /// Share of the columns of `inner` that lies in the span of `terms` and `outer`: 1 if nested.
  [[nodiscard]] double contained(const std::vector<Term>& terms, const Term& inner,
                                 const Term& outer) const;

 private:
  friend class FitsAround;
  struct Columns {
    std::vector<Eigen::Index> index;
    std::vector<std::size_t> from, to;
    [[nodiscard]] bool acts(Eigen::Index i, std::size_t block) const {
      const auto u = static_cast<std::size_t>(i);
      return block >= from[u] && block < to[u];
    }
    [[nodiscard]] Eigen::Index count() const { return std::ssize(index); }
  };
  [[nodiscard]] static Columns listed(const std::vector<Term>& terms);
  /// Of the blocks from one on up to another, but for those of a fold (-1: all).
  [[nodiscard]] const Eigen::MatrixXd& sums(int left_out, std::size_t from, std::size_t to) const;
  /// One entry of that.
  [[nodiscard]] double sum_between(int left_out, std::size_t from, std::size_t to, Eigen::Index i,
                                   Eigen::Index j) const;
  void assign_folds(int stretches);
  void deal_in_stretches(std::size_t from, std::size_t to);
  [[nodiscard]] int fold_of(std::size_t block) const;
  /// Normal matrix between two lists of columns over the blocks outside of a fold (-1: all in).
  [[nodiscard]] Eigen::MatrixXd normal(const Columns& a, const Columns& b, int left_out) const;
  [[nodiscard]] Eigen::VectorXd target(const Columns& a, int left_out) const;
  [[nodiscard]] Eigen::VectorXd ridge(const Columns& a) const;
  /// What is solved for the listed columns: their sums of squares, and the prior's.
  [[nodiscard]] Eigen::LDLT<Eigen::MatrixXd> factored(const Columns& a, int left_out) const;
  [[nodiscard]] Eigen::VectorXd solve(const Columns& a, int left_out) const;
  [[nodiscard]] Eigen::VectorXd errors_of_independent_noise(
      const Columns& a, const Eigen::LDLT<Eigen::MatrixXd>& factor, double variance) const;
  [[nodiscard]] Eigen::VectorXd gradient_on(const Columns& a, const Eigen::VectorXd& x,
                                            std::size_t block) const;
  [[nodiscard]] static double error_of(const Columns& a, const Eigen::VectorXd& x,
                                       std::size_t block, const Eigen::VectorXd& gradient);
  /// Squared errors of blocks as far as sums tell: of what cancels in them rounding is left.
  [[nodiscard]] Eigen::VectorXd above_rounding(Eigen::VectorXd errors) const;
  [[nodiscard]] double error_on(const Columns& a, const Eigen::VectorXd& x,
                                std::size_t block) const;

  Tally tally_;
  Eigen::VectorXd scale_;      ///< columns are divided by it
  Eigen::VectorXd precision_;  ///< of a prior of one, in scaled units
  double prior_ = 1.0;
  int folds_ = 2;
  std::vector<int> fold_;      ///< of each block
  std::vector<double> least_;  ///< squared error of each block that is told from none
  std::size_t first_block_ = 0;
  double freedom_ = 0.0;  ///< how many numbers the noise has
  /// Of sums(), for several threads; copies with another prior have the same.
  struct Cache {
    std::shared_mutex mutex;
    std::map<std::tuple<int, std::size_t, std::size_t>, Eigen::MatrixXd> sums;
  };
  std::shared_ptr<Cache> cache_ = std::make_shared<Cache>();
};

}  // namespace shapeid::diagnosis
