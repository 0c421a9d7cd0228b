#include "shapeid/app/diagnosis_logs.hpp"

#include <algorithm>

#include "shapeid/app/option_checks.hpp"
#include "shapeid/diagnosis/motion_noise.hpp"
#include "shapeid/models/error.hpp"

namespace shapeid::app {

std::vector<std::string> fitted_logs(const DiagnoseOptions& options) {
  std::vector<std::string> paths = {options.inputs.log};
  paths.insert(paths.end(), options.also.begin(), options.also.end());
  return paths;
}

void refuse_same_logs(const DiagnoseOptions& options) {
  std::vector<std::string> paths = fitted_logs(options);
  if (!options.reference.empty()) paths.push_back(options.reference);
  const std::size_t fitted = paths.size();
  paths.insert(paths.end(), options.test.begin(), options.test.end());
  const auto twice = same_file(paths);
  if (!twice) return;
  const auto& [first, second] = *twice;
  if (first < fitted && second >= fitted) {
    throw InputError({paths[second]}, "is fitted, too",
                     "a test on data that are used for nothing else");
  }
  throw InputError({paths[second]}, "is given twice", "each log once");
}

std::size_t stride_of(const MotionInputs& inputs, double rate) {
  constexpr double samples_a_period = 5.0;
  const double cutoff = inputs.cutoff > 0.0 ? inputs.cutoff : rate;
  return static_cast<std::size_t>(std::max(1.0, rate / (samples_a_period * cutoff)));
}

double margin_of(const MotionInputs& inputs, double rate) {
  constexpr double longest = 0.1;
  return std::min(0.5 / (inputs.cutoff > 0.0 ? inputs.cutoff : rate), longest);
}

std::optional<RecordedLog> SameLogs::less_smooth() const {
  constexpr double times = 3.0, highest = 0.4;  // of the rate
  MotionInputs other = inputs;
  other.cutoff = std::min(times * inputs.cutoff, highest * rate);
  if (inputs.exact || inputs.causal || !(other.cutoff > inputs.cutoff)) return {};
  return read_recordings(paths, robot, other, part, shifts);
}

std::optional<RecordedLog> SameLogs::smoother() const {
  if (inputs.exact || !(inputs.cutoff > 0.0)) return {};
  MotionInputs other = inputs;
  other.cutoff *= diagnosis::slower_by;
  return read_recordings(paths, robot, other, part, shifts);
}

}  // namespace shapeid::app
