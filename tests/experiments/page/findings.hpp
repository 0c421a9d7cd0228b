// What an experiment found: numbers by name, tables and plots for the page.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace shapeid::experiments {

/// Rows of text; the first is the head.
using Table = std::vector<std::vector<std::string>>;

/// Names read "table.trot.robot.ours.mass". Numbers are in SI units unless the name ends in a unit
/// ("_us", "_mm", "_percent"). What a clock said has a name that begins with "time.": it is no
/// result and is never compared.
struct Findings {
  std::map<std::string, double> values;
  std::map<std::string, Table> tables;
  std::map<std::string, std::string> plots;  ///< gnuplot scripts without their terminal

  /// Throws std::logic_error for a name that is taken or a number that is not finite.
  void set(const std::string& name, double value);
  /// Throws std::logic_error for names that both have.
  void merge(const Findings& other);
};

[[nodiscard]] nlohmann::json findings_to_json(const Findings& findings);
[[nodiscard]] Findings findings_from_json(const nlohmann::json& document);

/// How much is done.
enum class Form {
  small,  ///< for the test run: seconds
  quick,  ///< a minute for all experiments
  full    ///< what docs/experiments.md reports
};

}  // namespace shapeid::experiments
