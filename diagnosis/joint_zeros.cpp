#include "shapeid/diagnosis/joint_zeros.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "shapeid/diagnosis/effects.hpp"
#include "shapeid/diagnosis/quarter_turns.hpp"
#include "shapeid/diagnosis/series.hpp"
#include "shapeid/models/error.hpp"

namespace shapeid::diagnosis {
namespace {

/// Of the squared torque: links that are given too heavy do less harm where their weight is along
/// the axes, but predict nothing there. And where the given links predict more than half as it is,
/// a centre of mass that is given a little off an axis, on the other side of it, may gain as much.
constexpr double well = 0.25, badly = 0.5;

class Zeros {
 public:
  Zeros(const Robot& robot, const Recording& recording, RowSource rows)
      : robot_(robot), recording_(recording), rows_(rows) {}

  /// Joints that should be read further, the strongest first; none if that is not far better.
  [[nodiscard]] std::vector<AppliedEffect> sought() const {
    std::vector<AppliedEffect> turns;
    double error = given_error({});
    const double torque = squared_torque();
    if (!(error > badly * torque)) return {};
    const double enough = far_better * error;
    while (const std::optional<AppliedEffect> next = best_turn(turns, error)) {
      turns.push_back(*next);
    }
    const bool is_well = error < well * torque;
    if (turns.empty() || !is_well || !(error < best_on_its_side(enough))) return {};
    return turns;
  }

 private:
  /// Beside these the turn of one more joint with which the given links predict best, if that is
  /// far better than `error`, which is then what they leave.
  [[nodiscard]] std::optional<AppliedEffect> best_turn(const std::vector<AppliedEffect>& turns,
                                                       double& error) const {
    double least = far_better * error;
    std::optional<AppliedEffect> best;
    for (int j = 0; j < robot_.joint_count(); ++j) {
      AppliedEffect turn = at_start(*find_effect("encoder_offset"), j);
      if (robot_.joint(j).kind == JointKind::prismatic) continue;
      for (const double angle : {-quarter_turn, quarter_turn, 2.0 * quarter_turn}) {
        turn.value[0] = angle;
        std::vector<AppliedEffect> with = turns;
        with.push_back(turn);
        const double left = given_error(with);
        if (!(left < least)) continue;
        least = left;
        best = turn;
      }
    }
    if (best) error = least;
    return best;
  }

  /// What the given links leave on a base that stands on its side, if it is less than `error`.
  [[nodiscard]] double best_on_its_side(double error) const {
    for (const AppliedEffect& turn : bases_on_their_side()) {
      error = std::min(error, given_error({turn}));
    }
    return error;
  }

  [[nodiscard]] double given_error(const std::vector<AppliedEffect>& effects) const {
    return squared_error({stacked_parameters(robot_), effects});
  }
  [[nodiscard]] double squared_torque() const {
    return squared_error({Eigen::VectorXd::Zero(Eigen::Index{10} * robot_.link_count()), {}});
  }
  /// On some hundred samples, evenly: for as coarse a question.
  [[nodiscard]] double squared_error(const RichModel& model) const {
    const std::size_t stride = recording_.stride_of(300);
    return series(robot_, rows_, model, recording_, stride).residual.squaredNorm();
  }

  const Robot& robot_;
  const Recording& recording_;
  RowSource rows_;
};

}  // namespace

void check_joint_zeros(const Robot& robot, const Recording& recording, ContactTreatment contacts) {
  if (robot.root != Root::fixed) return;
  const std::vector<AppliedEffect> turns = Zeros(robot, recording, contacts).sought();
  if (turns.empty()) return;
  std::vector<std::string> each;
  each.reserve(turns.size());
  for (const AppliedEffect& a : turns) {
    each.push_back(fmt::format("{} {:+.4f} rad", robot.joint(a.site).name, a.value[0]));
  }
  throw Refusal("joint-zero",
                fmt::format("the given model predicts the logged torque far better if joints are "
                            "read further ({}): their zeros are not the URDF's (add that to q in "
                            "the mapping: offset), or its centres of mass are turned about them",
                            fmt::join(each, ", ")));
}

}  // namespace shapeid::diagnosis
