// The verbs of the command. Each adds its options and its callback to the command line.
#pragma once

#include <CLI/CLI.hpp>

namespace shapeid::app {

void add_identify(CLI::App& app);
void add_batch(CLI::App& app);
void add_load(CLI::App& app);
void add_diagnose(CLI::App& app);
void add_track(CLI::App& app);
void add_inspect(CLI::App& app);
void add_convert(CLI::App& app);
void add_certify(CLI::App& app);
void add_vectors(CLI::App& app);
void add_simulate(CLI::App& app);
void add_demo(CLI::App& app);

}  // namespace shapeid::app
