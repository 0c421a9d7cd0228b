// What `identify` and `load` found, as JSON (docs/formats/result.md) and as text.
#pragma once

#include <Eigen/Core>

#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "shapeid/app/inputs.hpp"
#include "shapeid/models/inertia.hpp"
#include "shapeid/models/stated_problem.hpp"
#include "shapeid/models/urdf.hpp"
#include "shapeid/reference/identify.hpp"

namespace shapeid::app {

/// Of the parameters of `parameter_names`.
inline constexpr std::array<const char*, 10> parameter_units = {
    "kg", "kg m", "kg m", "kg m", "kg m^2", "kg m^2", "kg m^2", "kg m^2", "kg m^2", "kg m^2"};

/// Residuals of three models on samples that were not fitted.
struct Comparison {
  std::size_t samples = 0;
  Eigen::VectorXd zero, given, found;  ///< rms per generalised row, N, N m
  /// "every fifth two seconds of LOG", or the test log; empty if nothing was held out
  std::string where;
};

struct Result {
  std::string robot_file, robot_yaml_file, log_file;  ///< the second may be empty
  BodyModel sought;                                   ///< as it was before the first division
  reference::Identification found;
  Comparison heldout;
  MotionReport motion;
  double slower_cutoff = 0.0;  ///< Hz, of Identification::slower; 0: that was not asked for
  /// Links whose identified inertia is written; the others keep what was given, with the reason.
  std::vector<IdentifiedLink> written;
  std::vector<std::string> notes;
};

/// The problem of the last division with its shapes, the undivided ones as its regions:
/// problem.json.
[[nodiscard]] StatedProblem stated_problem(const Result& result);

/// Throws Refusal ("no-mass") if next to nothing of what was expected (kg) was found.
void check_some_mass(const Result& result, double expected_mass);

/// What a URDF says of a link that was found without mass, or with less than `least_mass` (kg):
/// readers want some. With the given one's it would be another model, for its neighbours have taken
/// that over. As the given one in all else, of that mass or, if it is more, a thousandth of the
/// given one's; none if that is no less than what is given.
[[nodiscard]] std::optional<InertialParameters> lightest_written(const InertialParameters& given,
                                                                 double least_mass);

/// Which free links get a new inertia: those of which a URDF reader, ours included, accepts what
/// was found, or lightest_written(). Adds a note for each that has not what was found.
void choose_written_links(Result& result, const Robot& robot, double least_mass);

/// `floor`: of infinitely many divisions, proved; empty: none was.
[[nodiscard]] nlohmann::json result_json(const Result& result, const std::optional<double>& floor,
                                         const Robot& robot);
[[nodiscard]] std::string result_text(const Result& result, const std::optional<double>& floor,
                                      const Robot& robot);

/// "base force x", ..., then the joints' names: the generalised rows.
[[nodiscard]] std::vector<std::string> row_names(const Robot& robot);

/// Their units: N or N m.
[[nodiscard]] std::vector<std::string> row_units(const Robot& robot);

/// Of so many digits; a dash for what does not exist, as the error of a joint that never counts.
[[nodiscard]] std::string number_or_dash(double x, int digits);

/// sqrt of the sum of squares over the joint rows, in joints_unit(): one number for a whole robot.
/// Rows without an error (NaN) are left out; NaN if no row has one.
[[nodiscard]] double overall(const Eigen::VectorXd& rms, const Robot& robot);
/// "N m", "N", or "N m and N" of a robot with joints of both kinds.
[[nodiscard]] std::string joints_unit(const Robot& robot);

}  // namespace shapeid::app
