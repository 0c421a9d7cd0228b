#include "shapeid/diagnosis/unexplained.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "shapeid/diagnosis/chance.hpp"
#include "shapeid/diagnosis/torque_columns.hpp"
#include "shapeid/models/student.hpp"

namespace shapeid::diagnosis {
namespace {

constexpr std::size_t bins = 10;
constexpr std::size_t blocks = 30, folds = 6;
// By chance a curve loses on other blocks, so that 2.5 standard errors of gain are rarer than their
// number says, and a few hundred curves may be tried. Fewer will do if the gain is large by the
// squares of independent noise, but not fewer than two.
constexpr double least_gain_t = 2.0, usual_gain_t = 2.5;
// Logs without any structure in which chance makes one of all curves that are tried.
constexpr double curve_false_alarms = 0.003;

/// Edges so that every bin holds as many samples; of a signal with few values, a value.
std::vector<double> quantiles(std::vector<double> x) {
  std::sort(x.begin(), x.end());
  std::vector<double> edges;
  for (std::size_t i = 1; i < bins; ++i) edges.push_back(x[i * x.size() / bins]);
  x.erase(std::unique(x.begin(), x.end()), x.end());
  return x.size() > bins ? edges : std::vector<double>(x.begin() + 1, x.end());
}

std::size_t bin_of(double x, const std::vector<double>& edges) {
  return static_cast<std::size_t>(std::upper_bound(edges.begin(), edges.end(), x) - edges.begin());
}

struct Binned {
  std::vector<double> sum = std::vector<double>(bins, 0.0), count = sum;
  void add(std::size_t bin, double y, double weight = 1.0) {
    sum[bin] += y;
    count[bin] += weight;
  }
  [[nodiscard]] double mean() const {
    return std::accumulate(sum.begin(), sum.end(), 0.0) /
           std::max(std::numeric_limits<double>::min(),
                    std::accumulate(count.begin(), count.end(), 0.0));
  }
  [[nodiscard]] double mean(std::size_t bin) const {
    return count[bin] > 0.0 ? sum[bin] / count[bin] : mean();
  }
};

void set_curve(const Binned& places, const Binned& values, Structure& structure) {
  for (std::size_t bin = 0; bin < bins; ++bin) {
    if (!(places.count[bin] > 0.0)) continue;
    structure.at.push_back(places.mean(bin));
    structure.value.push_back(values.mean(bin));
  }
}

/// Places of x in its order, spread evenly over (-1, 1). Equal values share the middle of theirs:
/// in the order of time, say, they would follow whatever drifts.
struct Ranks {
  std::vector<double> u;
  std::size_t values = 0;  ///< that are different
};
Ranks ranks(const std::vector<double>& x) {
  std::vector<std::size_t> order(x.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return x[a] < x[b]; });
  Ranks ranks{std::vector<double>(x.size())};
  for (std::size_t i = 0; i < order.size();) {
    std::size_t end = i;
    while (end < order.size() && x[order[end]] == x[order[i]]) ++end;
    const double u = static_cast<double>(i + end) / static_cast<double>(x.size()) - 1.0;
    for (; i < end; ++i) ranks.u[order[i]] = u;
    ++ranks.values;
  }
  return ranks;
}

/// Legendre's polynomials of order 0 to 4; no more than there are values to tell them apart.
constexpr int waves = 5;
using Waves = Eigen::Matrix<double, waves, 1>;
Waves waves_at(double u, std::size_t values) {
  Waves p;
  p[0] = 1.0;
  p[1] = u;
  for (int k = 1; k + 1 < waves; ++k) {
    p[k + 1] = ((2.0 * k + 1.0) * u * p[k] - k * p[k - 1]) / (k + 1.0);
  }
  const auto told_apart = std::min<Eigen::Index>(waves, static_cast<Eigen::Index>(values));
  p.tail(waves - told_apart).setZero();
  return p;
}

/// The curve of y over x; empty if it does not hold on other blocks. It is judged as a smooth
/// function of the rank of x with four numbers at most, because every number costs held-out error,
/// and filtered samples are few independent ones; it is shown as means of ten bins, or of fewer
/// where x has few values. What it takes away
/// must be more than chance would of as much noise: blocks are few, and at times agree by chance.
///
/// Folds are whole stretches of time. A curve over time itself cannot be judged so: on a stretch at
/// the end it would have to foretell. Its folds are every sixth block.
enum class Folds { stretches, interleaved };
struct CurveRule {
  double usual_t = 0.0;
  double least_squares = 0.0;  ///< of the gain, in those of independent noise
  double independent = 1.0;    ///< share of the samples whose noise is
};
std::optional<Structure> curve(const std::vector<double>& x, const std::vector<double>& y,
                               const CurveRule& rule, Folds kind) {
  const Ranks rank = ranks(x);
  if (rank.values < 2) return std::nullopt;
  const std::vector<double> edges = quantiles(x);
  const auto fold_of = [&](std::size_t i) {
    const std::size_t block = i * blocks / x.size();
    return kind == Folds::stretches ? block * folds / blocks : block % folds;
  };
  using Normal = Eigen::Matrix<double, waves, waves>;
  std::vector<Normal> normal(folds, Normal::Zero());
  std::vector<Waves> target(folds, Waves::Zero());
  Binned all, places;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Waves p = waves_at(rank.u[i], rank.values);
    for (std::size_t f = 0; f < folds; ++f) {
      if (f == fold_of(i)) continue;
      normal[f] += p * p.transpose();
      target[f] += p * y[i];
    }
    const std::size_t bin = bin_of(x[i], edges);
    all.add(bin, y[i]);
    places.add(bin, x[i]);
  }
  std::vector<Waves> fitted;
  for (std::size_t f = 0; f < folds; ++f) {
    // Without a stretch there may be fewer values yet.
    constexpr double regular = 1e-9;
    normal[f].diagonal().array() += regular * normal[f](0, 0);
    fitted.emplace_back(normal[f].ldlt().solve(target[f]));
  }
  Eigen::VectorXd before = Eigen::VectorXd::Zero(blocks), after = before;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const std::size_t f = fold_of(i);
    const auto b = static_cast<Eigen::Index>(i * blocks / x.size());
    before[b] += std::pow(y[i] - target[f][0] / normal[f](0, 0), 2);
    after[b] += std::pow(y[i] - fitted[f].dot(waves_at(rank.u[i], rank.values)), 2);
  }
  const Gain gain = gain_of(before, after);
  const double noise = after.sum() / (rule.independent * static_cast<double>(x.size()));
  const double sure =
      both(gain.t / rule.usual_t, (before - after).sum() / noise / rule.least_squares);
  if (!(gain.t > least_gain_t && sure > 1.0)) return std::nullopt;
  Structure found;
  found.share = gain.share;
  found.t = gain.t;
  set_curve(places, all, found);
  return found;
}

