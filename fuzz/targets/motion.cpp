// From a log to samples: whatever the clock and the numbers do, samples are whole or refused.
#include <cstdint>
#include <optional>

#include "shapeid/fuzz/support/check.hpp"
#include "shapeid/fuzz/support/memory_file.hpp"
#include "shapeid/fuzz/support/robots.hpp"
#include "shapeid/models/motion.hpp"

using namespace shapeid;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Robot robot = fuzz::hopper();
  if (size == 0) return 0;
  MotionOptions options;  // the first byte chooses
  options.smoothing = static_cast<Smoothing>(data[0] % 3);
  options.exact_derivatives = (data[0] & 4U) != 0;
  options.use_logged_velocity = (data[0] & 8U) != 0;
  options.at_contact_change = (data[0] & 16U) != 0 ? ContactChange::drop : ContactChange::widen;
  options.expect_gravity = (data[0] & 32U) != 0;
  options.refuse_frozen = (data[0] & 64U) != 0;
  const fuzz::MemoryFile file(data + 1, size - 1);
  fuzz::taken([&] {
    MotionReader reader(file.path(), robot, {}, std::nullopt, options);
    while (const auto sample = reader.next()) {
      fuzz::check(!why_malformed(*sample, robot), "samples are whole and finite");
    }
  });
  return 0;
}
