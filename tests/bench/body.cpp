// The whole body: thirteen free links, four to fifty shapes each.
// Speed of Claims C3, C13.
#include "shapeid/tests/bench/problems/body.hpp"

#include <string>

#include "shapeid/tests/bench/harness.hpp"
#include "shapeid/tests/bench/problems/variants.hpp"

int main(int argc, char** argv) {
  using namespace shapeid::bench;
  const SeedSet seeds = start(argc, argv);
  constexpr int sequences = 2;
  for (const int shapes : {4, 8, 16, 50}) {
    for (const Variant& variant : variants()) {
      const auto make = [=, &variant] {
        const int windows = shapes > 16 ? 3 : 6;  // some solvers need a second each
        return body_windows(body_cuboids(shapes), seeds, variant.noise, variant.density, sequences,
                            windows);
      };
      register_solves("body" + std::to_string(13 * shapes) + variant.suffix, make);
    }
  }
  finish();
}
