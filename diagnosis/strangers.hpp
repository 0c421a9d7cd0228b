// Laws that have no name: a law of the catalogue at a joint, times a signal that its number does
// not follow there. Friction that grows with position, a gain on one side of the load, an encoder
// that yields under torque: no entry of the catalogue, but products of what it has.
#pragma once

#include <string>
#include <vector>

#include "shapeid/diagnosis/series.hpp"
#include "shapeid/diagnosis/tally.hpp"

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

}  // namespace shapeid::diagnosis
