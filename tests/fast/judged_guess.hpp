// A guess at the masses of a link, judged by the method it is made for; and what every kind of
// guess must keep.
#pragma once

#include <cstdint>
#include <vector>

#include "shapeid/fast/active_set.hpp"
#include "shapeid/fast/few_shapes.hpp"
#include "shapeid/fast/link_table.hpp"
#include "shapeid/fast/one_link.hpp"
#include "shapeid/tests/fast/triangle_cases.hpp"

namespace shapeid::test {

enum class GuessBy { few_shapes, link_table };

/// Of one problem, as its shapes are divided.
class JudgedGuess {
 public:
  static constexpr int most_divisions = 8;

  JudgedGuess(GuessBy by, const TriangleCase& given);

  /// For other rows than those that the method knows, perhaps.
  [[nodiscard]] bool start(const Eigen::MatrixXd& R, double lambda,
                           const std::vector<int>& passive = {});
  /// Pivots, and whether the method takes what they lead to.
  [[nodiscard]] bool settles();
  /// The last shape came out of shape j.
  [[nodiscard]] bool divide(const TriangleCase& divided, int j);
  /// Those of the method: kg, an entry a shape.
  [[nodiscard]] Eigen::VectorXd masses() const;
  [[nodiscard]] fast::Guess& guess() {
    return by_ == GuessBy::few_shapes ? static_cast<fast::Guess&>(few_) : table_;
  }

 private:
  Eigen::VectorXd V_;
  GuessBy by_;
  fast::ShapeColumns columns_;
  fast::LinkRows rows_;
  fast::FewShapes few_;
  fast::LinkTable table_;
  fast::OneLink vertex_;
  fast::ActiveSet method_;
};

/// One link, its shapes anywhere.
[[nodiscard]] TriangleCase link_case(std::uint64_t seed, int shapes, bool density_term,
                                     double noise = 1e-2);

/// Of 300 problems with up to `most_shapes`, how many are settled; each of these is right.
[[nodiscard]] int settled_guesses(GuessBy by, int most_shapes, bool density_term, bool warm,
                                  double noise = 1e-2);

/// Of 100 guesses from the forces of another window, how many are refused.
[[nodiscard]] int refused_guesses(GuessBy by, int shapes);

/// A property: a guess from other forces has other masses; either they can be corrected to the
/// minimum, or they are refused.
void check_guess_of_other_forces(GuessBy by, int most_shapes);

/// A property: when some shapes have been divided, and none was allowed to leave, there stand the
/// inverse and the minimum of the passive shapes. With lambda the parts of a whole feel each other.
/// `growth`: of rounding on the way, beside the condition's square.
void check_divided_guess(GuessBy by, int most_shapes, double growth);

/// A property: parts whose columns add nothing to the span of the passive ones, since the rows tell
/// no more of them apart, leave as many passive as there were, at their minimum, none with negative
/// mass.
void check_guess_divided_within_span();

}  // namespace shapeid::test
