#include "shapeid/diagnosis/effects.hpp"

#include <algorithm>

namespace shapeid::diagnosis {

const std::vector<Effect>& all_effects() {
  static const std::vector<Effect> effects = {
      // at a joint
      viscous_friction(), coulomb_friction(), stribeck_friction(), load_friction(), torque_offset(),
      torque_gain(), torque_lag(), rotor_inertia(), rotor_reaction(), joint_spring(),
      encoder_offset(), cogging(), link_length(),
      // of the whole log
      torque_delay(), imu_delay(), gravity_tilt(),
      // at the accelerometer
      accel_bias(), accel_misalignment(), accel_noise(),
      // at a link
      payload(), payload_from(), external_force(), drag(),
      // at a contact
      contact_point(), foot_radius(), contact_late(), contact_short(), contact_undeclared(),
      contact_absent()};
  return effects;
}

const Effect* find_effect(const std::string& id) {
  const auto& all = all_effects();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const Effect& e) { return e.id == id; });
  return found == all.end() ? nullptr : &*found;
}

}  // namespace shapeid::diagnosis
