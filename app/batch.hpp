// One identification from many logs, each compressed by itself.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "shapeid/app/identification.hpp"
#include "shapeid/app/peers.hpp"
#include "shapeid/app/sought.hpp"

namespace shapeid::app {

struct BatchOptions {
  MotionInputs inputs;  ///< how logs are read; which ones stands in `logs`
  std::vector<std::string> logs;
  SoughtLinks sought;
  reference::IdentifySettings settings;
  double least_mass = 0.0;  ///< kg
  std::size_t threads = 1;
  /// Neighbouring logs are merged until there are no more than this many blocks, by whose spread
  /// the errors are judged.
  std::size_t most_blocks = reference::most_blocks;
  bool skip_refused = false;
  Delivery delivery;

  void add_to(CLI::App& verb);
};

/// What became of a log.
struct BatchLog {
  std::string path;
  std::string refused;  ///< why; empty for a log that was used
  std::string code;     ///< of a refusal; empty also where the log is bad input
  std::size_t rows = 0, samples = 0, gaps = 0;
  double rate = 0.0;  ///< Hz
  bool contacts_derived = false;
  std::vector<std::string> notes;
  /// Root of the mean over samples of || W^(1/2) (Y Phi - F) ||^2, free of contact forces, with the
  /// parameters found from all logs. Zero for a log that was refused.
  double residual = 0.0;
};

struct BatchResult {
  Result result;
  std::vector<BatchLog> logs;  ///< in the order given
};

/// Compresses this process's share of the logs, on so many threads, merges in an order that depends
/// on the number of logs alone, and solves. The same numbers to the last bit for any number of
/// threads and processes. Empty for all processes but number 0. Throws InputError if a log is
/// refused and `skip_refused` is not set, or if all are.
[[nodiscard]] std::optional<BatchResult> run_batch(const BatchOptions& options,
                                                   const RobotInputs& robot, const BodyModel& model,
                                                   Peers& peers);

/// Reads the robot, runs the batch, and delivers it from process number 0.
void batch(const BatchOptions& options, Peers& peers);

}  // namespace shapeid::app
