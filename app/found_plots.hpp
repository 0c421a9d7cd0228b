// Pictures of what a diagnosis found, drawn by gnuplot as SVG.
#pragma once

#include <string>

#include "shapeid/app/diagnosis_run.hpp"

namespace shapeid::app {

/// Hypotheses by held-out gain, as they stood beside rigid links alone.
[[nodiscard]] std::string ranking_picture(const DiagnosisRun& run);

/// Given and found inertia of a link as ellipses of its second moments, seen along y and z.
[[nodiscard]] std::string inertia_picture(const DiagnosisRun& run, const Robot& robot, int link);

/// The empirical curve of what stays unexplained.
[[nodiscard]] std::string structure_picture(const diagnosis::Structure& structure,
                                            const Robot& robot);

}  // namespace shapeid::app
