// Measurements that stand in two logs: copies, cuttings, logs with another clock.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "shapeid/models/log.hpp"

namespace shapeid::app {

/// Throws InputError if a log has rows of another one. Whatever their times: a stretch that was cut
/// out begins at zero as a rule. What is fitted says nothing where it is tested, and what is fitted
/// twice says no more than once. `mapping`: the logs' own, if there is one. Reads every log once.
void refuse_shared_rows(const std::vector<std::string>& fitted,
                        const std::vector<std::string>& tested,
                        const std::optional<Mapping>& mapping);

}  // namespace shapeid::app
