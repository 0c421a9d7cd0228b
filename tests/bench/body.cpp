// The whole body: thirteen free links, four to fifty shapes each.
#include "shapeid/tests/bench/problems/body.hpp"

#include <string>

#include "shapeid/tests/bench/harness.hpp"

int main(int argc, char** argv) {
  using namespace shapeid::bench;
  const SeedSet seeds = start(argc, argv);
  constexpr int sequences = 2;
  for (const int shapes : {4, 8, 16, 50}) {
    for (const auto& [suffix, noise] :
         {std::pair("", Noise::sensors), std::pair("_noisefree", Noise::none)}) {
      const auto make = [=, n = noise] {
        const int windows = shapes > 16 ? 3 : 6;  // some solvers need a second each
        return body_windows(body_cuboids(shapes), seeds, n, sequences, windows);
      };
      register_solves("body" + std::to_string(13 * shapes) + suffix, make);
    }
  }
  finish();
}
