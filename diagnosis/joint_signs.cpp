#include "shapeid/diagnosis/joint_signs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "shapeid/diagnosis/effects.hpp"
#include "shapeid/diagnosis/given_errors.hpp"
#include "shapeid/diagnosis/joint_reading.hpp"
#include "shapeid/diagnosis/loop_state.hpp"
#include "shapeid/diagnosis/quarter_turns.hpp"
#include "shapeid/models/error.hpp"

namespace shapeid::diagnosis {
namespace {

/// Squared errors of masses on blocks that they were not fitted to.
class ByFittedMasses {
 public:
  ByFittedMasses(const Robot& robot, const Recording& recording, const LoopSettings& settings)
      : robot_(robot), recording_(recording), settings_(settings) {
    // Some thousand samples, evenly: for as coarse a question, asked a hundred times.
    settings_.stride = std::max(settings.stride, recording.stride_of(3000));
  }

  /// Joints that should be read otherwise, the strongest first.
  [[nodiscard]] JointReadings sought() const {
    // A log that is predicted to a hundredth is read as it is meant; of a simulator's what is left
    // may be rounding.
    constexpr double little = 1e-4;
    const ReadingTrial as_logged{{}, held_out({}).sum()};
    if (!(as_logged.left > little * squared_torque())) return {};
    const ReadingSearch search{
        robot_, [](int) { return std::vector<double>{0.0}; },
        [this](const JointReadings& with, const ReadingTrial& before) -> std::optional<double> {
          const Eigen::VectorXd left = held_out(with);
          if (!(left.sum() < far_better * before.left)) return std::nullopt;
          if (!are_less(left, held_out(before.readings))) return std::nullopt;
          return left.sum();
        },
        far_better};
    std::optional<ReadingTrial> read = search.best_beside(as_logged);
    if (!read) return {};
    // Beside another joint of the other sign masses may fit best with this one read wrongly.
    const std::optional<ReadingTrial> two = search.best_beside(as_logged, 2);
    if (two && two->left < far_better * read->left) read = two;
    while (const std::optional<ReadingTrial> next = search.best_beside(*read)) read = next;
    if (!(read->left < far_better * least_on_turned_base())) return {};
    return read->readings;
  }

 private:
  [[nodiscard]] Eigen::VectorXd held_out(const JointReadings& readings,
                                         const std::vector<AppliedEffect>& effects = {}) const {
    std::vector<Sample> samples = recording_.samples();
    for (Sample& sample : samples) {
      for (const JointReading& reading : readings) reading.apply(sample);
    }
    LoopState state(robot_, {std::move(samples), recording_.rate()}, nullptr, settings_);
    state.result.model.effects = effects;
    return state.tallied({}).held_out({state.masses});
  }
  /// As logged, with the base turned into 32 directions, an eighth of a turn apart: gravity from
  /// elsewhere is no wrong sign.
  [[nodiscard]] double least_on_turned_base() const {
    AppliedEffect turn = at_start(*find_effect("gravity_tilt"), 0);
    double least = std::numeric_limits<double>::infinity();
    constexpr double eighth_turn = 0.5 * quarter_turn;
    for (int azimuth = 0; azimuth < 8; ++azimuth) {
      for (int tilt = 1; tilt <= 4; ++tilt) {
        turn.value[0] = tilt * eighth_turn * std::cos(azimuth * eighth_turn);
        turn.value[1] = tilt * eighth_turn * std::sin(azimuth * eighth_turn);
        least = std::min(least, held_out({}, {turn}).sum());
      }
    }
    return least;
  }
  /// Of what is weighed as the errors are.
  [[nodiscard]] double squared_torque() const {
    Eigen::VectorXd squares = Eigen::VectorXd::Zero(robot_.dof());
    for (const std::size_t i : recording_.usable(settings_.stride)) {
      squares += recording_[i].tau.cwiseAbs2();
    }
    return settings_.weight.size() > 0 ? squares.dot(settings_.weight) : squares.sum();
  }

  const Robot& robot_;
  const Recording& recording_;
  LoopSettings settings_;
};

}  // namespace

void check_joint_signs(const Robot& robot, const Recording& recording,
                       const LoopSettings& settings) {
  if (robot.root != Root::fixed) return;
  const JointReadings readings = ByFittedMasses(robot, recording, settings).sought();
  if (readings.empty()) return;
  throw Refusal("joint-sign",
                fmt::format("masses that are fitted predict the logged torque far better if joints "
                            "are read otherwise ({}): turn them in the mapping (sign: -1), or "
                            "their axes in the URDF",
                            words_of(readings, robot)));
}

}  // namespace shapeid::diagnosis
