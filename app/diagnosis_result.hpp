// What `diagnose` found, as JSON (docs/formats/diagnosis.md), as text, and as a URDF.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "shapeid/app/diagnosis_run.hpp"

namespace shapeid::app {

[[nodiscard]] nlohmann::json diagnosis_json(const DiagnosisRun& run, const Robot& robot,
                                            const DiagnoseOptions& options);
[[nodiscard]] std::string diagnosis_text(const DiagnosisRun& run, const Robot& robot);

/// The URDF with identified inertias, and <dynamics> of the joints whose friction was found. Adds a
/// note to the run for each link that keeps what was given.
[[nodiscard]] std::string diagnosed_urdf(DiagnosisRun& run, const Robot& robot,
                                         const std::string& original);

/// What the selection said of an effect of the final model; null if nothing.
[[nodiscard]] const diagnosis::Found* found_for(const DiagnosisRun& run,
                                                const diagnosis::AppliedEffect& effect);

/// Where a load is, of whose mass that much is known; errors as if mass and moments had independent
/// ones.
[[nodiscard]] std::string centre_text(const Robot& robot, const diagnosis::AppliedEffect& a,
                                      const Eigen::VectorXd& error);

/// Which law follows which signal, of the curves of a run.
[[nodiscard]] std::string curves_words(const DiagnosisRun& run, const Robot& robot);

/// Why an effect whose name does not stand is kept as a description alone: half a sentence.
[[nodiscard]] std::string doubt(const DiagnosisRun& run, const diagnosis::Found& found,
                                const Robot& robot);

/// Why an effect of Consistent::dropped is not in the model: half a sentence.
[[nodiscard]] std::string why_left_out(const diagnosis::AppliedEffect& dropped);

/// That it came since the reference log, or may have; empty if neither.
[[nodiscard]] std::string since_text(const diagnosis::Found& found);

/// Where contact forces are projected away, a sentence that says so; else empty.
[[nodiscard]] std::string beyond_contacts(const DiagnosisRun& run, const Robot& robot);

/// What is said of Found::hangs_on_given.
inline constexpr const char* hangs_on_given =
    "inertias further from the given ones would do as well";

}  // namespace shapeid::app
