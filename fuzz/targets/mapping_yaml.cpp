// mapping.yaml: rules with finite numbers.
#include <cmath>
#include <cstdint>

#include "shapeid/fuzz/support/check.hpp"
#include "shapeid/fuzz/support/memory_file.hpp"
#include "shapeid/models/log.hpp"

using namespace shapeid;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fuzz::MemoryFile file(data, size);
  fuzz::taken([&] {
    const Mapping mapping = read_mapping_yaml(file.path());
    for (const auto& [ours, rule] : mapping.columns) {
      fuzz::check(std::isfinite(rule.scale) && rule.scale != 0.0 && std::isfinite(rule.offset) &&
                      std::abs(rule.sign) == 1.0,
                  "rules are finite and can be undone");
    }
    for (const auto& [column, value] : mapping.keep_rows) {
      fuzz::check(std::isfinite(value), "kept values are finite");
    }
    for (const auto& [joint, factor] : mapping.torque_factor) {
      fuzz::check(std::isfinite(factor), "torque factors are finite");
    }
  });
  return 0;
}
