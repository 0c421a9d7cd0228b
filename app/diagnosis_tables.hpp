// The tables of the diagnosis' report: column heads first.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "shapeid/app/diagnosis_run.hpp"

namespace shapeid::app {

using Table = std::vector<std::vector<std::string>>;

/// With so many digits as a reader looks at; a dash for what is no number.
[[nodiscard]] std::string short_number(double x);

/// What was run, and with which of the numbers that answers depend on.
[[nodiscard]] Table how_made_table(const DiagnosisRun& run, const Robot& robot,
                                   const DiagnoseOptions& options);
[[nodiscard]] Table errors_table(const DiagnosisRun& run, const Robot& robot);

/// Effects whose name stands, or those that are descriptions alone; no rows but the heads if there
/// are none.
[[nodiscard]] Table findings_table(const DiagnosisRun& run, const Robot& robot, bool names_stand);

/// Of the free link at this place.
[[nodiscard]] Table parameters_table(const DiagnosisRun& run, const Robot& robot,
                                     std::size_t sought);

/// What a reader must know of a free link before its numbers: a sentence, or empty.
[[nodiscard]] std::string link_verdict(const DiagnosisRun& run, const Robot& robot,
                                       std::size_t sought);

/// How many of a free link's ten numbers the data determine.
[[nodiscard]] std::size_t determined_of_link(const DiagnosisRun& run, std::size_t sought);

}  // namespace shapeid::app
