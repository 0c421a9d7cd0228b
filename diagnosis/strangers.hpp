// Laws that have no name: a law of the catalogue at a joint, times a signal that its number does
// not follow there. Friction that grows with position, a gain on one side of the load, an encoder
// that yields under torque: no entry of the catalogue, but products of what it has.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "shapeid/diagnosis/fits.hpp"

namespace shapeid::diagnosis {

struct Stranger {
  Modulation law;         ///< hypothesis of the tally, times what signal
  AppliedEffect carrier;  ///< that hypothesis
  double gain = 0.0;      ///< share of the held-out squared error that it takes away
  double t = 0.0;         ///< over its standard error
};

/// Laws at joints that lend their columns: one number, at most one shape number. A carrier that is
/// among `effects` is left out: it is in every tally of these.
[[nodiscard]] std::vector<AppliedEffect> carriers(const Robot& robot,
                                                  const std::vector<AppliedEffect>& effects);

/// Hypotheses `first` to `last` of a tally times the signals of their joint, and times time.
[[nodiscard]] std::vector<Modulation> modulated_carriers(
    const std::vector<AppliedEffect>& hypotheses, std::size_t first, std::size_t last);

/// Whether names stand against laws without one.
struct Contest {
  std::vector<Stranger> strangers;  ///< the strongest first, at most one a joint
  std::vector<bool> displaced;      ///< one an effect
};

/// `terms` are the masses and the effects' own, `own_term` the place among these of each effect, if
/// it is a column; `effects` the number of accepted hypotheses, which come first in the tally, its
/// carriers at `first_carrier`. A name is displaced if a stranger in its place predicts better by
/// more than chance and by more than a name may be short of, or if beside the strangers it gains
/// nothing any more. A stranger counts if it lowers the held-out error beside all names that are
/// left, as significantly as is asked of a name, for so many as are tried.
[[nodiscard]] Contest contest(const BlockFits& fits, const std::vector<Term>& terms,
                              const std::vector<std::optional<std::size_t>>& own_term,
                              std::size_t first_carrier);

/// Held-out errors with the best significant stranger beside `terms`; none if there is none.
[[nodiscard]] std::optional<Eigen::VectorXd> with_best_stranger(const BlockFits& fits,
                                                                const std::vector<Term>& terms,
                                                                std::size_t effects,
                                                                std::size_t first_carrier);

/// Whether a stranger that leaves `instead` on the blocks may displace a name that leaves `named`
/// and takes away `own_gain` in all: better by more than chance, and by more than a name may be
/// short of.
[[nodiscard]] bool takes_the_place(const Eigen::VectorXd& named, const Eigen::VectorXd& instead,
                                   double own_gain);

}  // namespace shapeid::diagnosis
