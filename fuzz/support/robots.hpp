// Robots for targets: one that files speak of, and any that bytes spell.
#pragma once

#include "shapeid/fuzz/support/bytes.hpp"
#include "shapeid/models/robot.hpp"
#include "shapeid/models/sample.hpp"

namespace shapeid::fuzz {

/// A floating trunk with a plate fixed to it, and a leg of one joint with a point contact.
[[nodiscard]] Robot hopper();

/// A tree of one to eight links with arbitrary joints, placements and bodies that can exist.
[[nodiscard]] Robot any_robot(Bytes& bytes);

/// An instant of its motion.
[[nodiscard]] Sample any_sample(Bytes& bytes, const Robot& robot);

}  // namespace shapeid::fuzz
