// Logs of a trot to follow, and what can be done to them; lines of `track` read back.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace shapeid::test {

/// A log as text: the header first, a row a line.
using Lines = std::vector<std::string>;

/// The bundled quadruped trots with noisy sensors.
[[nodiscard]] const Lines& trot_log();

/// What simulated_log() writes, read back.
[[nodiscard]] Lines simulated(const std::string& name, const std::string& arguments);

[[nodiscard]] std::string joined(const Lines& lines);

/// Changes the number of a column in rows `first` (0 is the first row) to before `last`.
void change(Lines& log, const std::string& column, std::size_t first, std::size_t last,
            const std::function<double(double)>& to);

/// Without its columns contact.*.
[[nodiscard]] Lines without_contacts(const Lines& log);

/// Number of a column in a row.
[[nodiscard]] double value(const Lines& log, const std::string& column, std::size_t row);

/// Options that name the bundled robot and its shapes.
[[nodiscard]] std::string bundled_robot();

/// Arguments of `shapeid` that track the bundled robot.
[[nodiscard]] std::string track(const std::string& options);

/// `shapeid track` over a log that is written to a file first; one document a line. Fails the test
/// if the command does.
[[nodiscard]] std::vector<nlohmann::json> tracked(const Lines& log,
                                                  const std::string& options = "");

}  // namespace shapeid::test
