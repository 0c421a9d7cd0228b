// effects.yaml: what is read is written and read back the same.
#include <cstdint>
#include <string>

#include "shapeid/diagnosis/effects_yaml.hpp"
#include "shapeid/fuzz/support/check.hpp"
#include "shapeid/fuzz/support/memory_file.hpp"
#include "shapeid/fuzz/support/robots.hpp"

using namespace shapeid;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Robot robot = fuzz::hopper();
  const fuzz::MemoryFile file(data, size);
  const auto known =
      fuzz::accepted([&] { return diagnosis::read_effects_yaml(file.path(), robot); });
  if (!known) return 0;
  for (const auto& effect : known->effects) {
    fuzz::check(effect.shape.allFinite() && effect.value.allFinite(), "values are finite");
  }
  for (const diagnosis::Curve& curve : known->curves) {
    fuzz::check(curve.at.allFinite() && curve.number.allFinite(), "knots are finite");
    fuzz::check(curve.at.size() == curve.number.size(), "a number a knot");
  }
  const std::string text = diagnosis::write_effects_yaml(robot, *known);
  const fuzz::MemoryFile written(text);
  const diagnosis::KnownEffects again = diagnosis::read_effects_yaml(written.path(), robot);
  fuzz::check(
      again.effects.size() == known->effects.size() && again.curves.size() == known->curves.size(),
      "no effect is lost");
  fuzz::check(diagnosis::write_effects_yaml(robot, again) == text, "effects read back the same");
  return 0;
}
