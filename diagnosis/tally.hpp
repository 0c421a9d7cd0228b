// Rows of a log summed up: one symmetric matrix a block of time, from which every linear fit and
// its error on any block follow.
//
// The sums are M^T M of the weighted, contact-free rows M = [Y, E, F]. They add and subtract, which
// makes leaving out a block free. A triangle would keep twice the digits; here noise limits the
// answer long before rounding, columns are scaled to one, and a prior keeps every fit regular.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <string>
#include <vector>

#include "shapeid/diagnosis/hypotheses.hpp"

namespace shapeid::diagnosis {

/// Sums of one block.
struct Block {
  Eigen::MatrixXd sums;  ///< (columns + 1) square; F is the last column
  std::size_t samples = 0;
  double from = 0.0;       ///< s since the log's start
  bool reference = false;  ///< of the reference log
  std::size_t log = 0;     ///< which one of those in the recording
  double freedom = 0.0;    ///< how many numbers the noise of its rows has, behind its filter
};

/// What the size of an effect might follow.
enum class Signal { position, speed, direction, load, side, turned, peak, time, row, yield, play };

/// A hypothesis whose size follows a signal of a joint: its columns times the signal. `side` is the
/// direction of the load, `turned` that of Recording::turned(), `peak` the share of the load that
/// is beyond Recording::high_torque() of a level; `row` keeps the joint's own row of the columns
/// alone. `yield` and `play` are of a gear between motor and joint (gears.hpp): in proportion to
/// the load or by its side, and by how that changes.
struct Modulation {
  std::size_t hypothesis = 0;
  Signal signal = Signal::time;
  int joint = 0;
  std::size_t level = 0;

  [[nodiscard]] bool of_gear() const { return signal == Signal::yield || signal == Signal::play; }
  /// Columns that it makes of so many.
  [[nodiscard]] Eigen::Index columns_of(Eigen::Index own) const { return of_gear() ? 1 : own; }
};

struct Tally {
  std::vector<Block> blocks;  ///< in the order of time, those of a reference log first
  Eigen::Index inertial = 0;  ///< columns of Y: 10 per link of the robot
  std::vector<AppliedEffect> hypotheses;
  std::vector<Eigen::Index> first;  ///< column of each hypothesis
  std::vector<Modulation> modulations;
  std::vector<Eigen::Index> first_modulated;  ///< column of each modulation
  Eigen::Index width = 0;                     ///< of the sums: all columns, and F
  [[nodiscard]] Eigen::Index columns() const { return width - 1; }
};

/// s. The errors of shorter blocks depend on those of their neighbours.
inline constexpr double shortest_block = 0.5;

struct TallyOptions {
  std::size_t stride = 1;
  double block_seconds = 1.0;
  Eigen::VectorXd weight;  ///< diagonal of W, generalised order
  double margin = 0.0;     ///< s left out at the end of each block, because filters reach across
  std::vector<std::size_t> log_starts;  ///< samples at which a further log begins; no block has two
  std::size_t threads = 1;  ///< that sum blocks at once: to the last bit the same for any number
};

/// One pass over a log. `robot` as given; the model's transformations are applied.
void add_to_tally(Tally& tally, const Robot& robot, RowSource source, const RichModel& model,
                  const Recording& recording, const TallyOptions& options, bool reference);

/// What a modulation makes of the columns `own` of its hypothesis at a sample, dof x columns_of().
/// `load` is the predicted one of all joints, `margin` (s) how far noise is filtered.
[[nodiscard]] Eigen::MatrixXd modulated(const Modulation& modulation, const Eigen::MatrixXd& own,
                                        const Robot& robot, const Recording& recording,
                                        std::size_t index, const View& view,
                                        const PredictedLoad& load, double margin);

/// The joint's load (N m or N) below which teeth and brushes do not change sides at once: 0.1, or a
/// tenth of what the joint often has if that is less.
[[nodiscard]] double light_load(const Recording& recording, Eigen::Index joint);

/// How far a motor is ahead of its joint by a gear of number one under a load.
[[nodiscard]] double lead_of(const Modulation& gear, const Recording& recording, double load);

[[nodiscard]] Tally empty_tally(const Robot& robot, const std::vector<AppliedEffect>& hypotheses,
                                const std::vector<Modulation>& modulations = {});

/// The same sums with the columns of the first so many hypotheses alone, without modulations.
[[nodiscard]] Tally with_first(const Tally& tally, std::size_t hypotheses);

}  // namespace shapeid::diagnosis
