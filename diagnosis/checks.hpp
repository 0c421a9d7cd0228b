// Logs that no diagnosis should be made from.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "shapeid/diagnosis/loop.hpp"

namespace shapeid::diagnosis {

/// Of logs that are fitted, together. Throws Refusal:
///  * "no-data": there is no usable sample;
///  * "not-excited": no joint moves.
void check_excitation(const Robot& robot, const Recording& recording);

/// Of each log, also of one that is only tested on. Throws Refusal:
///  * "torque-missing": a torque that is zero throughout, of a joint that is driven
///    (torque_columns.hpp);
///  * "leg-order": the given links would predict better with legs exchanged (leg_order.hpp);
///  * "imu-axes" and "contact-labels", by feet that stand (reference/standing_feet.hpp);
///  * "contact-labels" also by feet that carry (reference/carrying_feet.hpp);
///  * "torque-scale", "torque-sign" and "torque-order", by what the given links predict
///    (torque_columns.hpp);
///  * "imu-axes" also if they would predict far better by other axes of the accelerometer
///    (accelerometer_axes.hpp);
///  * "upside-down": the base, if it hangs, explains far more;
///  * "joint-sign", "joint-zero": or with joints that are read with the other sign, or a quarter or
///    half a turn further (joint_readings.hpp).
/// Units, signs, frozen channels and clocks that cannot be are refused when the log is read
/// (models/plausibility.hpp), a torque column that is a current by its name as well.
void check_meaning(const Robot& robot, const Recording& recording, ContactTreatment contacts);

/// Throws Refusal "clock-skew" if torque and joints drift apart in time: the delay that explains
/// the first half of a log best differs from that of its second half. `log_starts`: samples at
/// which further logs begin; `names`: of all logs, to be said, or none.
void check_clocks(const Robot& robot, const Recording& recording, const LoopSettings& settings,
                  const std::vector<std::size_t>& log_starts = {},
                  const std::vector<std::string>& names = {});

}  // namespace shapeid::diagnosis
