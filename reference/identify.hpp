// Claim C10. The whole way, from samples to parameters: rows, masses, divisions, and what the data
// determine.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "shapeid/models/body_model.hpp"
#include "shapeid/models/robot.hpp"
#include "shapeid/models/sample.hpp"
#include "shapeid/reference/determination.hpp"
#include "shapeid/reference/division.hpp"
#include "shapeid/reference/row_filter.hpp"
#include "shapeid/reference/window.hpp"

namespace shapeid::reference {

/// Torques that ask for more than so many times the expected mass are not in N m: N mm ask for a
/// thousand, and no payload is so much heavier than it was thought.
inline constexpr double most_times_expected = 100.0;

struct IdentifySettings {
  ContactTreatment contacts = ContactTreatment::project;
  Eigen::VectorXd weight;        ///< diagonal of W, generalised order; empty: ones
  double expected_mass = 0.0;    ///< M0 > 0, kg, of all free shapes together
  std::optional<double> lambda;  ///< default: default_lambda()
  /// kg; default: the larger of ten times M0 and twice what is found.
  std::optional<double> mass_bound;
  DivisionOptions division;  ///< most_divisions = 0 solves once and does not divide
  /// What no data term is below, however finely the undivided model is divided; of a problem with a
  /// mass bound and its present shapes. Asked where steps are small (divide_and_solve()); empty:
  /// small steps alone end the divisions.
  std::function<double(const BodyModel& undivided, const MassProblem&)> floor;
  double block_seconds = 0.5;  ///< contiguous blocks for standard errors
  /// Low-pass the rows in time; the samples then need little smoothing of their own.
  std::optional<RowFilterOptions> row_filter;
  /// The same rows are asked once more behind this filter, slower than all others: what of the
  /// answer is noise of the motion is less there.
  std::optional<RowFilterOptions> slower;
  /// Rows of a sample when more than rigid links is known of the robot (friction, ...); empty:
  /// sample_rows().
  std::function<SampleRows(const Sample&)> rows;
};

struct Identification {
  DivisionRun run;
  double undivided_objective = 0.0;  ///< of the shapes as given
  Eigen::VectorXd Phi;               ///< all links of the robot, 10 each
  Determination data;                ///< per parameter of the free links
  /// The same of the rows behind the slower filter; none if it was not asked for.
  std::optional<Determination> slower;
  /// Standard errors of Phi of the free links with shapes, bounds and density term at work, by
  /// leaving out each block once (jackknife). Bias from noise in Y is not in them.
  Eigen::VectorXd standard_error;
  std::size_t samples = 0;
  std::size_t blocks = 0;  ///< of time, or logs, that were left out for the errors
};

/// Samples one by one; empty at the end.
using SampleStream = std::function<std::optional<Sample>()>;

/// The rows of a stream, weighted and free of contact forces, as contiguous blocks of time.
struct CompressedRows {
  /// Fewer than most_blocks: neighbours merge when there are that many.
  std::vector<RowBlock> blocks;
  std::size_t samples = 0;
  /// Behind the slower filter; empty if it was not asked for, or leaves nothing.
  std::vector<RowBlock> slower;
};

/// Reads a stream to its end. Memory does not grow with it. No blocks for an empty stream. Throws
/// what StandingFeet::judge() and CarryingFeet::judge() throw where contact forces are projected
/// out.
[[nodiscard]] CompressedRows compress(const Robot& robot, const BodyModel& model,
                                      const SampleStream& next, const IdentifySettings& settings);

/// Throws Refusal "no-data" if there are samples of which the filter of the rows leaves nothing.
void refuse_filtered_away(const CompressedRows& rows);

/// All blocks as one triangle, merged in their order.
[[nodiscard]] Eigen::MatrixXd merged(const std::vector<RowBlock>& blocks);

/// Identifies the free links of `model` from at least two blocks, whose spread is what errors are
/// judged by. Throws Refusal "torque-scale" if the rows ask for more than a hundred times the
/// expected mass, "not-excited" if they determine no parameter at all, "too-short" if the blocks
/// are so few or so unlike that nothing tells, "disagree" if they contradict each other so far that
/// nothing is determined, "not-finite" as solve_masses() does;
/// std::invalid_argument for division options, or an expected mass, that make no sense.
[[nodiscard]] Identification identify(const BodyModel& model, const CompressedRows& rows,
                                      const IdentifySettings& settings,
                                      const std::function<void(const DivisionRun&)>& watch = {});

/// Identifies the free links of `model`. Memory does not grow with the stream: blocks are
/// triangles, and neighbours merge when there are most_blocks of them. Throws Refusal "no-data" for
/// an empty stream, or one of which the row filter leaves nothing, "not-excited" for one in which
/// nothing moves, "too-short" for a single block (no spread to judge by); what the rows of a
/// sample, the row filter and the function above throw is thrown here as well.
[[nodiscard]] Identification identify(const Robot& robot, const BodyModel& model,
                                      const SampleStream& next, const IdentifySettings& settings,
                                      const std::function<void(const DivisionRun&)>& watch = {});

inline constexpr std::size_t most_blocks = 64;

/// For each parameter of the free links the largest size that the link's mass (`masses`: kg, one a
/// free link) gives it in one whole shape; of a group (first moments, tensor) none is less than a
/// tenth of the largest. Positive where the link's mass is. Empty if no link is free.
[[nodiscard]] Eigen::VectorXd sizes_of_links(const BodyModel& model, const Eigen::VectorXd& masses);

/// The same with M0 shared among the links as the volume of their shapes.
[[nodiscard]] Eigen::VectorXd natural_sizes(const BodyModel& model, double expected_mass);

}  // namespace shapeid::reference
