#include "shapeid/tests/experiments/studies/experiment.hpp"

#include "shapeid/tests/experiments/studies/criterion.hpp"
#include "shapeid/tests/experiments/studies/load_grid.hpp"
#include "shapeid/tests/experiments/studies/load_influence.hpp"
#include "shapeid/tests/experiments/studies/measured.hpp"
#include "shapeid/tests/experiments/studies/table_one.hpp"
#include "shapeid/tests/experiments/studies/times.hpp"

namespace shapeid::experiments {

std::vector<Experiment> experiments() {
  std::vector<Experiment> all;
  for (const Gait& gait : gaits()) {
    all.push_back({"methods_" + gait.name, [gait](Form form) { return table_one(gait, form); }});
  }
  all.push_back({"load_grid", load_grid});
  all.push_back({"load_shapes", load_shapes});
  all.push_back({"load_influence", load_influence});
  all.push_back({"criterion", criterion});
  all.push_back({"measured", measured_logs});
  all.push_back({"times", times});
  return all;
}

}  // namespace shapeid::experiments
