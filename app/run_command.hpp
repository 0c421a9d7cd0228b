// A program of ours from its arguments to its exit status.
#pragma once

#include <CLI/CLI.hpp>

namespace shapeid::app {

/// Parses the arguments, which runs the callbacks of `app`. Returns 0 done, 1 the answer is no, 2
/// bad input (an output that cannot be written among it), 3 a defect of ours; all but 0 come with
/// one line on standard error.
[[nodiscard]] int run_command(CLI::App& app, int argc, char** argv);

}  // namespace shapeid::app
