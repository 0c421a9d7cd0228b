// report.html of `diagnose`: one self-contained page.
#pragma once

#include <string>

#include "shapeid/app/diagnosis_run.hpp"

namespace shapeid::app {

/// Throws InputError if gnuplot is missing.
[[nodiscard]] std::string diagnosis_report(const DiagnosisRun& run, const Robot& robot,
                                           const DiagnoseOptions& options);

}  // namespace shapeid::app
