#include "shapeid/app/plot_script.hpp"

namespace shapeid::app {

std::string canvas(int width, int height) {
  return fmt::format(
      "set terminal svg size {},{} noenhanced background '#ffffff' font 'sans-serif,12'\n"
      "set grid lc rgb '#dddddd'\nset border lc rgb '#666666'\nset key outside top left "
      "horizontal\n",
      width, height);
}

std::string x_axis(const Span& span, double pixels) {
  return fmt::format("set xrange [{:.9g}:{:.9g}]\nset xtics {:g}\n", span.low, span.high,
                     step_across(span, pixels));
}

}  // namespace shapeid::app
