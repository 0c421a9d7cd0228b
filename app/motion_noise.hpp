// What `diagnose` says of logs in which noise of motion makes most of what remains.
#pragma once

#include <vector>

#include "shapeid/app/diagnosis_logs.hpp"
#include "shapeid/diagnosis/contact_reach.hpp"
#include "shapeid/diagnosis/motion_noise.hpp"

namespace shapeid::app {

/// Asks the logs of a diagnosis behind a slower filter, which are read when something is to be
/// asked.
class NoiseOfMotion {
 public:
  /// `flags`: contact flags that were corrected in the logs, and are in these; `reach`: how much
  /// longer contacts count as touching there, and here.
  NoiseOfMotion(SameLogs log, std::optional<SameLogs> reference,
                const std::vector<diagnosis::Found>& flags, const diagnosis::ContactReach& reach);

  /// What was found, and laws without a name, that noise of motion may be are taken back if these
  /// logs do not have them; where it is nowhere most of what remains, names are doubted.
  /// `reference` may be null.
  void question_laws(const diagnosis::Recording& log, const diagnosis::Recording* reference,
                     DiagnosisRun& run);
  /// Likewise curves; `remaining` is what the run's model leaves of `log`. Joints of which curves
  /// were taken back are silent.
  void question_curves(const diagnosis::Recording& log, const diagnosis::Series& remaining,
                       DiagnosisRun& run);
  /// diagnosis::moves_behind(); empty where no link is sought, there is no filter, or a slower one
  /// leaves too little.
  [[nodiscard]] Eigen::VectorXd moves(const DiagnosisRun& run);
  [[nodiscard]] const std::vector<std::string>& silent() const { return silent_; }
  /// Whether most of what remains of a joint is noise of motion, as far as was asked, or such noise
  /// had a name there.
  [[nodiscard]] bool is_noisy(const std::string& joint) const;
  /// Adds notes: of which joints most of what remains is noise of motion, and what was taken back.
  void note(DiagnosisRun& run) const;

 private:
  void take_back_names(const diagnosis::Recording& log, const diagnosis::Recording* reference,
                       DiagnosisRun& run);
  [[nodiscard]] diagnosis::FilteredLogs smoother(const DiagnosisRun& run);

  SameLogs log_inputs_;
  std::optional<SameLogs> reference_inputs_;
  const std::vector<diagnosis::Found>& flags_;
  diagnosis::ContactReach reach_;
  std::optional<RecordedLog> log_, reference_;
  diagnosis::LoopSettings settings_;
  std::vector<double> fast_shares_;
  std::vector<bool> had_noise_for_name_;  ///< the one joint of a name that was taken back
  std::vector<std::string> names_taken_back_, taken_back_, silent_;
  std::string why_not_asked_;  ///< behind the slower filter, with what is left of the log there
};

}  // namespace shapeid::app