/// Other columns of the log at every sample: what is measured more rarely, a temperature say, is
/// what it was last. NaN before the first value.
std::vector<std::vector<double>> held_columns(const Recording& recording) {
  std::vector<std::vector<double>> columns(recording.extra().size());
  for (std::size_t e = 0; e < columns.size(); ++e) {
    double last = std::numeric_limits<double>::quiet_NaN();
    for (const Sample& s : recording.samples()) {
      if (!std::isnan(s.extra[e])) last = s.extra[e];
      columns[e].push_back(last);
    }
  }
  return columns;
}

/// Of a curve over a signal of a joint whose predicted load is `load`.
double abscissa(Signal signal, int joint, const Recording& recording, std::size_t index,
                double load) {
  const Sample& s = recording[index];
  switch (signal) {
    case Signal::position:
      return s.q[joint];
    case Signal::speed:
    case Signal::direction:
      return s.dq[joint];
    case Signal::load:
    case Signal::side:
    case Signal::peak:
    case Signal::row:
    case Signal::yield:
    case Signal::play:
      return load;
    case Signal::turned:
      return recording.turned(index, joint);
    case Signal::time:
      break;
  }
  return s.time;
}

}  // namespace

std::vector<Structure> unexplained(const Robot& robot, const Recording& recording,
                                   const Series& series, std::size_t stride) {
  std::vector<Structure> found;
  const Eigen::VectorXd rms = series.rms(), predicted = row_rms(series.predicted, series.counted);
  // What four numbers of nothing take away from their own blocks they cost on others: the sum of
  // their squares is expected there to be theirs, less two a number.
  const std::ptrdiff_t joints = robot.joint_count();
  const auto curves =
      static_cast<double>(joints * (2 * joints + 4 + std::ssize(recording.extra())));
  const CurveRule rule{
      limit_for(usual_gain_t, blocks),
      least_squares_sum(curve_false_alarms / curves, waves - 1) - 2.0 * (waves - 1),
      recording.independent_share(stride)};
  const std::vector<std::vector<double>> extras = held_columns(recording);
  const std::vector<int> silent = silent_joints(robot, recording);
  constexpr std::size_t fewest = 10 * bins;
  for (int j = 0; j < robot.joint_count(); ++j) {
    const Eigen::Index row = robot.base_dof() + j;
    std::vector<std::size_t> places;  // in the series, of what counts
    std::vector<double> y;
    for (Eigen::Index i = 0; i < series.residual.cols(); ++i) {
      if (!series.counted(row, i)) continue;
      places.push_back(static_cast<std::size_t>(i));
      y.push_back(series.residual(row, i));
    }
    if (y.size() < fewest || rms[row] < least_share * predicted[row]) continue;
    const auto signal = [&](const auto& of) {
      std::vector<double> x;
      x.reserve(places.size());
      for (const std::size_t i : places) x.push_back(of(recording[series.index[i]], i));
      return x;
    };
    const auto best_of = [&](auto&& candidates, Folds kind = Folds::stretches) {
      std::optional<Structure> best;
      for (const auto& [name, x] : candidates) {
        std::vector<double> known, left;  // where the signal has a value
        for (std::size_t i = 0; i < x.size(); ++i) {
          if (std::isnan(x[i])) continue;
          known.push_back(x[i]);
          left.push_back(y[i]);
        }
        if (known.size() < fewest) continue;
        std::optional<Structure> c = curve(known, left, rule, kind);
        if (!c || (best && best->share >= c->share)) continue;
        best = c;
        best->joint = robot.joint(j).name;
        best->variable = name;
      }
      if (best) found.push_back(*best);
    };
    // What lags or yields follows how the torque changes. (Its second difference would not do:
    // noise of the motion is in it and in the residual.) A difference over one sample of the
    // series.
    const auto torque_rate = [&](const Sample&, std::size_t i) {
      const auto at = static_cast<Eigen::Index>(i);
      const Eigen::Index before = std::max<Eigen::Index>(at - 1, 0);
      const Eigen::Index after = std::min(at + 1, series.residual.cols() - 1);
      const auto when = [&](Eigen::Index k) {
        return recording[series.index[static_cast<std::size_t>(k)]].time;
      };
      return (series.predicted(row, after) - series.predicted(row, before)) /
             (when(after) - when(before));
    };
    using Named = std::vector<std::pair<std::string, std::vector<double>>>;
    Named position, velocity, acceleration, torque, rate, time, extra;
    for (int k = 0; k < robot.joint_count(); ++k) {
      const std::string& name = robot.joint(k).name;
      position.emplace_back("q." + name, signal([k](const Sample& s, auto) { return s.q[k]; }));
      velocity.emplace_back("dq." + name, signal([k](const Sample& s, auto) { return s.dq[k]; }));
    }
    const std::string& own = robot.joint(j).name;
    acceleration.emplace_back("ddq." + own,
                              signal([j](const Sample& s, auto) { return s.ddq[j]; }));
    // The predicted torque: the logged one is part of the residual.
    // Where none is logged the predicted one is the residual.
    if (std::ranges::find(silent, j) == silent.end()) {
      torque.emplace_back("tau." + own, signal([&](const Sample&, std::size_t i) {
                            return series.predicted(row, static_cast<Eigen::Index>(i));
                          }));
      rate.emplace_back("dtau." + own, signal(torque_rate));
    }
    time.emplace_back("time", signal([](const Sample& s, auto) { return s.time; }));
    for (std::size_t e = 0; e < recording.extra().size(); ++e) {
      extra.emplace_back(recording.extra()[e], signal([&](const Sample&, std::size_t i) {
                           return extras[e][series.index[i]];
                         }));
    }
    for (const Named& kind : {position, velocity, acceleration, torque, rate, extra}) {
      best_of(kind);
    }
    best_of(time, Folds::interleaved);
  }
  std::sort(found.begin(), found.end(),
            [](const Structure& a, const Structure& b) { return a.share > b.share; });
  return found;
}

