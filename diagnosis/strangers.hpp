// Laws that have no name: a law of the catalogue at a joint, times a signal that its number does
// not follow there. Friction that grows with position, a gain on one side of the load, an encoder
// that yields under torque: no entry of the catalogue, but products of what it has.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "shapeid/diagnosis/fits.hpp"
#include "shapeid/diagnosis/series.hpp"

namespace shapeid::diagnosis {

struct Stranger {
  Modulation law;         ///< hypothesis of the tally, times what signal
  AppliedEffect carrier;  ///< that hypothesis
  double gain = 0.0;      ///< share of the held-out squared error that it takes away
  double t = 0.0;         ///< over its standard error
  double number = 0.0;    ///< of the law, per unit of the signal; the first, if it has two
};

/// "viscous_friction@lift", "gear@lift that yields": the law whose number follows a signal.
[[nodiscard]] std::string law_id(const Stranger& stranger, const Robot& robot);
/// The same with the signal: "viscous_friction@lift over q.lift".
[[nodiscard]] std::string law_text(const Stranger& stranger, const Robot& robot);

/// Laws at joints that lend their columns: one number, at most one shape number. A carrier that is
/// among `effects` is left out: it is in every tally of these.
[[nodiscard]] std::vector<AppliedEffect> carriers(const Robot& robot,
                                                  const std::vector<AppliedEffect>& effects);

/// Ripples in proportion to the load, as of an eccentric gear, one or two a joint: with the periods
/// that explain most of what is left by masses alone (`rigid`) and by the present model (`left`).
[[nodiscard]] std::vector<AppliedEffect> ripple_carriers(const Robot& robot, const Recording& log,
                                                         const Series& rigid, const Series& left);

/// Hypotheses `first` to `last` of a tally times the signals of their joint, and times time;
/// ripples times the load; gains also where the load is high, as what saturates.
[[nodiscard]] std::vector<Modulation> modulated_carriers(
    const Recording& log, const std::vector<AppliedEffect>& hypotheses, std::size_t first,
    std::size_t last);

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

/// Whether names stand against laws without one.
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
