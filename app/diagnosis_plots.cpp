#include "shapeid/app/diagnosis_plots.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "shapeid/app/gnuplot.hpp"
#include "shapeid/app/plot_script.hpp"
#include "shapeid/app/result.hpp"
#include "shapeid/app/ticks.hpp"
#include "shapeid/diagnosis/spectrum.hpp"

namespace shapeid::app {
namespace {

const Sample& sample_at(const DiagnosisRun& run, Eigen::Index i) {
  return run.test[run.after.index[static_cast<std::size_t>(i)]];
}

/// First and end of the samples within `seconds` in which the joint moves most.
std::pair<Eigen::Index, Eigen::Index> liveliest(const DiagnosisRun& run, int joint,
                                                double seconds) {
  const Eigen::Index all = run.after.residual.cols();
  std::pair<Eigen::Index, Eigen::Index> best = {0, 0};
  double motion = 0.0, most = -1.0;
  for (Eigen::Index from = 0, end = 0; from < all; ++from) {
    const double start = sample_at(run, from).time;
    for (; end < all && sample_at(run, end).time - start < seconds; ++end) {
      motion += std::pow(sample_at(run, end).dq[joint], 2);
    }
    if (motion > most) {
      most = motion;
      best = {from, end};
    }
    motion -= std::pow(sample_at(run, from).dq[joint], 2);
  }
  return best;
}

constexpr double pixels_left = 102.0, pixels_right = 16.0;  // of a plot with labels beside it

/// Margins of a multiplot: gnuplot leaves a label out without a word where it has no room.
std::string margins_with_labels(int height, double pixels_above) {
  constexpr double below = 56.0;
  return fmt::format("{:.4f},{:.4f},{:.4f},{:.4f}", pixels_left / plot_width,
                     1.0 - pixels_right / plot_width, below / height, 1.0 - pixels_above / height);
}

/// Vertical lines through a point: marks that points, which are round, can be compared with.
std::string upright_marks(int column, const std::string& look, const char* title) {
  return fmt::format("$d using {}:($1-0.32):(0):(0.64) with vectors nohead {} title '{}'", column,
                     look, title);
}

}  // namespace

// A model is often some hundred times better than none, and what was found twice as good as that:
// on a linear axis nothing but the error of none can be seen. Places on a logarithmic axis say it;
// bars there would be as long as one likes.
std::string errors_picture(const DiagnosisRun& run, const Robot& robot) {
  const int base = robot.base_dof();
  const TestErrors& e = run.errors;
  std::string rows;
  std::vector<double> all;
  std::size_t longest = 0;
  for (int j = 0; j < robot.joint_count(); ++j) {
    const std::array errors = {e.zero[base + j], e.given[base + j], e.found[base + j],
                               e.noise_floor[j]};
    rows += fmt::format("{} {:.5g} {}\n", j, fmt::join(errors, " "),
                        gnuplot_entry(robot.joint(j).name));
    longest = std::max(longest, robot.joint(j).name.size());
    for (const double x : errors) {
      if (std::isfinite(x) && x > 0.0) all.push_back(x);
    }
  }
  if (all.empty()) return {};
  constexpr double beyond = 1.3;
  const auto [least, most] = std::minmax_element(all.begin(), all.end());
  const Span span{*least / beyond, *most * beyond};
  const int margin = static_cast<int>(std::min<std::size_t>(longest, 36)) + 3;  // letters
  const double pixels = plot_width - 7.5 * margin - 40.0;
  std::string script =
      canvas(plot_width, 110 + 28 * robot.joint_count()) +
      fmt::format(
          "set format x '%g'\nset key samplen 1.5\nset tmargin 3.2\nset bmargin 3.5\nset lmargin "
          "{}\n"
          "set yrange [{}:-0.6]\nset logscale x\n"
          "set xrange [{:.6g}:{:.6g}]\nset xtics ({:g})\n"
          "set xlabel 'residual ({}, rms)'\n$d << EOD\n{}EOD\n",
          margin, robot.joint_count() - 0.4, span.low, span.high,
          fmt::join(logarithmic_ticks(span, pixels), ", "), joints_unit(robot), rows);
  script +=
      "plot " + upright_marks(2, fmt::format("lw 4 lc rgb '{}'", grey), "predicting zero") + ", ";
  if (!e.noise_floor.array().isNaN().all()) {
    script += upright_marks(5, "lw 1.5 lc rgb '#222222'", "noise floor") + ", ";
  }
  return gnuplot(
      script +
      fmt::format("$d using 3:1:($4-$3):(0) with vectors nohead lw 2 lc rgb '{1}' notitle, "
                  "$d using 3:1:ytic(6) with points pt 7 ps 1.1 lc rgb '{0}' title 'given model', "
                  "$d using 4:1 with points pt 7 ps 0.8 lc rgb '{1}' title 'found'\n",
                  orange, blue));
}

namespace {

/// The samples of a stretch, and -1 where a line must not go on: between them lie others, or a gap
/// of the log.
std::vector<Eigen::Index> with_breaks(const DiagnosisRun& run, Eigen::Index from,
                                      Eigen::Index end) {
  constexpr double usual_steps = 3.0;
  const std::vector<double> time = diagnosis::times(run.test, run.after);
  const double longest = time.size() > 1 ? usual_steps * diagnosis::usual_step(time) : 0.0;
  std::vector<Eigen::Index> places;
  for (Eigen::Index i = from; i < end; ++i) {
    if (i > from && sample_at(run, i).time - sample_at(run, i - 1).time > longest) {
      places.push_back(-1);
    }
    places.push_back(i);
  }
  return places;
}

/// Whether any of these is: gnuplot draws no panel of which it knows no point.
bool any_counted(const diagnosis::Series& series, Eigen::Index row,
                 const std::vector<Eigen::Index>& places) {
  return std::ranges::any_of(places,
                             [&](Eigen::Index i) { return i >= 0 && series.counted(row, i); });
}

/// What is in no error is not drawn as one.
double counted_residual(const diagnosis::Series& series, Eigen::Index row, Eigen::Index i) {
  return series.counted(row, i) ? series.residual(row, i)
                                : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

std::string torque_picture(const DiagnosisRun& run, const Robot& robot, int joint) {
  const Eigen::Index row = robot.base_dof() + joint;
  constexpr double shown = 6.0;  // s
  constexpr int height = 380;
  const auto [from, end] = liveliest(run, joint, shown);
  const double start = sample_at(run, 0).time;
  const std::vector<Eigen::Index> places = with_breaks(run, from, end);
  if (!any_counted(run.after, row, places)) return {};
  std::string script =
      canvas(plot_width, height) + data_rows("d", std::ssize(places), [&](Eigen::Index k) {
        const Eigen::Index i = places[static_cast<std::size_t>(k)];
        std::array<double, 6> values;
        values.fill(std::numeric_limits<double>::quiet_NaN());
        if (i < 0) return values;
        const double tau = run.after.predicted(row, i) - run.after.residual(row, i);
        values = {sample_at(run, i).time - start,       tau,
                  run.before.predicted(row, i),         run.after.predicted(row, i),
                  counted_residual(run.before, row, i), counted_residual(run.after, row, i)};
        return values;
      });
  const std::string unit = unit_at(robot.joint(joint), "N m");
  script += fmt::format(
      "set multiplot layout 2,1 margins {5} spacing 0.05\nset format x ''\n"
      "set ylabel '{4} ({3})'\n"
      "plot $d using 1:2 with lines lw 2 lc rgb '{0}' title 'logged', $d using 1:3 with lines lc "
      "rgb '{1}' title 'given model', $d using 1:4 with lines lc rgb '{2}' title 'found'\n"
      "unset key\nset format x '%g'\nset xlabel 'time (s)'\nset ylabel 'residual ({3})'\n"
      "plot $d using 1:5 with lines lc rgb '{1}', $d using 1:6 with lines lc rgb '{2}'\n"
      "unset multiplot\n",
      grey, orange, blue, unit, unit == "N" ? "force" : "torque",
      margins_with_labels(height, 32.0));
  return gnuplot(script);
}

std::string scatter_picture(const DiagnosisRun& run, const Robot& robot, int joint) {
  const Eigen::Index row = robot.base_dof() + joint;
  constexpr Eigen::Index most = 400;  // points a panel: more hide each other
  const Eigen::Index stride = std::max<Eigen::Index>(1, run.after.residual.cols() / most);
  const Eigen::Index count = run.after.residual.cols() / stride;
  std::vector<Eigen::Index> places;
  for (Eigen::Index i = 0; i < count; ++i) places.push_back(i * stride);
  if (!any_counted(run.after, row, places)) return {};
  const double start = sample_at(run, 0).time;
  constexpr int height = 250, panels = 4;
  constexpr double between = 28.0;  // pixels
  constexpr double panel =
      (plot_width - pixels_left - pixels_right - (panels - 1) * between) / panels;
  std::array<std::vector<double>, panels> over;
  for (Eigen::Index i = 0; i < count; ++i) {
    const Sample& s = sample_at(run, i * stride);
    over[0].push_back(s.dq[joint]);
    over[1].push_back(s.q[joint]);
    over[2].push_back(run.after.predicted(row, i * stride));
    over[3].push_back(s.time - start);
  }
  std::string script =
      canvas(plot_width, height) + "unset key\n" + data_rows("d", count, [&](Eigen::Index i) {
        const auto k = static_cast<std::size_t>(i);
        return std::array{over[0][k],
                          over[1][k],
                          over[2][k],
                          over[3][k],
                          counted_residual(run.before, row, i * stride),
                          counted_residual(run.after, row, i * stride)};
      });
  const auto here = [&](const char* unit) { return unit_at(robot.joint(joint), unit); };
  script += fmt::format(
      "set multiplot layout 1,{} margins {} spacing {:.4f}\nset ylabel 'residual ({})'\n", panels,
      margins_with_labels(height, 14.0), between / plot_width, here("N m"));
  const std::array<std::string, panels> labels = {
      "velocity (" + here("rad/s") + ")", "position (" + here("rad") + ")",
      (here("N m") == "N" ? "predicted force (" : "predicted torque (") + here("N m") + ")",
      "time (s)"};
  for (std::size_t k = 0; k < labels.size(); ++k) {
    script += fmt::format(
        "{}set xlabel '{}'\n"
        "plot $d using {}:5 with points pt 7 ps 0.18 lc rgb '{}', $d using {}:6 with points pt 7 "
        "ps 0.22 lc rgb '{}'\nunset ylabel\nset format y ''\n",
        x_axis(Span::around(over[k]), panel), labels[k], k + 1, orange, k + 1, blue);
  }
  return gnuplot(script + "unset multiplot\n");
}

std::string autocorrelation_picture(const DiagnosisRun& run, const Robot& robot) {
  const int columns = std::min(4, robot.joint_count());
  const int rows = (robot.joint_count() + columns - 1) / columns;
  constexpr int lags = 40;
  constexpr double beside = 70.0;  // pixels, of a panel's labels
  std::string script = canvas(plot_width, 40 + 170 * rows) +
                       "unset key\nset yrange [-0.6:1]\nset ytics 0.4\nset xlabel 'lag (s)'\n" +
                       fmt::format("set multiplot layout {},{}\n", rows, columns);
  for (int j = 0; j < robot.joint_count(); ++j) {
    const Eigen::Index row = robot.base_dof() + j;
    const auto before = diagnosis::autocorrelation(run.test, run.before, row, lags);
    const auto after = diagnosis::autocorrelation(run.test, run.after, row, lags);
    script += data_rows("d", std::ssize(after.value), [&](Eigen::Index i) {
      const auto k = static_cast<std::size_t>(i);
      return std::array{static_cast<double>(i) * after.step, before.value[k], after.value[k]};
    });
    const double last = after.step * static_cast<double>(after.value.size() - 1);
    script += fmt::format(
        "{}set title {}\nplot {} with filledcurves y1={} fs solid 0.2 noborder lc rgb '#444444', "
        "$d using 1:2 with lines lc rgb '{}', $d using 1:3 with lines lw 1.5 lc rgb '{}'\n",
        x_axis({0.0, last > 0.0 ? last : 1.0}, static_cast<double>(plot_width) / columns - beside),
        gnuplot_string(robot.joint(j).name), after.band, -after.band, orange, blue);
  }
  return gnuplot(script + "unset multiplot\n");
}

}  // namespace shapeid::app
