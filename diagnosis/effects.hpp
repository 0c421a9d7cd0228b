// The catalogue: every effect that the diagnosis knows, one file each in effects/.
#pragma once

#include <string>
#include <vector>

#include "shapeid/diagnosis/effect.hpp"

namespace shapeid::diagnosis {

Effect accel_bias();
Effect accel_misalignment();
Effect accel_noise();
Effect cogging();
Effect contact_absent();
Effect contact_late();
Effect contact_point();
Effect contact_short();
Effect contact_undeclared();
Effect coulomb_friction();
Effect drag();
Effect encoder_offset();
Effect external_force();
Effect foot_radius();
Effect gravity_tilt();
Effect imu_delay();
Effect joint_spring();
Effect link_length();
Effect load_friction();
Effect payload();
Effect payload_from();
Effect rotor_inertia();
Effect rotor_reaction();
Effect stribeck_friction();
Effect torque_delay();
Effect torque_gain();
Effect torque_lag();
Effect torque_offset();
Effect viscous_friction();

/// All of them, in the order of the documentation.
[[nodiscard]] const std::vector<Effect>& all_effects();

/// The effect of this id; null if there is none.
[[nodiscard]] const Effect* find_effect(const std::string& id);

/// The catalogue as a page of Markdown: docs/effects.md, and what `shapeid diagnose --list` prints.
[[nodiscard]] std::string catalogue_page();

}  // namespace shapeid::diagnosis
