#include "shapeid/tests/blind/parts/yardstick.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <limits>

#include "shapeid/diagnosis/effects.hpp"
#include "shapeid/diagnosis/hypotheses.hpp"
#include "shapeid/models/motion.hpp"
#include "shapeid/reference/projection.hpp"

namespace shapeid::blind {
namespace {

using diagnosis::AppliedEffect;
using diagnosis::Recording;
using diagnosis::RichModel;
using diagnosis::View;
using diagnosis::Viewer;

ContactTreatment contacts(const Machine& machine) {
  return machine.robot.contacts.empty() ? ContactTreatment::ignore : ContactTreatment::project;
}

std::vector<Eigen::Index> free_columns(const Machine& machine) {
  std::vector<Eigen::Index> columns;
  for (const int link : machine.free_links) {
    for (Eigen::Index p = 0; p < 10; ++p) columns.push_back(Eigen::Index{10} * link + p);
  }
  return columns;
}

/// Rows of a log: deviations of the free masses, a change of the log, and what the model leaves.
struct Block {
  Eigen::MatrixXd gram;  ///< of [Y_free, change, residual]
};

/// Half a second each.
std::vector<Block> blocks_of(const Machine& machine, const Recording& log, const RichModel& model,
                             const Eigen::MatrixXd& change) {
  const Viewer viewer(machine.robot, contacts(machine), model.effects);
  const auto indices = log.usable(1);
  const auto columns = free_columns(machine);
  const auto free = static_cast<Eigen::Index>(columns.size());
  const Eigen::Index dof = machine.robot.dof();
  // Every row counts by what the model leaves in it.
  Eigen::VectorXd weight = Eigen::VectorXd::Zero(dof);
  std::vector<View> views;
  for (const std::size_t i : indices) {
    views.push_back(viewer.view(log, i));
    weight += diagnosis::residual(viewer, views.back(), model).cwiseAbs2();
  }
  const double floor = 1e-3 * weight.mean();
  weight = static_cast<double>(indices.size()) * weight.cwiseMax(floor).cwiseInverse();

  constexpr double seconds = 0.5;
  std::vector<Block> blocks;
  int number = -1;
  for (std::size_t i = 0; i < indices.size(); ++i) {
    const int here = static_cast<int>(log.elapsed(indices[i]) / seconds);
    if (here != number) blocks.push_back({Eigen::MatrixXd::Zero(free + 2, free + 2)});
    number = here;
    const View& view = views[i];
    const diagnosis::Prediction predicted = diagnosis::predict(viewer, view, model);
    diagnosis::Rows rows{view.Y, view.J};
    viewer.transform(view, rows);
    Eigen::MatrixXd M(dof, free + 2);
    M.leftCols(free) = rows.E(Eigen::all, columns);
    M.col(free) = change.col(static_cast<Eigen::Index>(i));
    M.col(free + 1) = diagnosis::logged_force(viewer, view) - predicted.force;
    const Eigen::MatrixXd Q2 = reference::contact_free_basis(rows.J, weight).Q2;
    const Eigen::MatrixXd R = Q2.transpose() * weight.cwiseSqrt().asDiagonal() * M;
    blocks.back().gram += R.transpose() * R;
  }
  return blocks;
}

/// Inverse covariance that masses may have about those of the model: a quarter of each, and lengths
/// of a decimetre.
Eigen::MatrixXd precision(const Machine& machine) {
  Eigen::VectorXd p(10 * std::ssize(machine.free_links));
  for (std::size_t i = 0; i < machine.free_links.size(); ++i) {
    const double m =
        0.25 * machine.robot.links[static_cast<std::size_t>(machine.free_links[i])].inertia.mass();
    constexpr double length = 0.1;
    const auto at = 10 * static_cast<Eigen::Index>(i);
    p[at] = 1.0 / (m * m);
    p.segment<3>(at + 1).setConstant(std::pow(m * length, -2));
    p.segment<6>(at + 4).setConstant(std::pow(m * length * length, -2));
  }
  return p.asDiagonal();
}

/// Inverse covariance of how far inertias are off that are drawn as given ones are, about these.
Eigen::MatrixXd precision_of_given(const Machine& machine, const Robot& given) {
  Machine about = machine;
  about.robot = given;
  constexpr int draws = 1000;
  std::vector<Eigen::MatrixXd> off(machine.free_links.size(), Eigen::MatrixXd(10, draws));
  for (int d = 0; d < draws; ++d) {
    const auto drawn = wrong_inertias(about, static_cast<std::uint64_t>(d));
    for (std::size_t i = 0; i < drawn.size(); ++i) {
      const auto link = static_cast<std::size_t>(machine.free_links[i]);
      off[i].col(d) = drawn[i].values - given.links[link].inertia.values;
    }
  }
  Eigen::MatrixXd P = Eigen::MatrixXd::Zero(10 * std::ssize(off), 10 * std::ssize(off));
  for (std::size_t i = 0; i < off.size(); ++i) {
    // Each number in its own size, for they differ by some thousands.
    const Eigen::VectorXd size = off[i].rowwise().norm() / std::sqrt(double{draws});
    const Eigen::MatrixXd scaled = size.cwiseInverse().asDiagonal() * off[i];
    const Eigen::MatrixXd inverse = (scaled * scaled.transpose() / double{draws})
                                        .ldlt()
                                        .solve(Eigen::MatrixXd::Identity(10, 10));
    const auto at = 10 * static_cast<Eigen::Index>(i);
    P.block(at, at, 10, 10) =
        size.cwiseInverse().asDiagonal() * inverse * size.cwiseInverse().asDiagonal();
  }
  return P;
}

/// Masses for [change, residual] as targets, of all blocks but those from `first` to `last`, and of
/// `others`.
Eigen::MatrixXd masses(const std::vector<Block>& blocks, const Eigen::MatrixXd& prior,
                       std::size_t first, std::size_t last, const std::vector<Block>& others = {}) {
  const Eigen::Index n = prior.rows();
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(n + 2, n + 2);
  for (const Block& other : others) sum += other.gram;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    if (b < first || b >= last) sum += blocks[b].gram;
  }
  const Eigen::MatrixXd N = sum.topLeftCorner(n, n) + prior;
  return N.ldlt().solve(sum.topRightCorner(n, 2));
}

/// s with t(s) = limit for the gains 2 s q + s^2 p of the blocks.
double size_at(const Eigen::VectorXd& p, const Eigen::VectorXd& q, double limit) {
  const auto t = [&](double s) {
    const Eigen::VectorXd d = 2.0 * s * q + s * s * p;
    const Eigen::VectorXd c = d.array() - d.mean();
    const auto n = static_cast<double>(d.size());
    double variance = c.squaredNorm();
    variance += 2.0 * std::max(0.0, c.head(c.size() - 1).dot(c.tail(c.size() - 1)));
    return d.sum() / std::sqrt(variance * n / (n - 1.0));
  };
  constexpr double largest = 1e6;
  double high = largest;
  if (!(t(high) > limit)) return std::numeric_limits<double>::infinity();
  double low = 1e-9;
  constexpr int halvings = 60;
  for (int i = 0; i < halvings; ++i) {
    const double middle = std::sqrt(low * high);
    (t(middle) > limit ? high : low) = middle;
  }
  return high;
}

}  // namespace

