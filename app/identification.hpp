// The run that `identify`, `load` and `demo` share: a log in, a result and its files out.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "shapeid/app/inputs.hpp"
#include "shapeid/app/judgement.hpp"
#include "shapeid/app/result.hpp"

namespace shapeid::app {

struct RunOptions {
  std::string test_log;  ///< held-out motion; empty: every fifth two seconds of the log
  std::string effects;   ///< effects.yaml: what is known besides rigid links; may be empty
  double least_mass = 0.0;
  reference::IdentifySettings settings;
};

/// Throws InputError for a test log that flows by, or that holds what is fitted.
void check_test_log(const RobotInputs& robot, const MotionInputs& inputs,
                    const RunOptions& options);

/// Fits, then measures the residual on motion that was not fitted.
[[nodiscard]] Result run_identification(
    const RobotInputs& robot, const BodyModel& model, const MotionInputs& inputs,
    const RunOptions& options,
    const std::function<void(const reference::DivisionRun&)>& watch = {});

/// Throws InputError for settings that no log can be identified with.
void check_solver(const reference::IdentifySettings& settings);

/// The settings with what robot and log say: contacts, weight, the rate of a row filter.
[[nodiscard]] reference::IdentifySettings settings_for(const LogSamples& log,
                                                       const RobotInputs& robot,
                                                       const MotionInputs& inputs,
                                                       reference::IdentifySettings settings);

/// Hz: rows are asked once more behind a filter of half the cutoff, of signals or rows, whichever
/// is lower, where noise of the motion is less; 0 where there is no filter.
[[nodiscard]] double slower_cutoff(const MotionInputs& inputs);

/// Where a result goes.
struct Delivery {
  std::string folder;  ///< empty: no files
  bool json = false;   ///< standard output gets the document instead of the text
};

/// Prints the result; writes result.json (the document, with what the exact checker says of it),
/// problem.json, answer.json, their certificate.json and identified.urdf into the folder, made if
/// it is not there. Throws logic_error, after that, if the checker rejects the answer: no input
/// should bring that about.
void deliver(const Delivery& delivery, nlohmann::json document, const std::string& text,
             const Result& result, const Judgement& judged, const RobotInputs& robot,
             const MotionInputs& inputs);

/// Before the work: throws InputError if nothing can be written where the result is to go.
void check_delivery(const Delivery& delivery);

void add_delivery_options(CLI::App& verb, Delivery& delivery);

/// Options of the division and the mass problem, for verbs that solve.
void add_solver_options(CLI::App& verb, reference::IdentifySettings& settings);
/// And the log that the residual is measured on.
void add_solver_options(CLI::App& verb, RunOptions& options);

}  // namespace shapeid::app
