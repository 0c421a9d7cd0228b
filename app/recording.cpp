#include "shapeid/app/recording.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

#include "shapeid/app/tell.hpp"
#include "shapeid/models/error.hpp"
#include "shapeid/models/log_writer.hpp"

namespace shapeid::app {

SimulationReport record(const Robot& robot, const RobotNotes& notes,
                        const SimulationOptions& simulation, const SensorOptions& sensors,
                        const std::string& path) {
  Sensors instruments(robot, notes, sensors);
  LogWriter log(path, instruments.columns());
  const bool on_terminal = ::isatty(STDERR_FILENO) != 0;
  std::size_t rows = 0;
  constexpr std::size_t rows_between_reports = 100;
  const SimulationReport report = simulate(robot, simulation, [&](const SimulatedSample& s) {
    log.write(instruments.measure(s.sample, Eigen::Quaterniond(s.state.base.linear())));
    if (on_terminal && ++rows % rows_between_reports == 0) {
      tell(fmt::format("\rsimulating: {:.1f} of {:.1f} s", s.sample.time, simulation.duration));
    }
  });
  if (on_terminal) tell("\r\033[K");
  if (report.fell_at) {
    throw Refusal("fell", fmt::format("the robot fell after {:.2f} s; try another seed, a slower "
                                      "gait or a lighter load",
                                      *report.fell_at));
  }
  log.close();
  return report;
}

}  // namespace shapeid::app
