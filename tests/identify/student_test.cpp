// What few blocks can show, against tables and closed forms.
#include "shapeid/models/student.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace shapeid {
namespace {

constexpr double of_a_table = 5e-4;  // which has three places
constexpr double of_halving = 1e-9;

// Student's t with the freedom of so many blocks. For one and two the tail has a closed form:
// 1 - (2/pi) atan x, and 1 - x / sqrt(2 + x^2).
TEST(Student, FewBlocksWidenALimit) {
  EXPECT_NEAR(limit_for(1.960, 24), 2.069, of_a_table);
  EXPECT_NEAR(limit_for(2.576, 31), 2.750, of_a_table);
  EXPECT_NEAR(limit_for(1.960, 1000000), 1.960, of_a_table);
  for (const double z : {0.7, 2.0, 3.3, 4.5, 6.0}) {
    const double probability = std::erfc(z / std::sqrt(2.0));
    const double pi = 3.14159265358979323846;
    EXPECT_NEAR(limit_for(z, 2) * std::tan(0.5 * pi * probability), 1.0, of_halving * 10.0) << z;
    const double inside = 1.0 - probability;
    EXPECT_NEAR(limit_for(z, 3) * std::sqrt(1.0 - inside * inside) / (std::sqrt(2.0) * inside), 1.0,
                of_halving * 100.0)
        << z;
  }
}

}  // namespace
}  // namespace shapeid
