// Asks Coq to evaluate definitions of proofs/ over the rationals, on doubles exactly as they are.
#pragma once

#include <Eigen/Core>

#include <string>

namespace shapeid::test {

/// The exact number, vector (as a list) or matrix (as a list of rows) in Coq's words.
[[nodiscard]] std::string coq_number(double x);
[[nodiscard]] std::string coq_list(const Eigen::VectorXd& x);
[[nodiscard]] std::string coq_rows(const Eigen::MatrixXd& M);

/// Values of a Coq expression of type `list rationals`, each rounded once. `definitions` go before
/// it; proofs/evaluate.v is loaded. Throws with Coq's answer if that is no list of numbers.
[[nodiscard]] Eigen::VectorXd evaluated(const std::string& definitions,
                                        const std::string& expression);

}  // namespace shapeid::test
