// Which hypotheses lower the error on blocks that were not fitted, one after the other.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "shapeid/diagnosis/fits.hpp"
#include "shapeid/diagnosis/regions.hpp"

namespace shapeid::diagnosis {

/// A hypothesis as a term of a fit.
struct Candidate {
  AppliedEffect effect;
  Term term;
  /// Of a group (friction at every joint): candidates that it stands for. Accepted together, judged
  /// one by one at the end.
  std::vector<std::size_t> members;
  /// Among how many independent ones it was chosen before (periods of a ripple): as many chances.
  double choices = 1.0;
  Box room = {};  ///< of a load: in which it has its mass
  /// It is not sought, but may be what another cannot be told from.
  bool only_rival = false;
};

/// What becomes of a search that begins with what is usually fitted, where it predicts better by
/// more than chance. It takes as long as the other.
enum class FromUsual { not_asked, noted, taken };

/// The rule of acceptance. The best hypothesis is accepted if the sum over held-out blocks of its
/// gain exceeds `least_t` standard errors (enlarged for few blocks). A parameter of z standard
/// errors has a held-out gain of z^2 - 2 in units of the noise, with a standard error of 2 |z|:
/// `least_t` = 2.5 asks for z of about 5.4. With some hundred hypotheses tried, chance alone passes
/// less often than once in ten thousand logs; what passes wrongly is structure that no hypothesis
/// describes. Standard errors come from blocks, and are themselves uncertain: the limit is enlarged
/// for few blocks. There is no least gain and no least size: what a wrong law is worth in a log is
/// asked of the log (placebo.hpp).
struct SelectionRule {
  double least_t = 2.5;
  /// Logs without any effect in which chance alone may make some parameter as large as is asked,
  /// between blocks and by squares of independent noise.
  double false_alarms = 0.003;
  int most_terms = 60;
  int shortlist = 24;  ///< of the candidates, by promise, whose held-out error is computed
  int rivals = 24;     ///< likewise of those that might take an accepted one's place
  /// N: constant forces beyond this are not believed. Some are nearly hidden by contacts, or by
  /// each other.
  double most_force = std::numeric_limits<double>::infinity();
  FromUsual from_usual = FromUsual::noted;
  std::size_t threads = 1;  ///< that compare hypotheses at once; nothing depends on how many
  /// What the data cannot tell from masses is asked, too. It is accepted only if masses that stay
  /// as near to the given ones as the prior has it cannot say the same.
  bool contained_too = false;
};

/// What no longer gains this many standard errors, all else in, is dropped again.
inline constexpr double keep_t = 2.0;

struct Scored {
  std::size_t candidate = 0;
  double gain = 0.0;        ///< share of the held-out squared error that it takes away
  double t = 0.0;           ///< gain over its standard error
  Fit fit;                  ///< of its parameters, all blocks in
  bool wrong_sign = false;  ///< significantly negative where it cannot be
  /// Else chance or the filter may make as much of it, or its size is not believed.
  bool credible = true;
};

struct SelectionStep {
  Scored accepted;
  std::vector<Scored> others;  ///< the shortlist, best first
};

/// What is in the end said of an accepted candidate.
struct Verdict {
  std::size_t candidate = 0;
  double gain = 0.0, t = 0.0;  ///< of having it, all other accepted ones in
  /// It did not come with the same at other joints, or is more than chance makes of one of these.
  bool by_itself = true;
  /// The data cannot tell it from masses and what else was accepted: it is worth that gain because
  /// masses that stay near the given ones cannot say the same.
  bool hangs_on_given = false;
  /// Whether it came since the reference log or acts in both: the data cannot tell.
  std::vector<When> other_times;
  /// Candidates that in its place do as well, as far as the data can tell.
  std::vector<std::size_t> ambiguous;
};

struct Selection {
  /// From masses alone, then, if that search counts, from what is usually fitted.
  std::vector<SelectionStep> steps;
  bool usual_is_better = false;      ///< see FromUsual
  std::vector<Verdict> accepted;     ///< what remained at the end
  std::vector<Scored> last_ranking;  ///< of what was not accepted
  std::vector<Scored> wrong_signs;   ///< evidence of something else
  std::vector<std::size_t> hidden;   ///< BlockFits::Promise::hidden beside masses and accepted ones
  Eigen::VectorXd error_end;         ///< per held-out block
  Fit fit;                           ///< masses, then accepted in their order
};

/// `masses`: columns that are fitted always, the free links' above all.
[[nodiscard]] Selection select(const BlockFits& fits, const Term& masses,
                               const std::vector<Candidate>& candidates, const SelectionRule& rule);

}  // namespace shapeid::diagnosis
