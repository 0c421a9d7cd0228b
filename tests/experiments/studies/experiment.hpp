// The list of experiments.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "shapeid/tests/experiments/page/findings.hpp"

namespace shapeid::experiments {

struct Experiment {
  std::string name;
  std::function<Findings(Form)> run;
};

/// In the order of the page. Each can run alone. The last ones look at the clock and want the
/// machine to themselves.
[[nodiscard]] std::vector<Experiment> experiments();

}  // namespace shapeid::experiments
