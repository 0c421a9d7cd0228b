#include "shapeid/app/plots.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "shapeid/app/gnuplot.hpp"

namespace shapeid::app {
namespace {

struct Rectangle {
  Eigen::Vector2d lower, upper;
  double density;  ///< kg / m^2 seen from above
};

std::vector<Rectangle> rectangles(const BodyModel& model, const Eigen::VectorXd& masses) {
  std::vector<Rectangle> seen;
  for (std::size_t j = 0; j < model.shapes.size(); ++j) {
    const auto [lower, upper] = bounds(model.shapes[j].shape);
    const Eigen::Vector2d a = lower.head<2>(), b = upper.head<2>();
    const double area = std::max((b - a).prod(), 1e-12);  // a point has no area
    seen.push_back({a, b, masses[static_cast<Eigen::Index>(j)] / area});
  }
  return seen;
}

/// One block of data under `name`, readable by gnuplot's plot command.
std::string data_block(const std::string& name, const std::vector<double>& values, double factor) {
  std::string block = fmt::format("${} << EOD\n", name);
  for (std::size_t i = 0; i < values.size(); ++i) {
    block += fmt::format("{} {}\n", i, factor * values[i]);
  }
  return block + "EOD\n";
}

}  // namespace

std::string division_picture(const BodyModel& model, const Eigen::VectorXd& masses,
                             const std::optional<Eigen::Vector3d>& truth) {
  const std::vector<Rectangle> seen = rectangles(model, masses);
  double densest = 0.0, mass = 0.0;
  Eigen::Vector2d lower = seen.front().lower, upper = seen.front().upper;
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  for (std::size_t j = 0; j < seen.size(); ++j) {
    densest = std::max(densest, seen[j].density);
    lower = lower.cwiseMin(seen[j].lower);
    upper = upper.cwiseMax(seen[j].upper);
    const double m = masses[static_cast<Eigen::Index>(j)];
    const auto unit = unit_parameters(model.shapes[j].shape);
    centre += m * unit.first_moment().head<2>();
    mass += m;
  }
  std::string script = fmt::format(
      "set terminal svg size 760,420 background '#ffffff' font 'sans-serif,13'\n"
      "set size ratio -1\nset xlabel 'x (m)'\nset ylabel 'y (m)'\nunset key\n"
      "set xrange [{}:{}]\nset yrange [{}:{}]\n",
      lower.x() - 0.01, upper.x() + 0.01, lower.y() - 0.01, upper.y() + 0.01);
  int object = 0;
  for (const Rectangle& r : seen) {
    const int shade = densest > 0.0 ? static_cast<int>(255.0 - 215.0 * r.density / densest) : 255;
    script += fmt::format(
        "set object {} rectangle from {},{} to {},{} fillstyle solid border lc rgb '#7f7f7f' "
        "fillcolor rgb '#{:02x}{:02x}ff'\n",
        ++object, r.lower.x(), r.lower.y(), r.upper.x(), r.upper.y(), shade, shade);
  }
  script += "$found << EOD\n";
  if (mass > 0.0) script += fmt::format("{} {}\n", centre.x() / mass, centre.y() / mass);
  script += "EOD\n$truth << EOD\n";
  if (truth) script += fmt::format("{} {}\n", truth->x(), truth->y());
  script += "EOD\nplot 1/0";  // an empty plot, should there be no point to draw
  if (mass > 0.0) script += ", $found with points pt 6 ps 1.6 lw 2 lc rgb '#d62728'";
  if (truth) script += ", $truth with points pt 2 ps 1.4 lw 2 lc rgb '#000000'";
  return gnuplot(script + "\n");
}

std::string trace_picture(const DivisionTrace& trace) {
  std::string script =
      "set terminal svg size 760,640 background '#ffffff' font 'sans-serif,13'\n" +
      data_block("objective", trace.objective, 1.0) + data_block("mass", trace.mass_error, 1e3) +
      data_block("place", trace.place_error, 1e3) + data_block("time", trace.seconds, 1e3);
  script +=
      "set multiplot layout 3,1\nset grid\nset lmargin 12\n"
      "set ylabel 'objective'\nset logscale y\nset format y '%.2g'\n"
      "plot $objective with linespoints pt 7 ps 0.4 lc rgb '#1f77b4' notitle\n"
      "set ylabel 'error'\nset key top right\n"
      "plot $mass with linespoints pt 7 ps 0.4 lc rgb '#d62728' title 'mass (g)', "
      "$place with linespoints pt 7 ps 0.4 lc rgb '#2ca02c' title 'place (mm)'\n"
      "unset logscale y\nset format y '%g'\nset yrange [0:*]\nset ylabel 'time (ms)'\nset xlabel "
      "'divisions'\n"
      "plot $time with linespoints pt 7 ps 0.4 lc rgb '#7f7f7f' notitle\n"
      "unset multiplot\n";
  return gnuplot(script);
}

}  // namespace shapeid::app
