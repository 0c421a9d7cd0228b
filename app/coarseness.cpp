#include "shapeid/app/coarseness.hpp"

#include <fmt/format.h>

#include <string>

namespace shapeid::app {
namespace {

/// Empty where little is left of what divisions could gain, or nothing more can be divided.
std::string far_from_floor(const reference::Identification& found, double floor) {
  constexpr double much = 0.1;
  const reference::DivisionRun& run = found.run;
  const double gain = found.undivided_objective - floor;
  const double left = run.solution.value.data - floor;
  const bool near = is_near_floor(found.undivided_objective, run.solution.value, floor);
  if (near || left <= much * gain || run.stopped_by == "nothing divisible") return "";
  return fmt::format(
      "divisions ended ({}) with the objective still {:.3g} above the floor ({:.3g} for the shapes "
      "as given); --eps 0 with more --divisions goes on, and --k2 0 divides large shapes before "
      "dense ones",
      run.stopped_by, left, gain);
}

/// Masses that fit one log and predict another worse than what was given have taken up something
/// else, or are still in shapes too coarse to fit either. Empty also where torque is predicted to
/// all digits that the density term leaves, as of a log without noise.
std::string worse_prediction(const Comparison& heldout, const Robot& robot) {
  constexpr double to_all_digits = 1e-6;
  if (heldout.samples == 0) return "";
  const double given = overall(heldout.given, robot), found = overall(heldout.found, robot);
  const std::string before = fmt::format("{:.3g}", given), now = fmt::format("{:.3g}", found);
  if (!(found > given) || now == before) return "";
  if (found <= to_all_digits * overall(heldout.zero, robot)) return "";
  return fmt::format(
      "held-out torque is predicted worse than by the given model (rms over all joints {} instead "
      "of {})",
      now, before);
}

}  // namespace

void note_coarse_shapes(Result& result, const Robot& robot, const std::optional<double>& floor) {
  const std::string far = far_from_floor(result.found, floor.value_or(0.0));
  const std::string worse = worse_prediction(result.heldout, robot);
  if (!worse.empty() && !far.empty()) {
    result.notes.push_back(worse + ": the shapes may be too coarse; " + far);
  } else if (!worse.empty()) {
    result.notes.push_back(
        worse +
        ": look for what rigid links lack (diagnose), wrong units, exchanged joints, or the size "
        "of a shape");
  } else if (!far.empty() && !result.found.run.history.empty()) {
    result.notes.push_back(far);
  }
}

}  // namespace shapeid::app
