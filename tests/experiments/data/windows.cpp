#include "shapeid/tests/experiments/data/windows.hpp"

#include <stdexcept>

#include "shapeid/fast/window.hpp"

namespace shapeid::experiments {

std::vector<TimedWindow> windows(const Robot& robot, const BodyModel& model,
                                 const std::vector<Sample>& samples, std::size_t length) {
  fast::Window rows(robot, model, ContactTreatment::project, Eigen::VectorXd::Ones(robot.dof()));
  std::vector<TimedWindow> all;
  for (const Sample& sample : samples) {
    if (rows.add(sample) != fast::Verdict::taken) throw std::runtime_error("sample declined");
    if (rows.samples() < length) continue;
    all.push_back({sample.time, DataTerm(rows.triangle().R())});
    rows.clear();
  }
  return all;
}

DataTerm whole(const Robot& robot, const BodyModel& model, const std::vector<Sample>& samples) {
  return windows(robot, model, samples, samples.size()).front().f;
}

}  // namespace shapeid::experiments
