#include "shapeid/tests/track/logs.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "shapeid/tests/app/command.hpp"
#include "shapeid/tests/support/files.hpp"

namespace shapeid::test {
namespace {

Lines split(const std::string& text, char at) {
  Lines parts;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, at);) parts.push_back(part);
  return parts;
}

std::size_t place(const Lines& log, const std::string& column) {
  const Lines columns = split(log.front(), ',');
  const auto found = std::find(columns.begin(), columns.end(), column);
  EXPECT_NE(found, columns.end()) << column;
  return static_cast<std::size_t>(found - columns.begin());
}

}  // namespace

Lines simulated(const std::string& name, const std::string& arguments) {
  return split(text_of(simulated_log(name + ".csv", arguments)), '\n');
}

const Lines& trot_log() {
  static const Lines log = simulated("trot", "--seconds 4 --rate 500");
  return log;
}

std::string joined(const Lines& lines) { return fmt::format("{}\n", fmt::join(lines, "\n")); }

void change(Lines& log, const std::string& column, std::size_t first, std::size_t last,
            const std::function<double(double)>& to) {
  const std::size_t at = place(log, column);
  for (std::size_t row = first + 1; row < std::min(last + 1, log.size()); ++row) {
    Lines fields = split(log[row], ',');
    fields[at] = fmt::format("{}", to(std::stod(fields[at])));
    log[row] = fmt::format("{}", fmt::join(fields, ","));
  }
}

Lines without_contacts(const Lines& log) {
  const Lines names = split(log.front(), ',');
  Lines result;
  for (const std::string& line : log) {
    const Lines fields = split(line, ',');
    std::string kept;
    for (std::size_t i = 0; i < fields.size(); ++i) {
      if (!names[i].starts_with("contact.")) kept += (kept.empty() ? "" : ",") + fields[i];
    }
    result.push_back(kept);
  }
  return result;
}

double value(const Lines& log, const std::string& column, std::size_t row) {
  return std::stod(split(log.at(row + 1), ',').at(place(log, column)));
}

std::string bundled_robot() {
  const std::string path = SHAPEID_SOURCE_DIR "/models/robots/quadruped.";
  return fmt::format("--robot {0}urdf --robot-yaml {0}robot.yaml --shapes {0}shapes.yaml", path);
}

std::string track(const std::string& options) {
  return fmt::format("track {} {}", bundled_robot(), options);
}

std::vector<nlohmann::json> tracked(const Lines& log, const std::string& options) {
  scratch_file("followed.csv", joined(log));
  const CommandRun run = shapeid(track(options + " followed.csv"));
  EXPECT_EQ(run.status, 0) << run.err;
  std::vector<nlohmann::json> lines;
  for (const std::string& line : split(run.out, '\n')) lines.push_back(nlohmann::json::parse(line));
  return lines;
}

}  // namespace shapeid::test
