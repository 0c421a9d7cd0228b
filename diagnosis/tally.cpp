#include "shapeid/diagnosis/tally.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "shapeid/diagnosis/row_sums.hpp"

namespace shapeid::diagnosis {
namespace {

/// The signal's value at a sample, of those that are a factor.
double value_of(const Modulation& modulation, const Recording& recording, std::size_t index,
                const View& view, const PredictedLoad& load) {
  const Eigen::Index j = modulation.joint;
  switch (modulation.signal) {
    case Signal::position:
      return view.sample.q[j];
    case Signal::speed:
      return std::abs(view.sample.dq[j]);
    case Signal::direction: {
      constexpr double width = 0.05;  // rad/s or m/s: where it turns round
      return std::tanh(view.sample.dq[j] / width);
    }
    case Signal::load:
      return load.joint[j];
    case Signal::side:
      return std::tanh(load.joint[j] / light_load(recording, j));
    case Signal::turned:
      return recording.turned(index, j);
    case Signal::peak: {
      const double size = std::abs(load.joint[j]);
      const double high = recording.high_torque(modulation.level, j);
      return size > high ? 1.0 - high / size : 0.0;
    }
    case Signal::time:
      return view.surroundings.elapsed;
    case Signal::row:
    case Signal::yield:
    case Signal::play:
      break;
  }
  return 1.0;
}

/// How far a motor is ahead of its joint, for a number of one, and the second derivative of that.
/// Nothing where the log has no neighbours.
struct Lead {
  double now = 0.0, acceleration = 0.0;
};

/// By the logged torque. Its noise is the residual's, and goes against its own second derivative: a
/// gear would be seen in every log. Readings beyond the filter's reach have other noise. The
/// curvature of the parabola through four of these, `apart` (s) and twice as far away.
Lead lead_of_load(const Recording& recording, std::size_t index, Eigen::Index joint, double apart) {
  const auto k = static_cast<std::size_t>(std::lround(apart * recording.rate()));
  if (k == 0 || !recording.surrounded(index, 2 * k)) return {};
  const auto torque = [&](std::size_t i) { return recording[i].tau[joint]; };
  const double near = torque(index - k) + torque(index + k);
  const double far = torque(index - 2 * k) + torque(index + 2 * k);
  const double h = static_cast<double>(k) / recording.rate();
  return {torque(index), (far - near) / (3.0 * h * h)};
}

/// By the side that drives, of the logged torque: the predicted load feels the acceleration that
/// play only pretends.
Lead lead_of_side(const Recording& recording, std::size_t index, Eigen::Index joint) {
  const auto k = static_cast<std::size_t>(std::lround(0.02 * recording.rate()));
  if (k == 0 || !recording.surrounded(index, k)) return {};
  const auto side = [&](std::size_t i) {
    return lead_of({.signal = Signal::play, .joint = static_cast<int>(joint)}, recording,
                   recording[i].tau[joint]);
  };
  const double h = static_cast<double>(k) / recording.rate();
  return {side(index), (side(index + k) - 2.0 * side(index) + side(index - k)) / (h * h)};
}

}  // namespace

double light_load(const Recording& recording, Eigen::Index joint) {
  constexpr double usual = 0.1, share = 0.1;
  const double often = recording.high_torque(0, joint);
  return often > 0.0 ? std::min(usual, share * often) : usual;
}

double lead_of(const Modulation& gear, const Recording& recording, double load) {
  return gear.signal == Signal::play ? std::tanh(load / light_load(recording, gear.joint)) : load;
}

Eigen::MatrixXd modulated(const Modulation& modulation, const Eigen::MatrixXd& own,
                          const Robot& robot, const Recording& recording, std::size_t index,
                          const View& view, const PredictedLoad& load, double margin) {
  const Eigen::Index j = modulation.joint;
  if (modulation.signal == Signal::row) {
    Eigen::MatrixXd row = Eigen::MatrixXd::Zero(own.rows(), own.cols());
    row.row(robot.base_dof() + j) = own.row(robot.base_dof() + j);
    return row;
  }
  if (!modulation.of_gear()) return value_of(modulation, recording, index, view, load) * own;
  // 40 ms where 15 Hz pass, and without a filter.
  const double apart = std::max(0.04, 1.2 * margin);
  const Lead lead = modulation.signal == Signal::yield ? lead_of_load(recording, index, j, apart)
                                                       : lead_of_side(recording, index, j);
  return -lead.now * own.col(0) - lead.acceleration * own.col(1);
}

Tally empty_tally(const Robot& robot, const std::vector<AppliedEffect>& hypotheses,
                  const std::vector<Modulation>& modulations) {
  Tally tally;
  tally.inertial = Eigen::Index{10} * robot.link_count();
  tally.hypotheses = hypotheses;
  Eigen::Index column = tally.inertial;
  for (const AppliedEffect& h : hypotheses) {
    tally.first.push_back(column);
    column += h.value.size();
  }
  tally.modulations = modulations;
  for (const Modulation& m : modulations) {
    tally.first_modulated.push_back(column);
    column += m.columns_of(hypotheses[m.hypothesis].value.size());
  }
  tally.width = column + 1;
  return tally;
}

void add_to_tally(Tally& tally, const Robot& robot, RowSource source, const RichModel& model,
                  const Recording& recording, const TallyOptions& options, bool reference) {
  const HypothesisColumns hypotheses(robot, source, model, tally.hypotheses);
  const Viewer& viewer = hypotheses.viewer();
  const Eigen::Index width = tally.width;
  ContactFree contact_free(robot, options.weight, source.path);
  RowSums sums(width, robot.dof());
  Block block;
  const auto close = [&] {
    if (block.samples == 0) return;
    block.sums = sums.finish();
    block.reference = reference;
    tally.blocks.push_back(std::move(block));
    block = {};
  };

  const double independent = recording.independent_share(options.stride);
  int number = 0;
  std::size_t log = 0;
  Eigen::MatrixXd M(robot.dof(), width);
  for (const std::size_t index : recording.usable(options.stride)) {
    const double place = recording.recorded(index);
    const int here = static_cast<int>(place / options.block_seconds);
    const std::size_t log_before = log;
    while (log < options.log_starts.size() && index >= options.log_starts[log]) ++log;
    if (here != number || log != log_before) close();
    number = here;
    if (place - here * options.block_seconds > options.block_seconds - options.margin) continue;

    const View view = viewer.view(recording, index);
    const auto counted = counted_rows(viewer, recording, index, view);
    if (!counted.any()) continue;
    const Prediction predicted = predict(viewer, view, model);
    Rows rows{Eigen::MatrixXd(robot.dof(), tally.inertial + 1), view.J};
    rows.E << view.Y, view.carried;
    viewer.transform(view, rows);
    M.leftCols(tally.inertial) = rows.E.leftCols(tally.inertial);
    M.middleCols(tally.inertial, hypotheses.count()) =
        hypotheses.at(recording, index, view, predicted);
    for (std::size_t k = 0; k < tally.modulations.size(); ++k) {
      const Modulation& m = tally.modulations[k];
      const Eigen::Index n = tally.hypotheses[m.hypothesis].value.size();
      M.middleCols(tally.first_modulated[k], m.columns_of(n)) =
          modulated(m, M.middleCols(tally.first[m.hypothesis], n), robot, recording, index, view,
                    predicted.load, options.margin);
    }
    M.rightCols<1>() = logged_force(viewer, view) + rows.E.rightCols<1>();
    for (Eigen::Index row = 0; row < M.rows(); ++row) {
      if (!counted[row]) M.row(row).setZero();
    }
    const Eigen::MatrixXd beyond = contact_free(rows.J, M);
    sums.add(beyond);
    block.freedom +=
        independent * static_cast<double>(std::min<Eigen::Index>(beyond.rows(), counted.count()));
    if (block.samples++ > 0) continue;
    block.from = recording.elapsed(index);
    block.log = log;
  }
  close();
}

}  // namespace shapeid::diagnosis
