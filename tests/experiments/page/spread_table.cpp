#include "shapeid/tests/experiments/page/spread_table.hpp"

#include <fmt/format.h>

#include "shapeid/tests/experiments/page/statistics.hpp"

namespace shapeid::experiments {

void set_spread(Findings& findings, const std::string& name, const std::vector<double>& numbers) {
  const Spread s = spread(numbers);
  findings.set(name + ".lowest", s.lowest);
  findings.set(name + ".median", s.median);
  findings.set(name + ".highest", s.highest);
}

std::string with_spread(const Findings& findings, const std::string& name) {
  return fmt::format("{:.3g} ({:.3g} to {:.3g})", findings.values.at(name + ".median"),
                     findings.values.at(name + ".lowest"), findings.values.at(name + ".highest"));
}

std::string median(const Findings& findings, const std::string& name) {
  return fmt::format("{:.3g}", findings.values.at(name + ".median"));
}

}  // namespace shapeid::experiments
