// The laws of a contest that have no name, as terms of its fits, and what is asked of each.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <vector>

#include "shapeid/diagnosis/contest.hpp"
#include "shapeid/diagnosis/fits_around.hpp"

namespace shapeid::diagnosis {

/// Laws by their numbers.
class StrangerLaws {
 public:
  /// `asked` must outlive this.
  explicit StrangerLaws(const Questions& asked);

  [[nodiscard]] const Term& term(std::size_t s) const { return terms_[s]; }

  /// The most promising beside these terms, first, at joints of which none of `taken` is.
  [[nodiscard]] std::vector<std::size_t> shortlist(const std::vector<Term>& beside,
                                                   const std::vector<std::size_t>& taken) const;
  /// The law's held-out error beside others, if it is significant.
  [[nodiscard]] std::optional<Eigen::VectorXd> significant(std::size_t s,
                                                           const FitsAround& beside) const;
  struct Best {
    std::size_t law = 0;
    Eigen::VectorXd error;
  };
  /// Of the shortlist that which predicts best, if one is significant.
  [[nodiscard]] std::optional<Best> best(const std::vector<Term>& beside,
                                         const std::vector<std::size_t>& taken) const;

  /// Beside other terms, of which it takes the held-out error from `before` to `after`.
  [[nodiscard]] Stranger as_stranger(std::size_t s, std::vector<Term> beside,
                                     const Eigen::VectorXd& before,
                                     const Eigen::VectorXd& after) const;

 private:
  [[nodiscard]] const Modulation& law(std::size_t s) const {
    return fits_.tally().modulations[laws_[s]];
  }

  const BlockFits& fits_;
  std::vector<std::size_t> laws_;      ///< modulations of the tally
  std::vector<Term> terms_;            ///< one a law
  std::vector<double> least_z_;        ///< likewise
  std::vector<double> least_squares_;  ///< likewise: what it must take away
};

}  // namespace shapeid::diagnosis
