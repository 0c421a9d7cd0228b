// Whether names stand against laws without one.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <vector>

#include "shapeid/diagnosis/fits.hpp"
#include "shapeid/diagnosis/strangers.hpp"

namespace shapeid::diagnosis {

/// What names are asked against: sums of the present effects, which come first, of placebos and of
/// carriers, and products of these.
struct Questions {
  BlockFits fits;
  std::vector<Term> terms;  ///< masses, and effects that are columns
  /// Place among `terms` of each effect; none for a transformation, which is within the masses'.
  std::vector<std::optional<std::size_t>> own_term;
  std::size_t first_ripple = 0, first_carrier = 0;  ///< among placebos, after these
  std::vector<double> choices;                      ///< one a hypothesis, as in Candidate
  [[nodiscard]] std::size_t effects() const { return own_term.size(); }
};

/// Who was left.
struct Contest {
  std::vector<Stranger> strangers;  ///< the strongest first, at most one a joint
  std::vector<bool> displaced;      ///< one an effect
  /// One an effect: a stranger that predicts better in its place, though not by more than chance.
  std::vector<std::optional<Stranger>> rivals;
};

/// A name is displaced if a stranger in its place predicts better by more than chance and by more
/// than a name may be short of, if beside the strangers it gains nothing any more, or if
/// strangers do for more names than they are: beside them these gain nothing, and without these
/// they predict no worse. A stranger counts if it lowers the held-out error as significantly as is
/// asked of a name, for so many as are tried.
[[nodiscard]] Contest contest(const Questions& asked);

/// The contest if strangers do for more names than they are, `taken_out` of which are in no term of
/// `asked` any more, and which all together left `named`; else none.
[[nodiscard]] std::optional<Contest> contest_if_fewer(const Questions& asked,
                                                      const Eigen::VectorXd& named,
                                                      std::size_t taken_out);

/// The best significant stranger beside all terms, with which they leave `error` on the held-out
/// blocks; none if there is none.
struct BestStranger {
  Stranger stranger;
  Eigen::VectorXd error;
};
[[nodiscard]] std::optional<BestStranger> best_stranger(const Questions& asked);

/// Whether a stranger that leaves `instead` on the blocks may displace a name that leaves `named`
/// and takes away `own_gain` in all: better by more than chance, and by more than a name may be
/// short of.
[[nodiscard]] bool takes_the_place(const Eigen::VectorXd& named, const Eigen::VectorXd& instead,
                                   double own_gain);

}  // namespace shapeid::diagnosis
