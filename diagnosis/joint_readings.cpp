#include "shapeid/diagnosis/joint_readings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "shapeid/diagnosis/joint_reading.hpp"
#include "shapeid/diagnosis/quarter_turns.hpp"
#include "shapeid/diagnosis/rich_model.hpp"
#include "shapeid/diagnosis/series.hpp"
#include "shapeid/diagnosis/tally.hpp"
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
      : robot_(robot), recording_(recording), viewer_(robot, rows, {}) {
    for (const std::size_t i : recording.usable(stride())) {
      samples_.push_back(recording[i]);
      surroundings_.push_back(recording.surroundings(i));
    }
  }

  /// Joints that should be read otherwise, the strongest first; none if that is not far better.
  [[nodiscard]] JointReadings sought() const {
    return robot_.root == Root::fixed ? sought_on_fixed_base() : sought_beside_feet();
  }

 private:
  [[nodiscard]] JointReadings sought_on_fixed_base() const {
    ReadingTrial read{{}, given_errors({}).sum()};
    const double torque = squared_torque();
    if (!(read.left > badly * torque)) return {};
    const double enough = far_better * read.left;
    const ReadingSearch search{
        robot_, [this](int joint) { return turns_of(robot_, joint); },
        [this](const JointReadings& with, const ReadingTrial& before) -> std::optional<double> {
          const double left = given_errors(with).sum();
          if (!(left < far_better * before.left)) return std::nullopt;
          return left;
        },
        far_better};
    while (const std::optional<ReadingTrial> next = search.best_beside(read)) read = *next;
    const bool is_well = read.left < well * torque;
    if (read.readings.empty() || !is_well || !(read.left < best_on_its_side(enough))) return {};
    return read.readings;
  }

  // Where feet stand a sign is not a matter of a centre of mass, and each block tells. Of measured
  // trots the given links leave a fifth to a third of the squared torque, with a knee of the other
  // sign 1.3 to 2.7 times as much.
  [[nodiscard]] JointReadings sought_beside_feet() const {
    constexpr double clearly_better = 0.8, as_good = 0.9, little = 1e-4;
    ReadingTrial read{{}, given_errors({}).sum()};
    if (!(read.left > little * squared_torque())) return {};
    const ReadingSearch search{
        robot_, [this](int joint) { return turns_of(robot_, joint); },
        [this](const JointReadings& with, const ReadingTrial& before) -> std::optional<double> {
          const Eigen::VectorXd left = given_errors(with);
          if (!(left.sum() < clearly_better * before.left)) return std::nullopt;
          if (!are_less(left, given_errors(before.readings))) return std::nullopt;
          return left.sum();
        },
        as_good};
    while (const std::optional<ReadingTrial> next = search.best_beside(read)) read = *next;
    return read.readings;
  }

  /// What the given links leave on a base that stands on its side, if it is less than `error`.
  [[nodiscard]] double best_on_its_side(double error) const {
    for (const AppliedEffect& turn : bases_on_their_side()) {
      const RichModel turned{stacked_parameters(robot_), {turn}};
      const Series left = series(robot_, viewer_.source(), turned, recording_, stride());
      error = std::min(error, left.residual.squaredNorm());
    }
    return error;
  }

  [[nodiscard]] Eigen::VectorXd given_errors(const JointReadings& readings) const {
    return squared_errors({stacked_parameters(robot_), {}}, readings);
  }
  [[nodiscard]] double squared_torque() const {
    const Eigen::Index numbers = Eigen::Index{10} * robot_.link_count();
    return squared_errors({Eigen::VectorXd::Zero(numbers), {}}, {}).sum();
  }
  /// Of parts of the log.
  [[nodiscard]] Eigen::VectorXd squared_errors(const RichModel& model,
                                               const JointReadings& readings) const {
    constexpr double most_parts = 20.0;
    const double parts = std::clamp(recording_.duration() / shortest_block, 1.0, most_parts);
    const auto count = static_cast<std::size_t>(parts);
    Eigen::VectorXd sums = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(count));
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      Sample read = samples_[i];
      for (const JointReading& reading : readings) reading.apply(read);
      const View view = viewer_.view(read, surroundings_[i]);
      sums[static_cast<Eigen::Index>(i * count / samples_.size())] +=
          residual(viewer_, view, model).tail(robot_.joint_count()).squaredNorm();
    }
    return sums;
  }

  /// Some hundred samples, evenly: for as coarse a question.
  [[nodiscard]] std::size_t stride() const { return recording_.stride_of(600); }

  const Robot& robot_;
  const Recording& recording_;
  Viewer viewer_;
  std::vector<Sample> samples_;
  std::vector<Surroundings> surroundings_;
};

}  // namespace

void check_joint_readings(const Robot& robot, const Recording& recording,
                          ContactTreatment contacts) {
  const JointReadings readings = ByGivenLinks(robot, recording, contacts).sought();
  if (readings.empty()) return;
  if (std::ranges::any_of(readings, &JointReading::turns_a_sign)) {
    throw Refusal("joint-sign",
                  fmt::format("the given model predicts the logged torque far better if joints are "
                              "read otherwise ({}{}): turn them in the mapping (sign: -1, offset), "
                              "or their axes in the URDF",
                              words_of(readings, robot),
                              robot.root == Root::fixed ? "" : ", or others of that leg"));
  }
  throw Refusal("joint-zero",
                fmt::format("the given model predicts the logged torque far better if joints are "
                            "read further ({}): their zeros are not the URDF's (add that to q in "
                            "the mapping: offset), or its centres of mass are turned about them",
                            words_of(readings, robot)));
}

}  // namespace shapeid::diagnosis
