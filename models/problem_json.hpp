// problem.json and answer.json: a mass problem and somebody's answer to it, as anyone can read and
// write them. Schemas: docs/formats/problem.md.
#pragma once

#include <string>

#include "shapeid/models/mass_problem.hpp"
#include "shapeid/models/stated_problem.hpp"

namespace shapeid {

/// Numbers are written as the shortest decimals that read back to the same double.
[[nodiscard]] std::string problem_to_json(const StatedProblem& stated);
[[nodiscard]] std::string problem_to_json(const MassProblem& problem);
/// `name` stands for the file in messages. Throws InputError: not JSON, wrong version, a key that
/// is missing, unknown or there twice, sizes that disagree, numbers that are not finite.
[[nodiscard]] StatedProblem stated_problem_from_json(const std::string& text,
                                                     const std::string& name);
/// The same, for readers that know of masses alone: also refuses other columns.
[[nodiscard]] MassProblem problem_from_json(const std::string& text, const std::string& name);

/// An answer says masses, or parameters alone; the problem's digest ties it to its problem.
struct Answer {
  std::string problem_digest;
  Eigen::VectorXd masses;      ///< kg, one a shape; empty if only parameters are claimed
  Eigen::VectorXd parameters;  ///< Phi of the free links, 10 each
  double objective = 0.0;      ///< f as the solver computed it
  Eigen::VectorXd others{};    ///< x of the other columns
};

[[nodiscard]] std::string answer_to_json(const Answer& answer);
[[nodiscard]] Answer answer_from_json(const std::string& text, const std::string& name);

/// FNV-1a (64 bit, hexadecimal) of the problem's JSON text: names a problem, proves nothing.
[[nodiscard]] std::string problem_digest(const StatedProblem& problem);
[[nodiscard]] std::string problem_digest(const MassProblem& problem);

}  // namespace shapeid
