#include "shapeid/tests/experiments/page/plot.hpp"

#include <fmt/format.h>

namespace shapeid::experiments {

std::string plot(const std::vector<Panel>& panels) {
  std::string data, script = fmt::format("set multiplot layout {},1\n", panels.size());
  script += "set grid\nset lmargin 12\nset key outside right\nset format y '%g'\n";
  int block = 0;
  for (const Panel& panel : panels) {
    script += fmt::format("set xlabel '{}'\nset ylabel '{}'\n{}", panel.x, panel.y, panel.settings);
    std::string command = "plot";
    for (const Curve& curve : panel.curves) {
      data += fmt::format("$curve{} << EOD\n", ++block);
      for (const auto& [x, y] : curve.points) data += fmt::format("{:.5g} {:.5g}\n", x, y);
      data += "EOD\n";
      command += fmt::format("{} $curve{} with lines lw 1.5 title '{}'",
                             &curve == &panel.curves.front() ? "" : ",", block, curve.title);
    }
    script += command + "\n";
  }
  return data + script + "unset multiplot\n";
}

int picture_height(const std::string& script) {
  constexpr int of_panel = 190, margin = 30;
  const std::string panel = "\nplot ";
  int panels = 0;
  for (std::size_t at = 0; (at = script.find(panel, at)) != std::string::npos; ++at) ++panels;
  return margin + of_panel * panels;
}

}  // namespace shapeid::experiments
