// What self_test changes: something of every kind that the sources hold, and a
// program that says what all of it gives, so that every change shows. main() is not changed.
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <vector>

namespace {

constexpr double left_alone = 2.0 * 3.0;

double arithmetic(double a, double b) {
  constexpr std::array halves = {1.0, 0.5};  // no switch at run time fits in here
  return a * b - a / b + std::sin(a) - halves.back();
}

int count(const std::vector<int>& list, int least) {
  int n = 0;
  for (int i = 0; i < static_cast<int>(list.size()); ++i) {
    if (list[static_cast<std::size_t>(i)] <= least || list.empty()) continue;
    n += list[static_cast<std::size_t>(i)];
  }
  return n;
}

bool in_order(const std::vector<int>& list, bool strictly) {
  int last = -1;
  for (const int x : list) {
    if (last > x) return false;
    if (strictly && last == x) return false;
    last = x;
  }
  return true;
}

Eigen::Vector3d moved(const Eigen::Matrix3d& turn, const Eigen::Vector3d& by, bool back) {
  const Eigen::Vector3d turned = turn * by + by;
  Eigen::Vector3d w = -turned;
  if (back)
    w -= by;
  else
    w += 2.0 * by;
  w(0) = turn(0, 2) + std::max(by.x(), by.y());
  if (!back) w.y() = std::abs(w.y());
  return w - by;
}

double checked(double x) {
  if (x < 0.0) throw std::invalid_argument("a text with 1 number");
  return std::sqrt(x);
}

double refused(double x) {
  try {
    return checked(x);
  } catch (const std::invalid_argument&) {
    return -1.0;
  }
}

}  // namespace

int main() {
  std::printf("%.17g %.17g\n", arithmetic(1.5, 0.7), left_alone);
  std::printf("%d %d %d\n", count({3, 1, 2, 5}, 2), count({}, 0), count({-4, 7}, -5));
  for (const bool strictly : {false, true}) {
    std::printf("%d%d%d%d ", in_order({1, 2, 3}, strictly), in_order({1, 1, 2}, strictly),
                in_order({2, 3, 1}, strictly), in_order({-1}, strictly));
  }
  Eigen::Matrix3d turn;
  turn << 1, 2, 3, 4, 5, 6, 7, 8, 10;
  for (const bool back : {false, true}) {
    const Eigen::Vector3d w = moved(turn, {0.3, -0.2, 0.5}, back);
    std::printf("%.17g %.17g %.17g\n", w.x(), w.y(), w.z());
  }
  std::printf("%.17g %.17g %.17g\n", refused(0.0), refused(2.0), refused(-2.0));
}
