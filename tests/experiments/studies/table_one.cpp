#include "shapeid/tests/experiments/studies/table_one.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "shapeid/reference/residual.hpp"
#include "shapeid/tests/experiments/data/errors.hpp"
#include "shapeid/tests/experiments/page/plot.hpp"
#include "shapeid/tests/experiments/page/spread_table.hpp"
#include "shapeid/tests/experiments/studies/contest.hpp"
#include "shapeid/tests/experiments/studies/order.hpp"

namespace shapeid::experiments {
namespace {

struct Size {
  std::uint64_t seeds;
  double seconds;
};

Size size_of(Form form) {
  switch (form) {
    case Form::small:
      return {2, 0.2};
    case Form::quick:
      return {2, 0.6};
    case Form::full:
      break;
  }
  return {10, 5.0};  // 250 windows of 20 ms
}

/// One seed's motion in both forms.
struct Trial {
  std::vector<Sample> exact, robot;
};

struct Laboratory {
  test::Quadruped quadruped = test::bundled_quadruped();
  Setting setting = base_setting(quadruped);
  std::vector<Contestant> contestants = experiments::contestants(setting);
  Vector10 truth = quadruped.robot.links[0].inertia.values;
};

/// Numbers of one seed by name; then of all seeds.
using Numbers = std::map<std::string, double>;
using AllNumbers = std::map<std::string, std::vector<double>>;

Numbers judge(const Course& course, const std::vector<TimedWindow>& windows,
              const Vector10& truth) {
  Numbers sums;
  const std::size_t n = windows.size();
  for (std::size_t k = 0; k < n; ++k) {
    const Answer& answer = course.answers[k];
    const DataTerm& f = windows[k].f;
    const ParameterError e = parameter_error(course.filtered[k], truth);
    sums["mass"] += e.mass;
    sums["first"] += e.first_moment;
    sums["tensor"] += e.tensor;
    sums["published"] += e.published;
    sums["raw"] += parameter_error(answer.Phi, truth).published;
    sums["before"] += answer.value;
    sums["after"] += f.value(course.filtered[k]);
    // The last window has no next one: the one before it counts twice.
    sums["next"] += windows[std::min(k + 1, n - 1)].f.value(course.filtered[std::min(k, n - 2)]);
    sums["pieces"] += answer.pieces;
  }
  for (auto& [name, sum] : sums) sum /= static_cast<double>(n);
  for (std::size_t k = 0; k < n; ++k) {
    const Answer& answer = course.answers[k];
    const double gap = (answer.value - answer.floor) / windows[k].f.size();
    sums["gap"] = std::max(sums["gap"], gap);
  }
  return sums;
}

/// All of the joints' residual torque on another motion, N m: root of the sum of mean squares.
std::vector<double> unseen(const Laboratory& lab, const std::vector<Vector10>& bases,
                           const std::vector<Sample>& samples) {
  std::vector<Eigen::VectorXd> models;
  models.reserve(bases.size());
  for (const Vector10& base : bases) models.push_back(all_parameters(lab.quadruped.base, base));
  reference::ResidualTable table(lab.quadruped.robot, ContactTreatment::project, models);
  constexpr std::size_t every = 5;  // at 20 Hz cutoff neighbours say the same
  for (std::size_t i = 0; i < samples.size(); i += every) table.add(samples[i]);
  const Eigen::MatrixXd joints = table.rms().bottomRows(lab.quadruped.robot.joint_count());
  std::vector<double> sums;
  for (Eigen::Index k = 0; k < joints.cols(); ++k) sums.push_back(joints.col(k).norm());
  return sums;
}

Table table(const Findings& findings, const Laboratory& lab, const std::string& start) {
  Table rows = {{"method", "unknowns", "f", "f after (17)", "f of the next window", "mass, kg",
                 "first moment, kg m", "tensor, kg m^2", "2-norm, mixed", "unseen motion, N m"}};
  for (const Contestant& c : lab.contestants) {
    const std::string name = start + c.key + ".";
    rows.push_back({c.words, median(findings, name + "pieces"), median(findings, name + "before"),
                    median(findings, name + "after"), median(findings, name + "next"),
                    with_spread(findings, name + "mass"), with_spread(findings, name + "first"),
                    with_spread(findings, name + "tensor"),
                    with_spread(findings, name + "published"),
                    with_spread(findings, name + "unseen")});
  }
  return rows;
}

/// Figures 4 and 5: filtered parameters over time against the truth.
std::string over_time(const Laboratory& lab, const std::vector<TimedWindow>& windows,
                      const std::vector<Course>& courses) {
  struct Shown {
    Eigen::Index entry;
    std::string label;
    double around;  ///< half the range of the axis
  };
  // Ranges about the truth within which most methods stay; the others leave the picture.
  const std::vector<Shown> shown = {{0, "mass (kg)", 0.4},    {1, "m rx (kg m)", 0.2},
                                    {2, "m ry (kg m)", 0.1},  {3, "m rz (kg m)", 0.2},
                                    {7, "Iyy (kg m^2)", 0.2}, {9, "Izz (kg m^2)", 0.2}};
  std::vector<Panel> panels;
  for (const Shown& s : shown) {
    const double truth = lab.truth[s.entry];
    Panel panel{"s", s.label, {}, ""};
    panel.settings = fmt::format("set yrange [{}:{}]\n", truth - s.around, truth + s.around);
    for (std::size_t i = 0; i < courses.size(); ++i) {
      Curve curve{lab.contestants[i].words, {}};
      for (std::size_t k = 0; k < windows.size(); ++k) {
        const double y = courses[i].filtered[k][s.entry];
        curve.points.emplace_back(windows[k].time, y);
      }
      panel.curves.push_back(curve);
    }
    panel.curves.push_back(
        {"truth", {{windows.front().time, truth}, {windows.back().time, truth}}});
    panels.push_back(panel);
  }
  return plot(panels);
}

/// Figures 8 and 9: torques of a leg's hip and knee after projection, on a motion that was not
/// fitted: measured, and what the methods' predictions lack.
std::string torques(const Laboratory& lab, const std::vector<Course>& courses,
                    const std::vector<Sample>& samples) {
  const Robot& robot = lab.quadruped.robot;
  const std::vector<std::size_t> shown = {0, 2, 4};  // Linear, Full, Ours
  std::vector<Panel> panels;
  for (const int joint : {1, 2}) {
    const Eigen::Index row = 6 + joint;
    const std::string& name = robot.joint(joint).name;
    Panel torque{"s", name + " (N m)", {{"measured", {}}, {"Ours", {}}}, ""};
    Panel error{"s", "predicted - measured", {}, ""};
    std::vector<Eigen::VectorXd> models;
    for (const std::size_t i : shown) {
      error.curves.push_back({lab.contestants[i].words, {}});
      models.push_back(all_parameters(lab.quadruped.base, courses[i].filtered.back()));
    }
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(models.front().size());
    for (const Sample& s : samples) {
      const auto lacks = [&](const Eigen::VectorXd& Phi) {
        return reference::residual(robot, s, Phi, ContactTreatment::project)[row];
      };
      const double logged = -lacks(none);
      torque.curves[0].points.emplace_back(s.time, logged);
      torque.curves[1].points.emplace_back(s.time, logged + lacks(models.back()));
      for (std::size_t i = 0; i < models.size(); ++i) {
        error.curves[i].points.emplace_back(s.time, lacks(models[i]));
      }
    }
    panels.push_back(torque);
    panels.push_back(error);
  }
  return plot(panels);
}

}  // namespace

Findings table_one(const Gait& gait, Form form) {
  const Size size = size_of(form);
  Laboratory lab;
  std::vector<Trial> trials;
  for (std::uint64_t seed = 1; seed <= size.seeds; ++seed) {
    const auto motion = simulated(lab.quadruped.robot, {gait, size.seconds, seed, {}});
    trials.push_back({exact(motion, size.seconds),
                      measured(lab.quadruped, motion, size.seconds, {1.0, 20.0, seed})});
  }
  Findings findings;
  for (const auto& [data, samples_of] :
       {std::pair{"exact", &Trial::exact}, std::pair{"robot", &Trial::robot}}) {
    const std::string start = fmt::format("methods.{}.{}.", gait.name, data);
    AllNumbers all;
    OrderCount order;
    for (std::size_t s = 0; s < trials.size(); ++s) {
      const auto fitted =
          windows(lab.quadruped.robot, lab.quadruped.base, trials[s].*samples_of, published_window);
      const std::vector<Sample>& other = trials[(s + 1) % trials.size()].*samples_of;
      count_order(lab.setting, fitted, order);
      std::vector<Course> courses;
      std::vector<Vector10> last = {lab.truth};
      for (const Contestant& c : lab.contestants) {
        courses.push_back(run(*c.method, fitted));
        last.push_back(courses.back().filtered.back());
        for (const auto& [what, number] : judge(courses.back(), fitted, lab.truth)) {
          all[c.key + "." + what].push_back(number);
        }
      }
      const std::vector<double> rms = unseen(lab, last, other);
      all["truth.unseen"].push_back(rms[0]);
      for (std::size_t i = 0; i < lab.contestants.size(); ++i) {
        all[lab.contestants[i].key + ".unseen"].push_back(rms[i + 1]);
      }
      if (s == 0 && start == "methods.trot.robot.") {
        findings.plots["parameters"] = over_time(lab, fitted, courses);
        const std::vector<Sample> second(other.begin(),
                                         other.begin() + std::min<long>(500, std::ssize(other)));
        findings.plots["torques"] = torques(lab, courses, second);
      }
    }
    for (const auto& [name, numbers] : all) set_spread(findings, start + name, numbers);
    findings.tables[start + "errors"] = table(findings, lab, start);
    report(fmt::format("{}.{}", gait.name, data), order, findings);
  }
  return findings;
}

}  // namespace shapeid::experiments
