#include "shapeid/reference/identify.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "shapeid/models/error.hpp"
#include "shapeid/models/motion_extent.hpp"
#include "shapeid/reference/carrying_feet.hpp"
#include "shapeid/reference/mass_solver.hpp"
#include "shapeid/reference/standing_feet.hpp"
#include "shapeid/reference/triangle.hpp"

namespace shapeid::reference {
namespace {

/// Contiguous blocks of rows; twice as long each time there are too many.
class Blocks {
 public:
  Blocks(Window window, std::optional<RowFilter> filter, double seconds)
      : window_(std::move(window)), filter_(std::move(filter)), seconds_(seconds) {}

  void add(double time, const SampleRows& rows) {
    if (filter_) {
      filter_->push(time, rows);
      add_filtered();
      return;
    }
    close_before(time);
    window_.add(rows);
  }

  std::vector<RowBlock> finish() {
    if (filter_) {
      filter_->finish();
      add_filtered();
    }
    if (window_.samples() > 0) {
      // A stub says little, and its answer alone would scatter: it goes to the block before.
      const bool is_stub = last_ - start_ < 0.5 * seconds_ && !blocks_.empty();
      close();
      if (is_stub && blocks_.size() > 1) {
        const Eigen::MatrixXd rows = std::move(blocks_.back().rows);
        blocks_.pop_back();
        blocks_.back().rows = triangle(stacked(blocks_.back().rows, rows));
      }
    }
    return std::move(blocks_);
  }

 private:
  void add_filtered() {
    while (const std::optional<FilteredRows> rows = filter_->next()) {
      close_before(rows->time);
      window_.add_rows(rows->Y, rows->F);
    }
  }

  void close_before(double time) {
    if (window_.samples() > 0 && time - start_ >= seconds_) close();
    if (window_.samples() == 0) start_ = time;
    last_ = time;
  }

  void close() {
    Eigen::MatrixXd rows(window_.Y().rows(), window_.Y().cols() + 1);
    rows << window_.Y(), window_.F();
    blocks_.push_back({triangle(rows)});
    window_.clear();
    if (blocks_.size() < most_blocks) return;
    for (std::size_t k = 0; 2 * k + 1 < blocks_.size(); ++k) {
      blocks_[k].rows = triangle(stacked(blocks_[2 * k].rows, blocks_[2 * k + 1].rows));
    }
    blocks_.resize(blocks_.size() / 2);
    seconds_ *= 2.0;
  }