namespace {

/// The joint where most is left, of what counts.
int joint_with_most(const Robot& robot, const Series& without) {
  const Eigen::VectorXd squares =
      (without.residual.array().square() * without.counted.cast<double>()).rowwise().sum();
  Eigen::Index most = 0;
  squares.tail(robot.joint_count()).maxCoeff(&most);
  return static_cast<int>(most);
}

}  // namespace

Structure unnamed(const Robot& robot, const Recording& recording, const Series& without,
                  const Variation& variation) {
  const int joint = variation.joint >= 0 ? variation.joint : joint_with_most(robot, without);
  const Eigen::Index row = robot.base_dof() + joint;
  std::vector<double> x, y;
  for (std::size_t i = 0; i < without.index.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    if (!without.counted(row, column)) continue;
    x.push_back(abscissa(variation.signal, joint, recording, without.index[i],
                         without.predicted(row, column)));
    y.push_back(without.residual(row, column));
  }
  Structure structure;
  structure.joint = robot.joint(joint).name;
  structure.variable = variable_of(variation, robot);
  structure.share = variation.share;
  structure.t = variation.z;
  if (x.empty()) return structure;
  const std::vector<double> edges = quantiles(x);
  Binned places, values;
  for (std::size_t i = 0; i < x.size(); ++i) {
    places.add(bin_of(x[i], edges), x[i]);
    values.add(bin_of(x[i], edges), y[i]);
  }
  set_curve(places, values, structure);
  return structure;
}

