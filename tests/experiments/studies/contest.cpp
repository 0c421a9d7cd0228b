#include "shapeid/tests/experiments/studies/contest.hpp"

#include "shapeid/models/shapes_yaml.hpp"
#include "shapeid/reference/filter.hpp"

namespace shapeid::experiments {

Setting base_setting(const test::Quadruped& quadruped) {
  // A guess as a user would make it: the middle of robot.yaml's range, and a trunk of 40 x 20 cm.
  constexpr double half_width = 0.1;
  const std::string points = SHAPEID_SOURCE_DIR "/models/robots/quadruped.points.yaml";
  return {quadruped.base, read_shapes_yaml(points, quadruped.robot), half_width,
          expected_mass(quadruped.robot, quadruped.notes, quadruped.base.free_links)};
}

std::vector<Contestant> contestants(const Setting& setting) {
  constexpr double closed = 0.01;
  constexpr int most_divisions = 300;
  std::vector<Contestant> all;
  all.push_back({"linear", "Linear", make_linear()});
  all.push_back({"nonlinear", "Nonlinear", make_nonlinear(setting, Effort::hard)});
  all.push_back({"full", "Full", make_full(setting)});
  all.push_back({"points", "Points", make_shapes(setting.points)});
  all.push_back({"ours", "Ours", make_shapes(setting.shapes)});
  all.push_back({"divided", "Ours, divided", make_divided(setting, closed, most_divisions)});
  return all;
}

Course run(Method& method, const std::vector<TimedWindow>& windows) {
  Course course;
  reference::ParameterFilter filter(0.5);
  for (const TimedWindow& window : windows) {
    course.answers.push_back(method.answer(window.f));
    course.filtered.emplace_back(filter.update(course.answers.back().Phi));
  }
  return course;
}

}  // namespace shapeid::experiments
