#include "shapeid/models/signed_axes.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace shapeid {

Eigen::Matrix3d SignedAxes::matrix() const {
  Eigen::Matrix3d M = Eigen::Matrix3d::Zero();
  for (int i = 0; i < 3; ++i) {
    const auto at = static_cast<std::size_t>(i);
    M(i, order.at(at)) = sign.at(at);
  }
  return M;
}

std::string SignedAxes::words() const {
  const auto axis = [&](std::size_t i) {
    return fmt::format("{}{}", sign.at(i) < 0.0 ? "-" : "",
                       "xyz"[static_cast<std::size_t>(order.at(i))]);
  };
  return fmt::format("({}, {}, {})", axis(0), axis(1), axis(2));
}

const std::array<SignedAxes, signed_axes_count>& all_signed_axes() {
  static const auto all = [] {
    std::array<SignedAxes, signed_axes_count> result;
    std::array<int, 3> order = {0, 1, 2};
    SignedAxes* next = result.data();
    do {
      for (const double x : {1.0, -1.0}) {
        for (const double y : {1.0, -1.0}) {
          for (const double z : {1.0, -1.0}) *next++ = {order, {x, y, z}};
        }
      }
    } while (std::next_permutation(order.begin(), order.end()));
    return result;
  }();
  return all;
}

}  // namespace shapeid