Structure lawless(const Robot& robot, RowSource source, const RichModel& model,
                  const Recording& recording, std::size_t stride, const Stranger& stranger) {
  const HypothesisColumns columns(robot, source, model, {stranger.carrier});
  const Viewer& viewer = columns.viewer();
  const int joint = stranger.law.joint;
  const Eigen::Index row = robot.base_dof() + joint;
  std::vector<double> x, carrier, missing;
  for (const std::size_t index : recording.usable(stride)) {
    const View view = viewer.view(recording, index);
    if (!counted_rows(viewer, recording, index, view)[row]) continue;
    const Prediction predicted = predict(viewer, view, model);
    x.push_back(
        abscissa(stranger.law.signal, joint, recording, index, predicted.load.joint[joint]));
    // Beyond contact forces, as what is missing is.
    const Eigen::MatrixXd column = columns.at(recording, index, view, predicted);
    carrier.push_back(beyond_contacts(viewer, predicted.J, column)(row, 0));
    missing.push_back(-residual(viewer, view, model)[row]);
  }
  Structure structure;
  structure.joint = robot.joint(joint).name;
  structure.variable = variable_of({stranger.law.signal, joint}, robot);
  structure.law = law_id(stranger, robot);
  structure.law_unit =
      unit_at(robot.joint(joint), stranger.carrier.effect->parameters.front().unit);
  structure.share = stranger.gain;
  structure.t = stranger.t;
  if (x.empty()) return structure;
  const std::vector<double> edges = quantiles(x);
  // The number is that of least squares within each bin; of a gear, which acts by how its number
  // changes, that of the law.
  Binned places, numbers;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const std::size_t bin = bin_of(x[i], edges);
    places.add(bin, x[i]);
    if (stranger.law.of_gear()) {
      numbers.add(bin, stranger.number * lead_of(stranger.law, recording, x[i]));
    } else {
      numbers.add(bin, carrier[i] * missing[i], carrier[i] * carrier[i]);
    }
  }
  set_curve(places, numbers, structure);
  return structure;
}

Autocorrelation autocorrelation(const Recording& recording, const Series& series, Eigen::Index row,
                                int lags) {
  Autocorrelation result;
  const Eigen::VectorXd d = centred(series, series.residual, row);
  const Eigen::Index n = d.size();
  const double variance = d.squaredNorm();
  for (int lag = 0; lag <= lags && lag < n; ++lag) {
    result.value.push_back(variance > 0.0 ? d.head(n - lag).dot(d.tail(n - lag)) / variance : 0.0);
  }
  constexpr double of_95_percent = 1.96;
  result.band = of_95_percent / std::sqrt(static_cast<double>(std::max<Eigen::Index>(n, 1)));
  if (series.index.size() > 1) {
    result.step = static_cast<double>(series.index[1] - series.index[0]) / recording.rate();
  }
  return result;
}

}  // namespace shapeid::diagnosis
