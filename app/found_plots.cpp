#include "shapeid/app/found_plots.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "shapeid/app/gnuplot.hpp"
#include "shapeid/app/plot_script.hpp"
#include "shapeid/app/result.hpp"
#include "shapeid/diagnosis/slowness.hpp"

namespace shapeid::app {

std::string ranking_picture(const DiagnosisRun& run) {
  constexpr std::size_t shown = 15;
  std::vector<diagnosis::Ranked> best;  // of hypotheses of one name
  std::set<std::string> names;
  for (const diagnosis::Ranked& r : run.loop.first_ranking) {
    if (best.size() < shown && names.insert(r.id).second) best.push_back(r);
  }
  const auto count = std::ssize(best);
  std::string script = canvas(plot_width, 80 + 24 * static_cast<int>(count)) +
                       "unset key\nset lmargin 36\nset xlabel 'held-out gain (% of the squared "
                       "error)'\nset style fill solid 0.8\nset yrange [*:*] reverse\n$d << EOD\n";
  for (Eigen::Index i = 0; i < count; ++i) {
    const diagnosis::Ranked& r = best[static_cast<std::size_t>(i)];
    const double error = r.t > 0.0 ? 100.0 * std::abs(r.gain / r.t) : 0.0;
    script += fmt::format("{} {:.4g} {:.4g} {}\n", i, 100.0 * r.gain, error,
                          gnuplot_entry(r.credible ? r.id : r.id + " *"));
  }
  script += fmt::format(
      "EOD\nplot $d using (0):1:(0):2:($1-0.35):($1+0.35):ytic(4) with boxxyerrorbars lc rgb '{}', "
      "$d using 2:1:3 with xerrorbars pt 0 lc rgb '#333333'\n",
      blue);
  return gnuplot(script);
}

std::string inertia_picture(const DiagnosisRun& run, const Robot& robot, int link) {
  const auto outline = [](const InertialParameters& body, int a, int b) {
    std::vector<std::array<double, 2>> points;
    if (!(body.mass() > 0.0)) return points;
    const Eigen::Matrix3d about = body.tensor_about_centre();
    const Eigen::Matrix3d moments =
        (0.5 * about.trace() * Eigen::Matrix3d::Identity() - about) / body.mass();
    Eigen::Matrix2d plane;
    plane << moments(a, a), moments(a, b), moments(b, a), moments(b, b);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(plane);
    const Eigen::Matrix2d root =
        eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
    const Eigen::Vector3d centre = body.centre_of_mass();
    constexpr int corners = 60;
    for (int i = 0; i <= corners; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / corners;
      // The ellipsoid of uniform density with these moments has sqrt(5) of their roots as axes.
      const Eigen::Vector2d p =
          Eigen::Vector2d(centre[a], centre[b]) +
          std::sqrt(5.0) * root * Eigen::Vector2d(std::cos(angle), std::sin(angle));
      points.push_back({p.x(), p.y()});
    }
    return points;
  };
  const InertialParameters given = robot.links[static_cast<std::size_t>(link)].inertia;
  const InertialParameters found{run.consistent.model.Phi.segment<10>(Eigen::Index{10} * link)};
  constexpr int height = 280, panels = 2;
  // What labels and key leave of a panel, pixels; the same scale in both directions.
  constexpr double across = static_cast<double>(plot_width) / panels - 110.0, up = height - 95.0;
  std::string script = canvas(plot_width, height) +
                       "set multiplot layout 1,2\nset size ratio -1\nset xlabel 'x (m)'\n";
  const std::array<std::pair<int, const char*>, 2> views = {std::pair{2, "z (m)"}, {1, "y (m)"}};
  for (const auto& [axis, label] : views) {
    std::string plots;
    std::vector<double> along, upward;
    for (const bool is_found : {false, true}) {
      const auto points = outline(is_found ? found : given, 0, axis);
      if (points.empty()) continue;
      for (const auto& [x, y] : points) {
        along.push_back(x);
        upward.push_back(y);
      }
      const std::string name = is_found ? "found" : "given";
      script += data_rows(name, std::ssize(points),
                          [&](Eigen::Index i) { return points[static_cast<std::size_t>(i)]; });
      plots += fmt::format("{}${} with lines lw 2 lc rgb '{}' title '{}'",
                           plots.empty() ? "" : ", ", name, is_found ? blue : orange, name);
    }
    if (plots.empty()) return {};
    const Span x = Span::around(along), y = Span::around(upward);
    const double scale = std::min(across / (x.high - x.low), up / (y.high - y.low));
    script += x_axis(x, scale * (x.high - x.low));
    script += fmt::format("set yrange [{:.9g}:{:.9g}]\nset ytics {:g}\nset ylabel '{}'\nplot {}\n",
                          y.low, y.high, step_up(y, scale * (y.high - y.low)), label, plots);
  }
  return gnuplot(script + "unset multiplot\n");
}

namespace {

/// Of a signal by its name; none of a log's further columns.
std::string unit_of_signal(const std::string& variable, const Robot& robot) {
  constexpr std::array<std::array<const char*, 2>, 5> kinds = {
      {{"q.", "rad"}, {"dq.", "rad/s"}, {"ddq.", "rad/s^2"}, {"tau.", "N m"}, {"dtau.", "N m/s"}}};
  for (const auto& [prefix, unit] : kinds) {
    if (!variable.starts_with(prefix)) continue;
    const auto joint = robot.find_joint(variable.substr(std::string_view(prefix).size()));
    if (joint) return unit_at(robot.joint(*joint), unit);
  }
  return variable == "time" ? "s" : variable == diagnosis::slow ? "Hz" : "";
}

std::string with_unit(const std::string& name, const std::string& unit) {
  return unit.empty() ? name : fmt::format("{} ({})", name, unit);
}

}  // namespace

std::string structure_picture(const diagnosis::Structure& structure, const Robot& robot) {
  constexpr int structure_width = 420;
  std::string script = canvas(structure_width, 240) + "unset key\n" +
                       data_rows("d", std::ssize(structure.at), [&](Eigen::Index i) {
                         const auto k = static_cast<std::size_t>(i);
                         return std::array{structure.at[k], structure.value[k]};
                       });
  const auto joint = robot.find_joint(structure.joint);
  const bool spectrum = structure.variable == diagnosis::slow;
  // The joint, and the law, stand below the picture: a long name would not fit beside it.
  const std::string up =
      structure.law.empty()
          ? with_unit(spectrum ? "amplitude" : "residual",
                      joint ? unit_at(robot.joint(*joint), "N m") : joints_unit(robot))
          : with_unit("its number", structure.law_unit);
  const std::string along =
      with_unit(structure.variable, unit_of_signal(structure.variable, robot));
  constexpr double beside = 110.0;  // pixels
  return gnuplot(script + x_axis(Span::around(structure.at), structure_width - beside) +
                 fmt::format("set format y '%g'\nset yrange [{}:*]\nset xlabel {}\nset ylabel {}\n"
                             "plot $d with linespoints pt 7 ps 0.5 lc rgb '{}'\n",
                             spectrum ? "0" : "*", gnuplot_string(along), gnuplot_string(up),
                             blue));
}

}  // namespace shapeid::app