Recording read_log(const Machine& machine, const std::string& path) {
  MotionOptions options;
  options.cutoff = machine.cutoff;
  MotionReader reader(path, machine.robot, machine.notes, std::nullopt, options);
  std::vector<Sample> samples;
  while (std::optional<Sample> s = reader.next()) samples.push_back(*s);
  return {std::move(samples), reader.report().rate, reader.report().extra};
}

AppliedEffect applied(const Machine& machine, const Item& item) {
  const Kind& k = kind(item.kind);
  AppliedEffect a = diagnosis::at_start(*diagnosis::find_effect(k.id), item.amount.site);
  const std::vector<double> values = k.values(machine, item.amount);
  a.value = Eigen::Map<const Eigen::VectorXd>(values.data(), std::ssize(values));
  a.shape = Eigen::Map<const Eigen::VectorXd>(k.shape.data(), std::ssize(k.shape));
  return a;
}

Eigen::MatrixXd unit_change(const Machine& machine, const Item& item,
                            const Readings& clean_readings, const Recording& clean,
                            const std::string& scratch_folder, std::uint64_t noise_seed) {
  const auto indices = clean.usable(1);
  Eigen::MatrixXd change(machine.robot.dof(), std::ssize(indices));
  const RichModel truth{stacked_parameters(machine.robot), {}};
  const Viewer viewer(machine.robot, contacts(machine), {});
  Item unit = item;
  if (kind(item.kind).foreign) {
    Readings readings = clean_readings;
    change_signals(machine, {unit}, readings);
    Trial trial;
    trial.noise_seed = noise_seed;
    write_logs(machine, trial, readings, scratch_folder);
    const Recording changed = read_log(machine, scratch_folder + "/log.csv");
    for (std::size_t i = 0; i < indices.size(); ++i) {
      const View a = viewer.view(clean, indices[i]), b = viewer.view(changed, indices[i]);
      const auto missing = [&](const View& v) -> Eigen::VectorXd {
        return diagnosis::logged_force(viewer, v) - v.Y * truth.Phi;
      };
      change.col(static_cast<Eigen::Index>(i)) = (missing(b) - missing(a)) / unit.amount.size;
    }
    return change;
  }
  unit.amount.size = 1.0;
  AppliedEffect effect = applied(machine, unit);
  const Eigen::VectorXd value = effect.value;
  effect.value.setZero();
  const diagnosis::HypothesisColumns columns(machine.robot, contacts(machine), truth, {effect});
  for (std::size_t i = 0; i < indices.size(); ++i) {
    const View view = columns.viewer().view(clean, indices[i]);
    const diagnosis::Prediction predicted = diagnosis::predict(columns.viewer(), view, truth);
    change.col(static_cast<Eigen::Index>(i)) =
        columns.at(clean, indices[i], view, predicted) * value;
  }
  return change;
}

