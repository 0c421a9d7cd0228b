// A log that is columns and nothing else: what is in it was planted, so every verdict has a right
// answer.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <list>
#include <random>
#include <string>
#include <vector>

#include "shapeid/diagnosis/selection.hpp"

namespace shapeid::diagnosis::planted {

/// An effect that is no more than its name and so many parameters of a unit.
[[nodiscard]] Effect law(const std::string& id, int parameters = 1,
                         const std::string& unit = "N m");

/// The value of an effect that has one parameter.
[[nodiscard]] inline Eigen::VectorXd one_number(double value) {
  return Eigen::VectorXd::Constant(1, value);
}

class Planted {
 public:
  static constexpr std::size_t blocks = 24;
  static constexpr Eigen::Index rows_of_block = 40;
  static constexpr Eigen::Index rows = Eigen::Index{blocks} * rows_of_block;

  explicit Planted(unsigned seed);

  /// Normal numbers of unit variance, rows x columns; each has this share of the one above.
  [[nodiscard]] Eigen::MatrixXd normal(Eigen::Index columns, double memory = 0.0);

  /// What an inertial parameter multiplies.
  [[nodiscard]] Eigen::VectorXd column_of_mass(Eigen::Index parameter) const {
    return columns_.col(parameter);
  }

  /// A candidate of this law and these columns, one a parameter, from a block on; its number.
  std::size_t add(const Effect& effect, const Eigen::MatrixXd& columns, int site = 0,
                  std::size_t from_block = 0);
  /// Candidates that are one together; the group's number.
  std::size_t add_group(const std::vector<std::size_t>& members);
  /// What the log has of a candidate.
  void plant(std::size_t k, const Eigen::VectorXd& value);
  void add_noise(double memory = 0.0) { force_ += normal(1, memory); }

  [[nodiscard]] std::vector<Candidate>& candidates() { return candidates_; }
  [[nodiscard]] const Term& masses() const { return masses_; }
  [[nodiscard]] BlockFits fits() const;
  [[nodiscard]] Selection selection(const SelectionRule& rule = {}) const;

  /// Size at which one number of a column of unit variance has so many standard errors.
  [[nodiscard]] static double size_of(double standard_errors);

 private:
  std::mt19937 random_;
  std::list<Effect> effects_;
  std::vector<AppliedEffect> hypotheses_;
  std::vector<Candidate> candidates_;
  Term masses_;
  Eigen::MatrixXd columns_;
  Eigen::VectorXd force_;
};

/// What was accepted, in the order of its numbers.
[[nodiscard]] std::vector<std::size_t> accepted(const Selection& selection);
/// The verdict on candidate k, which was accepted.
[[nodiscard]] const Verdict& verdict_on(std::size_t k, const Selection& selection);

}  // namespace shapeid::diagnosis::planted
