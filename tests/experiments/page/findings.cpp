#include "shapeid/tests/experiments/page/findings.hpp"

#include <cmath>
#include <stdexcept>

namespace shapeid::experiments {

void Findings::set(const std::string& name, double value) {
  if (!std::isfinite(value)) throw std::logic_error(name + " is not finite");
  if (!values.emplace(name, value).second) throw std::logic_error(name + " is there already");
}

void Findings::merge(const Findings& other) {
  for (const auto& [name, value] : other.values) set(name, value);
  const auto add = [](auto& to, const auto& from) {
    for (const auto& entry : from) {
      if (!to.insert(entry).second) throw std::logic_error(entry.first + " is there already");
    }
  };
  add(tables, other.tables);
  add(plots, other.plots);
}

nlohmann::json findings_to_json(const Findings& findings) {
  return {{"values", findings.values}, {"tables", findings.tables}, {"plots", findings.plots}};
}

Findings findings_from_json(const nlohmann::json& document) {
  Findings findings;
  document.at("values").get_to(findings.values);
  document.at("tables").get_to(findings.tables);
  document.at("plots").get_to(findings.plots);
  return findings;
}

}  // namespace shapeid::experiments
