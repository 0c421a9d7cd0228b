// Prints the bits of masses that the fast path finds on one link and on three, cold, warm and after
// divisions. Built with the kernels of fast/wide.hpp for the machine at hand, and for one without
// wide registers.
#include <cstdint>
#include <cstring>
#include <iostream>

#include "shapeid/tests/fast/triangle_cases.hpp"

int main() {
  using namespace shapeid;
  std::cout << std::hex;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    const int links = seed % 5 == 0 ? 3 : 1;
    test::TriangleCase given =
        test::body_case(seed, {.links = links,
                               .shapes_a_link = 1 + static_cast<int>(seed % 40) / links,
                               .noise = seed % 3 == 0 ? 0.0 : 1e-2,
                               .density_term = seed % 2 == 0});
    test::Draw draw(seed);
    constexpr int divisions = 6;
    fast::MassSolver solver(links, given.shapes() + divisions);
    test::load(given, solver);
    const auto print = [&] {
      for (const double m : solver.m()) {
        std::uint64_t bits = 0;
        std::memcpy(&bits, &m, sizeof bits);
        std::cout << bits << ' ';
      }
      std::cout << solver.iterations() << '\n';
    };
    for (int window = 0; window < 3; ++window) {
      if (window > 0) given.R.rightCols<1>() += 1e-3 * given.R.leftCols(10 * links).rowwise().sum();
      if (solver.solve(given.R) != fast::Outcome::solved) return 1;
      print();
    }
    for (int k = 0; k < divisions; ++k) {
      const int j = static_cast<int>(seed) % given.shapes(), last = given.shapes();
      test::divide(given, j, draw);
      if (!solver.divide(j, given.column(j), given.problem.V[j], given.column(last),
                         given.problem.V[last]) ||
          solver.solve_again() != fast::Outcome::solved) {
        return 1;
      }
      print();
    }
  }
}
