// A floating trunk with a tilted sensor plate fixed to it, and one leg: the robot that the YAML
// tests speak of.
#pragma once

#include "shapeid/models/urdf.hpp"

namespace shapeid::test {

/// Links: trunk (members trunk, plate) and leg. The plate's frame is the trunk's turned by 90
/// degrees about z and moved to (1, 2, 3).
inline Robot two_link_robot() {
  return parse_urdf(R"(<robot name="hopper">
  <link name="trunk">
    <inertial><origin xyz="0.1 0 0"/><mass value="3"/>
      <inertia ixx="0.02" ixy="0" ixz="0" iyy="0.03" iyz="0" izz="0.04"/></inertial>
    <collision><origin xyz="0 0 0.5"/><geometry><box size="1 2 4"/></geometry></collision>
    <collision><geometry><cylinder radius="0.5" length="3"/></geometry></collision>
    <collision><geometry><sphere radius="2"/></geometry></collision>
    <collision><geometry><box size="0 1 1"/></geometry></collision>
  </link>
  <link name="plate"/>
  <link name="leg">
    <inertial><origin xyz="0 0 -0.2"/><mass value="1"/>
      <inertia ixx="0.0125" ixy="0" ixz="0" iyy="0.0104166666666666667" iyz="0" izz="0.00375"/>
    </inertial>
    <collision><geometry><mesh filename="leg.stl"/></geometry></collision>
  </link>
  <joint name="mount" type="fixed"><origin xyz="1 2 3" rpy="0 0 1.5707963267948966"/>
    <parent link="trunk"/><child link="plate"/></joint>
  <joint name="knee" type="revolute"><parent link="trunk"/><child link="leg"/>
    <axis xyz="0 1 0"/><limit lower="-1" upper="1" effort="9" velocity="9"/></joint>
</robot>)",
                    "hopper.urdf")
      .robot;
}

}  // namespace shapeid::test
