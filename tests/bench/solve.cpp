// One window's solve: the base link as eleven shapes and as 54 points, cold and warm.
// Speed of Claims C3, C13.
#include "shapeid/tests/bench/harness.hpp"
#include "shapeid/tests/bench/problems/variants.hpp"
#include "shapeid/tests/bench/problems/windows.hpp"

int main(int argc, char** argv) {
  using namespace shapeid::bench;
  const SeedSet seeds = start(argc, argv);
  constexpr int sequences = 10, windows = 25;
  for (const auto& [name, model] :
       {std::pair("base11", base_shapes()), {"base54", base_points()}}) {
    for (const Variant& variant : variants()) {
      const auto make = [&model = model, seeds, &variant] {
        return base_windows(model, seeds, variant.noise, variant.density, sequences, windows);
      };
      register_solves(name + variant.suffix, make);
    }
  }
  finish();
}
