// What is said in the end of each accepted candidate: what it is worth, and what could stand in its
// place.
#pragma once

#include <vector>

#include "shapeid/diagnosis/credibility.hpp"

namespace shapeid::diagnosis {

/// What comes within this many standard errors is named beside an accepted one: of a hundred causes
/// that are there about one is further behind by chance, with so few blocks.
inline constexpr double told_apart_t = 2.5;

/// All arguments of the constructor must outlive this.
class Verdicts {
 public:
  Verdicts(const BlockFits& fits, const Contenders& contenders, const Credibility& credibility,
           const SelectionRule& rule)
      : fits_(fits), contenders_(contenders), credibility_(credibility), rule_(rule) {}

  /// Of what was accepted, in this order; `error` per held-out block is that of all. Who came with
  /// others of a group is not asked here: `by_itself` is true.
  [[nodiscard]] std::vector<Verdict> of(const Chosen& accepted, const Eigen::VectorXd& error) const;

 private:
  [[nodiscard]] Verdict one(std::size_t k, const Chosen& others,
                            const Eigen::VectorXd& error) const;
  [[nodiscard]] bool costs_its_numbers(std::size_t rival, std::size_t k,
                                       const Eigen::VectorXd& error,
                                       const Eigen::VectorXd& instead) const;
  [[nodiscard]] bool does_without(std::size_t k, std::size_t rival, const Chosen& others,
                                  const Eigen::VectorXd& error) const;
  void name_common_causes(const Chosen& accepted, const Eigen::VectorXd& error,
                          std::vector<Verdict>& verdicts) const;
  [[nodiscard]] Chosen not_superfluous_beside(std::size_t rival, Chosen chosen) const;
  /// Whether its numbers could be these: no wrong sign, within limits, of a load a body.
  [[nodiscard]] bool is_possible(std::size_t k, const Chosen& others) const;
  /// Of the rival beside the others the part of the rival.
  [[nodiscard]] Fit fit_of(std::size_t rival, const Chosen& others) const;

  const BlockFits& fits_;
  const Contenders& contenders_;
  const Credibility& credibility_;
  const SelectionRule& rule_;
};

}  // namespace shapeid::diagnosis