  Window window_;
  std::optional<RowFilter> filter_;
  double seconds_, start_ = 0.0, last_ = 0.0;
  std::vector<RowBlock> blocks_;
};

/// Rows of all blocks, or of all but block `skipped`.
Eigen::MatrixXd rows_without(const std::vector<RowBlock>& blocks, std::size_t skipped) {
  Eigen::MatrixXd rows(0, blocks.front().rows.cols());
  for (std::size_t k = 0; k < blocks.size(); ++k) {
    if (k != skipped) rows = triangle(stacked(rows, blocks[k].rows));
  }
  return rows;
}

void set_rows(MassProblem& problem, const Eigen::MatrixXd& rows) {
  problem.Y = rows.leftCols(rows.cols() - 1);
  problem.F = rows.rightCols(1);
  problem.W = Eigen::VectorXd::Ones(rows.rows());
}

/// Delete-a-block jackknife: the spread of answers that each miss one block.
Eigen::VectorXd jackknife(const std::vector<RowBlock>& blocks, const DivisionRun& run) {
  const auto count = static_cast<Eigen::Index>(blocks.size());
  Eigen::MatrixXd Phi(run.solution.Phi.size(), count);
  MassProblem problem = run.problem;
  for (Eigen::Index k = 0; k < count; ++k) {
    set_rows(problem, rows_without(blocks, static_cast<std::size_t>(k)));
    Phi.col(k) = solve_masses(problem, run.solution.m).Phi;
  }
  // Around the answer, not around the mean of the others: these may all stand at a bound.
  const double factor = static_cast<double>(count - 1) / static_cast<double>(count);
  return (factor * (Phi.colwise() - run.solution.Phi).rowwise().squaredNorm()).cwiseSqrt();
}

/// Of the expected mass (kg), shared among the shapes by volume, the multiple that fits the rows
/// best.
double times_expected(const BodyModel& model, const Eigen::MatrixXd& rows, double mass) {
  const Eigen::VectorXd V = shape_volumes(model);
  const Eigen::VectorXd expected =
      rows.leftCols(rows.cols() - 1) * (shape_columns(model) * (mass / V.sum() * V));
  return expected.dot(rows.rightCols<1>()) / expected.squaredNorm();
}

}  // namespace

Eigen::VectorXd natural_sizes(const BodyModel& model, double expected_mass) {
  const Eigen::VectorXd V = shape_volumes(model);
  const auto links = static_cast<Eigen::Index>(model.free_links.size());
  Eigen::VectorXd masses = Eigen::VectorXd::Zero(links);
  for (std::size_t j = 0; j < model.shapes.size(); ++j) {
    const auto link =
        std::lower_bound(model.free_links.begin(), model.free_links.end(), model.shapes[j].link);
    masses[link - model.free_links.begin()] += V[static_cast<Eigen::Index>(j)];
  }
  return sizes_of_links(model, expected_mass / V.sum() * masses);
}

Eigen::VectorXd sizes_of_links(const BodyModel& model, const Eigen::VectorXd& masses) {
  if (model.free_links.empty()) return {};
  Eigen::VectorXd size = shape_columns(model).cwiseAbs().rowwise().maxCoeff();
  // A parameter that every shape leaves at zero by symmetry still needs a positive size to be
  // measured against: none is less than a tenth of the largest of its group on the same link. Where
  // the whole group is zero (points at the origin) the link's mass stands for the largest, its kg
  // read as kg m or kg m^2.
  for (Eigen::Index link = 0; link < size.size(); link += 10) {
    size.segment<10>(link) *= masses[link / 10];
    for (const auto& [first, count] : {std::pair{1, 3}, std::pair{4, 6}}) {
      auto group = size.segment(link + first, count);
      const double fallback = group.maxCoeff() > 0.0 ? group.maxCoeff() : masses[link / 10];
      group = (group.array() > 0.1 * fallback).select(group, 0.1 * fallback);
    }
  }
  return size;
}

CompressedRows compress(const Robot& robot, const BodyModel& model, const SampleStream& next,
                        const IdentifySettings& settings) {
  const Eigen::VectorXd weight = settings.weight.size() > 0
                                     ? settings.weight
                                     : Eigen::VectorXd(Eigen::VectorXd::Ones(robot.dof()));
  const auto blocks = [&](const std::optional<RowFilterOptions>& options) {
    std::optional<RowFilter> filter;
    if (options) filter.emplace(robot, model, settings.contacts, weight, *options);
    return Blocks(Window(robot, model, settings.contacts, weight), std::move(filter),
                  settings.block_seconds);
  };
  Blocks collected = blocks(settings.row_filter);
  std::optional<Blocks> slower;
  if (settings.slower) slower.emplace(blocks(settings.slower));
  CompressedRows result;
  StandingFeet feet(robot);
  CarryingFeet carrying(robot);
  while (const std::optional<Sample> sample = next()) {
    const SampleRows rows = settings.rows ? settings.rows(*sample)
                                          : sample_rows(robot, model.known, model.free_links,
                                                        settings.contacts, *sample);
    collected.add(sample->time, rows);
    if (slower) slower->add(sample->time, rows);
    if (settings.contacts == ContactTreatment::project) {
      feet.add(*sample);
      carrying.add(*sample);
    }
    ++result.samples;
  }
  feet.judge();
  carrying.judge();
  result.blocks = collected.finish();
  if (slower) result.slower = slower->finish();
  return result;
}

void refuse_filtered_away(const CompressedRows& rows) {
  if (rows.samples == 0 || !rows.blocks.empty()) return;
  throw Refusal("no-data", "no stretch between gaps is long enough for the filter of the rows");
}

Eigen::MatrixXd merged(const std::vector<RowBlock>& blocks) {
  return rows_without(blocks, blocks.size());
}

namespace {

/// How many parameters blocks determine clearly: a third of the error would be asked for.
Eigen::Index determined_by(const std::vector<RowBlock>& blocks, const Eigen::VectorXd& sizes) {
  constexpr double share = largest_share / 3.0;
  const Determination data = determine(blocks, sizes);
  return (data.wider * data.standard_error.array() < share * sizes.array()).count();
}

/// Blocks that determine something clearly without one of them, or half of them by themselves, and
/// nothing together, do not lack motion: they contradict each other.
void refuse_disagreement(const std::vector<RowBlock>& blocks, const Eigen::VectorXd& sizes) {
  constexpr std::size_t most = 20;  // as logs of a batch; each costs as much as all together
  for (std::size_t k = 0; blocks.size() <= most && k < blocks.size(); ++k) {
    std::vector<RowBlock> others = blocks;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
    const auto count = determined_by(others, sizes);
    if (count == 0) continue;
    throw Refusal("disagree", fmt::format("number {} of {} blocks of time, or logs, contradicts "
                                          "the others, which determine {} parameters without it",
                                          k + 1, blocks.size(), count));
  }
  const auto middle = blocks.begin() + std::ssize(blocks) / 2;
  const auto first = determined_by({blocks.begin(), middle}, sizes);
  const auto second = determined_by({middle, blocks.end()}, sizes);
  if (first > 0 || second > 0) {
    throw Refusal("disagree",
                  fmt::format("the first half of the blocks of time, or logs, determines {} "
                              "parameters by itself, the second {}, both together none: something "
                              "changed between them (a load, a sensor)",
                              first, second));
  }
}

}  // namespace

Identification identify(const BodyModel& model, const CompressedRows& rows,
                        const IdentifySettings& settings,
                        const std::function<void(const DivisionRun&)>& watch) {
  DivisionOptions division = settings.division;
  division.expected_mass = settings.expected_mass;
  if (const Violation reason = why_senseless(division)) throw std::invalid_argument(*reason);
  const Eigen::MatrixXd all_rows = merged(rows.blocks);
  const double times = times_expected(model, all_rows, settings.expected_mass);
  if (times > most_times_expected) {
    throw Refusal("torque-scale",
                  fmt::format("the log asks for about {:.1g} times the expected mass of {:g} kg: "
                              "its torque is not in N m, or far more is to be expected",
                              times, settings.expected_mass));
  }
  Identification result;
  result.samples = rows.samples;
  const Eigen::VectorXd sizes = natural_sizes(model, settings.expected_mass);
  result.data = determine(rows.blocks, sizes);
  result.blocks = rows.blocks.size();
  const auto& known = result.data.determined;
  if (std::none_of(known.begin(), known.end(), [](bool is_known) { return is_known; })) {
    constexpr double few = 1.5;  // four blocks or fewer
    const bool judged = result.data.standard_error.array().isFinite().any();
    if (result.data.rank > 0 && (!judged || result.data.wider > few)) {
      throw Refusal("too-short",
                    fmt::format("{} blocks of time, or logs, have too little spread to judge any "
                                "parameter by; log a longer motion, and logs of like length",
                                rows.blocks.size()));
    }
    refuse_disagreement(rows.blocks, sizes);
    throw Refusal("not-excited",
                  "the motion determines no parameter of the free links; use a log in which they "
                  "move, turn or are loaded");
  }

  if (!rows.slower.empty()) result.slower = determine(rows.slower, sizes);
  take_back(result.data, result.slower);

  MassProblem problem;
  set_rows(problem, all_rows);
  problem.U = shape_columns(model);
  problem.V = shape_volumes(model);
  problem.lambda = settings.lambda.value_or(default_lambda(problem, settings.expected_mass));
  // Only floors and certificates use it. What was expected may have been a guess: what was found
  // fits in.
  const auto mass_bound = [&](const DivisionRun& run) {
    const double found = run.solution.m.sum();
    return settings.mass_bound.value_or(std::max(10.0 * settings.expected_mass, 2.0 * found));
  };
  std::function<double(const DivisionRun&)> floor;
  if (settings.floor) {
    floor = [&](const DivisionRun& run) {
      MassProblem bounded = run.problem;
      bounded.mass_bound = mass_bound(run);
      return settings.floor(model, bounded);
    };
  }
  result.run = divide_and_solve(model, problem, division, watch, floor);
  result.run.problem.mass_bound = mass_bound(result.run);
  const auto& history = result.run.history;
  result.undivided_objective =
      history.empty() ? result.run.solution.value.total() : history.front().objective_before;
  result.Phi = all_parameters(model, result.run.solution.Phi);
  result.standard_error = jackknife(rows.blocks, result.run);
  return result;
}

Identification identify(const Robot& robot, const BodyModel& model, const SampleStream& next,
                        const IdentifySettings& settings,
                        const std::function<void(const DivisionRun&)>& watch) {
  MotionExtent extent;
  const SampleStream watched = [&] {
    std::optional<Sample> sample = next();
    if (sample) extent.add(*sample);
    return sample;
  };
  const CompressedRows rows = compress(robot, model, watched, settings);
  if (rows.samples == 0) throw Refusal("no-data", "the log has no usable sample");
  refuse_filtered_away(rows);
  // Of several logs, as `batch` reads them, each may be a pose; of one that would be all.
  if (!extent.some_joint_moved(robot) && !extent.base_moved()) {
    throw Refusal("not-excited", "nothing moves; log a motion that turns and loads the links");
  }
  if (rows.blocks.size() < 2) {
    throw Refusal("too-short",
                  fmt::format("{} samples within one block of {:g} s have no spread to "
                              "judge them by; log a longer motion",
                              rows.samples, settings.block_seconds));
  }
  return identify(model, rows, settings, watch);
}

}  // namespace shapeid::reference
