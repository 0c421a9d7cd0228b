// Whether a candidate's numbers can be what it says: signs, sizes, and more than chance makes.
#pragma once

#include "shapeid/diagnosis/contenders.hpp"
#include "shapeid/diagnosis/load_body.hpp"

namespace shapeid::diagnosis {

/// Standard errors by which some parameter of an effect differs from zero. A load has mass, or at
/// least a moment: of a link that turns about one axis alone no torque shows the mass. A sine and a
/// cosine whose period was sought among `choices` have one error, which is known badly from few
/// blocks: of two estimates, among many periods, the smaller one would be small by chance.
[[nodiscard]] double differs_from_zero(const Effect& effect, const Eigen::VectorXd& value,
                                       const Eigen::VectorXd& error, double choices);

/// All arguments of the constructor must outlive this.
class Credibility {
 public:
  Credibility(const BlockFits& fits, const Contenders& contenders, const SelectionRule& rule);

  /// True if a number of candidate k that cannot be negative is, by more than so many standard
  /// errors. `own`: its part of a fit.
  [[nodiscard]] bool wrong_sign(std::size_t k, const Fit& own, double least_t) const;
  /// None of its numbers leaves the range in which it is believed; of a load, beside the others, a
  /// body that is near its link does what its ten free numbers do.
  [[nodiscard]] bool within_limits(std::size_t k, const Chosen& others, const Fit& own) const;
  /// Candidate k, last in `with` and not in `without`, which is of the others, is more than chance
  /// makes of nothing, and within_limits(). Of a group that is asked of all its
  /// members' numbers together; they are judged one by one at the end.
  [[nodiscard]] bool credible(std::size_t k, const Chosen& others, const Fit& without,
                              const Fit& with) const;
  /// Whether a ripple, wherever it stands in `all`, is one by itself beside the others.
  [[nodiscard]] bool ripples(std::size_t k, const Chosen& others, const Fit& all,
                             const Fit& own) const;
  /// Whether candidate k, beside the others, is more than chance makes of one of so many numbers.
  [[nodiscard]] bool is_by_itself(std::size_t k, const Chosen& others, double numbers) const;

  /// By candidate k. What acts from a moment on gains in the blocks after it. Those before add to
  /// the gain where masses had taken some of it, and only to the scatter where none are free: the
  /// larger t of both counts. Fewer blocks mean a wider limit; t is in proportion to that of all.
  [[nodiscard]] Gain gain_by(std::size_t k, const Eigen::VectorXd& before,
                             const Eigen::VectorXd& after) const;
  /// Standard errors by which held-out blocks have to gain.
  [[nodiscard]] double limit() const { return limit_; }
  /// Held-out blocks gain enough by it.
  [[nodiscard]] bool passes(const Scored& s) const { return s.t > limit_ && s.gain > 0.0; }

 private:
  [[nodiscard]] BlockFits::Beside beside(std::size_t k, const Chosen& others) const;
  /// What chance makes of a body's ten numbers it may lose. `own`: its part of a fit.
  [[nodiscard]] MostLost most_lost(std::size_t k, const Fit& own) const;
  [[nodiscard]] double squares_over_chance(std::size_t k, const Fit& without, const Fit& with,
                                           double tried) const;
  [[nodiscard]] double over_chance(std::size_t k, const Fit& without, const Fit& with,
                                   const Fit& own, double tried) const;

  const BlockFits& fits_;
  const Contenders& contenders_;
  const SelectionRule& rule_;
  double limit_;
  double parameters_;
};

}  // namespace shapeid::diagnosis
