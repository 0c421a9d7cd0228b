#include "shapeid/diagnosis/tally.hpp"

#include <cmath>

#include "shapeid/reference/projection.hpp"

namespace shapeid::diagnosis {
namespace {

/// Sums of rows, taken many at a time.
class RowSums {
 public:
  RowSums(Eigen::Index columns, Eigen::Index tallest)
      : rows_(2 * columns + tallest, columns), sums_(Eigen::MatrixXd::Zero(columns, columns)) {}

  void add(const Eigen::MatrixXd& rows) {
    if (used_ + rows.rows() > rows_.rows()) flush();
    rows_.middleRows(used_, rows.rows()) = rows;
    used_ += rows.rows();
  }

  Eigen::MatrixXd finish() {
    flush();
    Eigen::MatrixXd whole = sums_.selfadjointView<Eigen::Lower>();
    sums_.setZero();
    return whole;
  }

 private:
  void flush() {
    sums_.selfadjointView<Eigen::Lower>().rankUpdate(rows_.topRows(used_).transpose());
    used_ = 0;
  }

  Eigen::MatrixXd rows_, sums_;
  Eigen::Index used_ = 0;
};

/// Fills the columns of the modulations from those of the hypotheses.
void modulate(const Tally& tally, const Robot& robot, const Recording& recording, std::size_t index,
              const View& view, const PredictedLoad& load, Eigen::MatrixXd& M) {
  for (std::size_t k = 0; k < tally.modulations.size(); ++k) {
    const Modulation& modulation = tally.modulations[k];
    const Eigen::Index n = tally.hypotheses[modulation.hypothesis].value.size();
    const auto from = M.middleCols(tally.first[modulation.hypothesis], n);
    auto to = M.middleCols(tally.first_modulated[k], n);
    if (modulation.signal == Signal::row) {
      const Eigen::Index row = robot.base_dof() + modulation.joint;
      to.setZero();
      to.row(row) = from.row(row);
    } else {
      to = value_of(modulation, recording, index, view, load) * from;
    }
  }
}

}  // namespace

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
    case Signal::side: {
      constexpr double width = 0.1;  // N m or N: teeth and brushes do not change sides at once
      return std::tanh(load.joint[j] / width);
    }
    case Signal::turned:
      return recording.turned(index, j);
    case Signal::peak: {
      const double size = std::abs(load.joint[j]);
      const double high = recording.high_torque(modulation.level, j);
      return size > high ? 1.0 - high / size : 0.0;
    }
    case Signal::time:
      return view.elapsed;
    case Signal::row:
      break;
  }
  return 1.0;
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
    column += hypotheses[m.hypothesis].value.size();
  }
  tally.width = column + 1;
  return tally;
}

void add_to_tally(Tally& tally, const Robot& robot, reference::ContactTreatment contacts,
                  const RichModel& model, const Recording& recording, const TallyOptions& options,
                  bool reference) {
  const HypothesisColumns hypotheses(robot, contacts, model, tally.hypotheses);
  const Viewer& viewer = hypotheses.viewer();
  const Eigen::Index width = tally.width;
  const Eigen::VectorXd root = options.weight.cwiseSqrt();
  RowSums sums(width, robot.dof());
  Block block;
  const auto close = [&] {
    if (block.samples == 0) return;
    block.sums = sums.finish();
    block.reference = reference;
    tally.blocks.push_back(block);
    block = {};
  };

  int number = 0;
  std::size_t log = 0;
  Eigen::MatrixXd M(robot.dof(), width);
  for (const std::size_t index : recording.usable(options.stride)) {
    const double elapsed = recording.elapsed(index);
    const int here = static_cast<int>(elapsed / options.block_seconds);
    const std::size_t log_before = log;
    while (log < options.log_starts.size() && index >= options.log_starts[log]) ++log;
    if (here != number || log != log_before) close();
    number = here;
    if (elapsed - here * options.block_seconds > options.block_seconds - options.margin) continue;

    const View view = viewer.view(recording, index);
    const auto counted = counted_rows(viewer, recording, index, view);
    if (!counted.any()) continue;
    const Prediction predicted = predict(viewer, view, model);
    Rows rows{view.Y, view.J};
    viewer.transform(view, rows);
    M.leftCols(tally.inertial) = rows.E;
    M.middleCols(tally.inertial, hypotheses.count()) =
        hypotheses.at(recording, index, view, predicted);
    modulate(tally, robot, recording, index, view, predicted.load, M);
    M.rightCols<1>() = logged_force(viewer, view);
    for (Eigen::Index row = 0; row < M.rows(); ++row) {
      if (!counted[row]) M.row(row).setZero();
    }
    const Eigen::MatrixXd Q2 = reference::contact_free_basis(rows.J, options.weight).Q2;
    sums.add(Q2.transpose() * (root.asDiagonal() * M));
    if (block.samples++ > 0) continue;
    block.from = elapsed;
    block.log = log;
  }
  close();
}

}  // namespace shapeid::diagnosis
