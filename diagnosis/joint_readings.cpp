#include "shapeid/diagnosis/joint_readings.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "shapeid/diagnosis/quarter_turns.hpp"
#include "shapeid/diagnosis/rich_model.hpp"
#include "shapeid/diagnosis/series.hpp"
#include "shapeid/models/error.hpp"

namespace shapeid::diagnosis {
namespace {

/// Of the squared torque: links that are given too heavy do less harm where their weight is along
/// the axes, but predict nothing there. And where the given links predict more than half as it is,
/// a centre of mass that is given a little off an axis, on the other side of it, may gain as much.
constexpr double well = 0.25, badly = 0.5;

/// How a joint's columns should be read.
struct Reading {
  int joint;
  double position_sign = 1.0, torque_sign = 1.0;
  double further = 0.0;  ///< rad, after the sign

  [[nodiscard]] bool turns_a_sign() const { return position_sign < 0.0 || torque_sign < 0.0; }
  [[nodiscard]] int changes() const {
    return (position_sign < 0.0 ? 1 : 0) + (torque_sign < 0.0 ? 1 : 0) + (further != 0.0 ? 1 : 0);
  }

  void apply(Sample& sample) const {
    sample.q[joint] = position_sign * sample.q[joint] + further;
    sample.dq[joint] *= position_sign;
    sample.ddq[joint] *= position_sign;
    sample.tau[joint] *= torque_sign;
  }

  [[nodiscard]] std::string words(const Robot& robot) const {
    std::vector<std::string> parts;
    if (position_sign < 0.0) parts.emplace_back("position of the other sign");
    if (further != 0.0) parts.push_back(fmt::format("{:+.4f} rad", further));
    if (torque_sign < 0.0) parts.emplace_back("torque of the other sign");
    return fmt::format("{} {}", robot.joint(joint).name, fmt::join(parts, " and "));
  }
};

/// All but that of the log. Where feet tell of zeros and signs as well, half a turn is none that a
/// leg could make.
std::vector<Reading> other_readings(const Robot& robot, int joint) {
  std::vector<double> turns = {0.0};
  if (robot.root == Root::fixed && robot.joint(joint).kind != JointKind::prismatic) {
    turns.insert(turns.end(), {-quarter_turn, quarter_turn, 2.0 * quarter_turn});
  }
  std::vector<Reading> others;
  for (const double position_sign : {1.0, -1.0}) {
    for (const double torque_sign : {1.0, -1.0}) {
      for (const double further : turns) {
        const Reading reading{joint, position_sign, torque_sign, further};
        if (reading.changes() > 0) others.push_back(reading);
      }
    }
  }
  return others;
}

class Search {
 public:
  Search(const Robot& robot, const Recording& recording, RowSource rows)
      : robot_(robot), recording_(recording), viewer_(robot, rows, {}) {
    for (const std::size_t i : recording.usable(stride())) {
      samples_.push_back(recording[i]);
      surroundings_.push_back(recording.surroundings(i));
    }
  }

  /// Joints that should be read otherwise, the strongest first; none if that is not far better.
  [[nodiscard]] std::vector<Reading> sought() const {
    std::vector<Reading> readings;
    double error = given_error({});
    const double torque = squared_torque();
    if (!(error > badly * torque)) return {};
    const double enough = far_better * error;
    while (const std::optional<Reading> next = best_beside(readings, error)) {
      readings.push_back(*next);
    }
    const bool is_well = error < well * torque;
    if (readings.empty() || !is_well || !(error < best_on_its_side(enough))) return {};
    return readings;
  }

 private:
  /// Beside these the reading of one more joint with which the given links predict far better than
  /// with `error`, which is then what they leave: of those that are nearly as good as the best one
  /// that changes least. (Half a turn and a torque of the other sign are weight as it was.)
  [[nodiscard]] std::optional<Reading> best_beside(const std::vector<Reading>& readings,
                                                   double& error) const {
    struct Trial {
      Reading reading;
      double left;
    };
    std::vector<Trial> trials;
    for (int j = 0; j < robot_.joint_count(); ++j) {
      const bool is_read = std::ranges::any_of(readings, [j](auto& r) { return r.joint == j; });
      if (is_read) continue;
      for (const Reading& other : other_readings(robot_, j)) {
        std::vector<Reading> with = readings;
        with.push_back(other);
        const double left = given_error(with);
        if (left < far_better * error) trials.push_back({other, left});
      }
    }
    if (trials.empty()) return std::nullopt;
    const double least = std::ranges::min(trials, {}, &Trial::left).left;
    std::erase_if(trials, [&](const Trial& t) { return far_better * t.left > least; });
    const auto order = [](const Trial& t) { return std::pair(t.reading.changes(), t.left); };
    const Trial best = std::ranges::min(trials, {}, order);
    error = best.left;
    return best.reading;
  }

  /// What the given links leave on a base that stands on its side, if it is less than `error`.
  [[nodiscard]] double best_on_its_side(double error) const {
    if (robot_.root != Root::fixed) return error;
    for (const AppliedEffect& turn : bases_on_their_side()) {
      const RichModel turned{stacked_parameters(robot_), {turn}};
      const Series left = series(robot_, viewer_.source(), turned, recording_, stride());
      error = std::min(error, left.residual.squaredNorm());
    }
    return error;
  }

  [[nodiscard]] double given_error(const std::vector<Reading>& readings) const {
    return squared_error({stacked_parameters(robot_), {}}, readings);
  }
  [[nodiscard]] double squared_torque() const {
    const Eigen::Index numbers = Eigen::Index{10} * robot_.link_count();
    return squared_error({Eigen::VectorXd::Zero(numbers), {}}, {});
  }
  [[nodiscard]] double squared_error(const RichModel& model,
                                     const std::vector<Reading>& readings) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      Sample read = samples_[i];
      for (const Reading& reading : readings) reading.apply(read);
      const View view = viewer_.view(read, surroundings_[i]);
      sum += residual(viewer_, view, model).tail(robot_.joint_count()).squaredNorm();
    }
    return sum;
  }

  /// Some hundred samples, evenly: for as coarse a question.
  [[nodiscard]] std::size_t stride() const { return recording_.stride_of(300); }

  const Robot& robot_;
  const Recording& recording_;
  Viewer viewer_;
  std::vector<Sample> samples_;
  std::vector<Surroundings> surroundings_;
};

}  // namespace

void check_joint_readings(const Robot& robot, const Recording& recording,
                          ContactTreatment contacts) {
  const std::vector<Reading> readings = Search(robot, recording, contacts).sought();
  if (readings.empty()) return;
  std::vector<std::string> each;
  each.reserve(readings.size());
  for (const Reading& r : readings) each.push_back(r.words(robot));
  if (std::ranges::any_of(readings, &Reading::turns_a_sign)) {
    throw Refusal("joint-sign",
                  fmt::format("the given model predicts the logged torque far better if joints are "
                              "read otherwise ({}): turn them in the mapping (sign: -1, offset), "
                              "or their axes in the URDF",
                              fmt::join(each, ", ")));
  }
  throw Refusal("joint-zero",
                fmt::format("the given model predicts the logged torque far better if joints are "
                            "read further ({}): their zeros are not the URDF's (add that to q in "
                            "the mapping: offset), or its centres of mass are turned about them",
                            fmt::join(each, ", ")));
}

}  // namespace shapeid::diagnosis
