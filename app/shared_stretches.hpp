// Measurements that stand in two logs: copies, cuttings, logs with another clock.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "shapeid/models/log.hpp"

namespace shapeid::app {

/// Logs by what they are for.
struct LogsByUse {
  std::vector<std::string> fitted;
  std::vector<std::string> earlier = {};  ///< of the same robot: may be what a fitted one begins as
  std::vector<std::string> tested = {};
};

/// Throws InputError if a log is given twice, or holds a stretch of another one: a tested log of
/// any other, a fitted one of another fitted one. By joint angles and torques alone, whatever the
/// times: a stretch that was cut out begins at zero as a rule. `mapping`: the logs' own, if there
/// is one. Reads every log once, if there are several, in memory that does not grow with it, so
/// many at once as there are threads. What cannot be read is left to who reads it next.
void refuse_same_data(const LogsByUse& logs, const std::optional<Mapping>& mapping,
                      std::size_t threads = 1);

}  // namespace shapeid::app