double detectable_size(const Machine& machine, const Recording& clean,
                       const Eigen::MatrixXd& unit_change, const Recording* without) {
  const RichModel truth{stacked_parameters(machine.robot), {}};
  const std::vector<Block> blocks = blocks_of(machine, clean, truth, unit_change);
  const Eigen::MatrixXd prior = precision(machine);
  const Eigen::Index n = prior.rows();
  std::vector<Block> others;
  if (without != nullptr) {
    const Eigen::MatrixXd nothing =
        Eigen::MatrixXd::Zero(machine.robot.dof(), std::ssize(without->usable(1)));
    others = blocks_of(machine, *without, truth, nothing);
  }
  Eigen::VectorXd p(std::ssize(blocks)), q(p.size());
  constexpr std::size_t folds = 8;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const std::size_t fold = b * folds / blocks.size();
    const auto start = [&](std::size_t f) { return (f * blocks.size() + folds - 1) / folds; };
    const Eigen::MatrixXd x = masses(blocks, prior, start(fold), start(fold + 1), others);
    // What is left of the change and of the residual, each after its own masses.
    Eigen::MatrixXd left(n + 2, 2);
    left << -x, Eigen::Matrix2d::Identity();
    const Eigen::Matrix2d G = left.transpose() * blocks[b].gram * left;
    const auto at = static_cast<Eigen::Index>(b);
    p[at] = G(0, 0);
    q[at] = G(0, 1);
  }
  constexpr double standard_errors = 3.0;
  // Noise that looks like the item by luck is no item: it may hide one, and not show it.
  const Eigen::VectorXd even = q.array() - q.mean();
  return std::max(size_at(p, q, standard_errors), size_at(p, even, standard_errors));
}

ToldTruth told_truth(const Machine& machine, const Trial& trial, const Recording& log,
                     const Recording& test) {
  const Robot given = with_inertias(machine, wrong_inertias(machine, trial.inertia_seed));
  RichModel model{stacked_parameters(given), {}};
  for (const Item& item : items_in_log(trial)) model.effects.push_back(applied(machine, item));
  const Eigen::MatrixXd none =
      Eigen::MatrixXd::Zero(machine.robot.dof(), std::ssize(log.usable(1)));
  const std::vector<Block> blocks = blocks_of(machine, log, model, none);
  const Eigen::VectorXd x = masses(blocks, precision(machine), 0, 0).col(1);
  // A filter at f leaves 2 f independent numbers a second.
  const double independent = std::min(1.0, 2.0 * machine.cutoff / log.rate());
  const Eigen::VectorXd best =
      masses(blocks, precision_of_given(machine, given) / independent, 0, 0).col(1);
  ToldTruth told;
  for (std::size_t i = 0; i < machine.free_links.size(); ++i) {
    const auto link = static_cast<std::size_t>(machine.free_links[i]);
    const Vector10 off = best.segment<10>(10 * static_cast<Eigen::Index>(i));
    told.inertias.push_back({given.links[link].inertia.values + off});
  }
  const auto columns = free_columns(machine);
  for (std::size_t i = 0; i < columns.size(); ++i) {
    model.Phi[columns[i]] += x[static_cast<Eigen::Index>(i)];
  }
  const Viewer viewer(machine.robot, contacts(machine), model.effects);
  double sum = 0.0;
  const auto indices = test.usable(1);
  for (const std::size_t i : indices) {
    const Eigen::VectorXd r = diagnosis::residual(viewer, viewer.view(test, i), model);
    sum += r.tail(machine.robot.joint_count()).squaredNorm();
  }
  told.error = std::sqrt(sum / static_cast<double>(indices.size()));
  return told;
}

}  // namespace shapeid::blind
