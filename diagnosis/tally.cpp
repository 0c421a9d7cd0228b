#include "shapeid/diagnosis/tally.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "shapeid/diagnosis/in_parallel.hpp"
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

/// Samples of which a block may have rows.
struct Stretch {
  std::size_t log = 0;
  std::vector<std::size_t> samples;
};

std::vector<Stretch> stretches_of(const Recording& recording, const TallyOptions& options) {
  std::vector<Stretch> list;
  int number = 0;
  std::size_t log = 0;
  for (const std::size_t index : recording.usable(options.stride)) {
    const double place = recording.recorded(index);
    const int here = static_cast<int>(place / options.block_seconds);
    const std::size_t log_before = log;
    while (log < options.log_starts.size() && index >= options.log_starts[log]) ++log;
    if (list.empty() || here != number || log != log_before) list.push_back({log, {}});
    number = here;
    if (place - here * options.block_seconds > options.block_seconds - options.margin) continue;
    list.back().samples.push_back(index);
  }
  return list;
}

/// Sums one block after another; all arguments must outlive it. What it computes rows with is not
/// for several threads at once, so each has its own.
class BlockSummer {
 public:
  BlockSummer(const Tally& tally, const Robot& robot, RowSource source, const RichModel& model,
              const Recording& recording, const TallyOptions& options)
      : tally_(tally),
        robot_(robot),
        model_(model),
        recording_(recording),
        margin_(options.margin),
        independent_(recording.independent_share(options.stride)),
        hypotheses_(robot, source, model, tally.hypotheses),
        contact_free_(robot, options.weight, source.path),
        sums_(tally.width, robot.dof()),
        M_(robot.dof(), tally.width) {}

  /// Without samples if no row of any counts.
  Block sum(const Stretch& stretch) {
    Block block;
    block.log = stretch.log;
    for (const std::size_t index : stretch.samples) add(index, block);
    if (block.samples > 0) block.sums = sums_.finish();
    return block;
  }

 private:
  void add(std::size_t index, Block& block) {
    const Viewer& viewer = hypotheses_.viewer();
    const View view = viewer.view(recording_, index);
    const auto counted = counted_rows(viewer, recording_, index, view);
    if (!counted.any()) return;
    const Prediction predicted = predict(viewer, view, model_);
    Rows rows{Eigen::MatrixXd(robot_.dof(), tally_.inertial + 1), view.J};
    rows.E << view.Y, view.carried;
    viewer.transform(view, rows);
    M_.leftCols(tally_.inertial) = rows.E.leftCols(tally_.inertial);
    M_.middleCols(tally_.inertial, hypotheses_.count()) =
        hypotheses_.at(recording_, index, view, predicted);
    for (std::size_t k = 0; k < tally_.modulations.size(); ++k) {
      const Modulation& m = tally_.modulations[k];
      const Eigen::Index n = tally_.hypotheses[m.hypothesis].value.size();
      M_.middleCols(tally_.first_modulated[k], m.columns_of(n)) =
          modulated(m, M_.middleCols(tally_.first[m.hypothesis], n), robot_, recording_, index,
                    view, predicted.load, margin_);
    }
    M_.rightCols<1>() = logged_force(viewer, view) + rows.E.rightCols<1>();
    for (Eigen::Index row = 0; row < M_.rows(); ++row) {
      if (!counted[row]) M_.row(row).setZero();
    }
    const Eigen::MatrixXd beyond = contact_free_(rows.J, M_);
    sums_.add(beyond);
    block.freedom +=
        independent_ * static_cast<double>(std::min<Eigen::Index>(beyond.rows(), counted.count()));
    if (block.samples++ == 0) block.from = recording_.elapsed(index);
  }

  const Tally& tally_;
  const Robot& robot_;
  const RichModel& model_;
  const Recording& recording_;
  const double margin_, independent_;
  const HypothesisColumns hypotheses_;
  ContactFree contact_free_;
  RowSums sums_;
  Eigen::MatrixXd M_;
};

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

Tally with_first(const Tally& tally, std::size_t hypotheses) {
  Tally result = tally;
  result.hypotheses.resize(hypotheses);
  result.first.resize(hypotheses);
  result.modulations.clear();
  result.first_modulated.clear();
  Eigen::Index columns = tally.inertial;
  for (const AppliedEffect& h : result.hypotheses) columns += h.value.size();
  std::vector<Eigen::Index> kept(static_cast<std::size_t>(columns));
  std::iota(kept.begin(), kept.end(), Eigen::Index{0});
  kept.push_back(tally.columns());
  result.width = std::ssize(kept);
  for (Block& block : result.blocks) block.sums = Eigen::MatrixXd(block.sums(kept, kept));
  return result;
}

void add_to_tally(Tally& tally, const Robot& robot, RowSource source, const RichModel& model,
                  const Recording& recording, const TallyOptions& options, bool reference) {
  const std::vector<Stretch> stretches = stretches_of(recording, options);
  std::vector<Block> blocks(stretches.size());
  const std::size_t parts = std::max<std::size_t>(1, std::min(options.threads, blocks.size()));
  in_parallel(parts, parts, [&](std::size_t part) {
    BlockSummer summer(tally, robot, source, model, recording, options);
    for (std::size_t b = part * blocks.size() / parts; b < (part + 1) * blocks.size() / parts;
         ++b) {
      blocks[b] = summer.sum(stretches[b]);
    }
  });
  for (Block& block : blocks) {
    if (block.samples == 0) continue;
    block.reference = reference;
    tally.blocks.push_back(std::move(block));
  }
}

}  // namespace shapeid::diagnosis
