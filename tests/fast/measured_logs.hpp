// Logs of real robots, which lie outside the project.
#pragma once

#include <string>
#include <vector>

#include "shapeid/models/robot.hpp"
#include "shapeid/models/sample.hpp"

namespace shapeid::test {

/// Whether the file is not among the data; says so where it is not.
[[nodiscard]] bool absent(const std::string& file);

struct Log {
  Robot robot;
  std::vector<Sample> samples;  ///< of its beginning
};

/// The first samples of a log, at most `most`. `urdf` and `file` are places in the data, `mapping`
/// is the name of a mapping among the examples.
[[nodiscard]] Log log_of(const std::string& urdf, Root root, const std::string& file,
                         const std::string& mapping, std::size_t most);

}  // namespace shapeid::test
