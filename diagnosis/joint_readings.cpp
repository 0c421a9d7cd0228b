#include "shapeid/diagnosis/joint_readings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "shapeid/diagnosis/given_errors.hpp"
#include "shapeid/diagnosis/joint_reading.hpp"
#include "shapeid/diagnosis/quarter_turns.hpp"
#include "shapeid/models/error.hpp"

namespace shapeid::diagnosis {
namespace {

/// Of the squared torque: links that are given too heavy do less harm where their weight is along
/// the axes, but predict nothing there. And where the given links predict more than half as it is,
/// a centre of mass that is given a little off an axis, on the other side of it, may gain as much.
constexpr double well = 0.25, badly = 0.5;

/// rad by which a joint may be read further. No leg stands that is read a quarter of a turn off.
std::vector<double> turns_of(const Robot& robot, int joint) {
  if (robot.root != Root::fixed || robot.joint(joint).kind == JointKind::prismatic) return {0.0};
  return {0.0, -quarter_turn, quarter_turn, 2.0 * quarter_turn};
}

class ByGivenLinks {
 public:
  ByGivenLinks(const Robot& robot, const Recording& recording, RowSource rows)
      : robot_(robot), errors_(robot, recording, rows) {}

  /// Joints that should be read otherwise, the strongest first; none if that is not far better.
  [[nodiscard]] JointReadings sought() const {
    return robot_.root == Root::fixed ? sought_on_fixed_base() : sought_beside_feet().readings;
  }

  /// Where feet stand a sign is not a matter of a centre of mass, and each block tells. Of measured
  /// trots the given links leave a fifth to a third of the squared torque, with a knee of the other
  /// sign 1.3 to 2.7 times as much.
  [[nodiscard]] ReadingTrial sought_beside_feet() const {
    constexpr double clearly_better = 0.8, as_good = 0.9, little = 1e-4;
    ReadingTrial read{{}, left_by({}).sum()};
    if (!(read.left > little * errors_.of_nothing())) return read;
    const ReadingSearch search{
        robot_, [this](int joint) { return turns_of(robot_, joint); },
        [this](const JointReadings& with, const ReadingTrial& before) -> std::optional<double> {
          const Eigen::VectorXd left = left_by(with);
          if (!(left.sum() < clearly_better * before.left)) return std::nullopt;
          if (!are_less(left, left_by(before.readings))) return std::nullopt;
          return left.sum();
        },
        as_good};
    while (const std::optional<ReadingTrial> next = search.best_beside(read)) read = *next;
    return read;
  }

 private:
  [[nodiscard]] JointReadings sought_on_fixed_base() const {
    ReadingTrial read{{}, left_by({}).sum()};
    const double torque = errors_.of_nothing();
    if (!(read.left > badly * torque)) return {};
    const double enough = far_better * read.left;
    const ReadingSearch search{
        robot_, [this](int joint) { return turns_of(robot_, joint); },
        [this](const JointReadings& with, const ReadingTrial& before) -> std::optional<double> {
          const double left = left_by(with).sum();
          if (!(left < far_better * before.left)) return std::nullopt;
          return left;
        },
        far_better};
    while (const std::optional<ReadingTrial> next = search.best_beside(read)) read = *next;
    const bool is_well = read.left < well * torque;
    if (read.readings.empty() || !is_well || !(read.left < best_on_its_side(enough))) return {};
    return read.readings;
  }

  /// What the given links leave on a base that stands on its side, if it is less than `error`.
  [[nodiscard]] double best_on_its_side(double error) const {
    for (const AppliedEffect& turn : bases_on_their_side()) {
      error = std::min(error, errors_.with(turn));
    }
    return error;
  }

  [[nodiscard]] Eigen::VectorXd left_by(const JointReadings& readings) const {
    return errors_.of_parts([&readings](Sample& sample) {
      for (const JointReading& reading : readings) reading.apply(sample);
    });
  }

  const Robot& robot_;
  GivenErrors errors_;
};

}  // namespace

double left_by_other_signs(const Robot& robot, const Recording& recording,
                           ContactTreatment contacts) {
  return ByGivenLinks(robot, recording, contacts).sought_beside_feet().left;
}

void check_joint_readings(const Robot& robot, const Recording& recording,
                          ContactTreatment contacts) {
  const JointReadings readings = ByGivenLinks(robot, recording, contacts).sought();
  if (readings.empty()) return;
  const bool legs = robot.root == Root::floating;
  if (std::ranges::any_of(readings, &JointReading::turns_a_sign)) {
    throw Refusal("joint-sign",
                  fmt::format("the given model predicts the logged torque far better if joints are "
                              "read otherwise ({}{}): turn them in the mapping (sign: -1, offset), "
                              "or their axes in the URDF{}",
                              words_of(readings, robot), legs ? ", or others of that leg" : "",
                              legs ? "; or the IMU is turned" : ""));
  }
  throw Refusal("joint-zero",
                fmt::format("the given model predicts the logged torque far better if joints are "
                            "read further ({}): their zeros are not the URDF's (add that to q in "
                            "the mapping: offset), or its centres of mass are turned about them",
                            words_of(readings, robot)));
}

}  // namespace shapeid::diagnosis
