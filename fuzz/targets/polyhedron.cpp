// Convex solids of any points, cut again and again: volumes and moments add up, parts stay solids.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "shapeid/fuzz/support/bytes.hpp"
#include "shapeid/fuzz/support/check.hpp"
#include "shapeid/models/shape.hpp"
#include "shapeid/tests/support/scaled.hpp"
#include "shapeid/tests/support/shape_generators.hpp"

using namespace shapeid;

namespace {

/// Empty where the points span no solid, or the solid is too thin to be cut: both are refused.
template <typename Make>
auto unless_refused(const Make& make) -> std::optional<decltype(make())> {
  try {
    return make();
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  }
}

std::vector<Eigen::Vector3d> any_points(fuzz::Bytes& bytes) {
  const double size = std::pow(10.0, 3.0 * bytes.unit());  // mm to km
  const bool on_grid = bytes.flag();                       // points that share planes and lines
  std::vector<Eigen::Vector3d> points;
  for (int count = bytes.count(4, 20); count > 0; --count) {
    Eigen::Vector3d p =
        on_grid ? Eigen::Vector3d(bytes.count(-2, 2), bytes.count(-2, 2), bytes.count(-2, 2))
                : bytes.vector(1.0);
    points.push_back(size * p);
  }
  return points;
}

void check_sums(const Shape& whole, const Shape& lower, const Shape& upper) {
  using test::few_hundred_eps, test::scaled;
  const Moments m = moments(whole), a = moments(lower), b = moments(upper);
  const double rounding = test::volume_rounding(whole);
  fuzz::check(
      scaled(std::abs(a.volume + b.volume - m.volume), m.volume * rounding, 2) < few_hundred_eps,
      "volumes add up");
  const Eigen::Vector3d first = (a.volume * a.centroid + b.volume * b.centroid) / m.volume;
  fuzz::check(
      scaled((first - m.centroid).norm(), test::reach(whole) * rounding, 3) < few_hundred_eps,
      "first moments add up");
  for (const Shape* part : {&lower, &upper}) {
    fuzz::check(!why_malformed(*part), "a part is a solid");
    fuzz::check(
        contains(whole, moments(*part).centroid, few_hundred_eps * 2.2e-16 * test::reach(whole)),
        "a part's centroid lies in the whole");
    fuzz::check(unit_parameters(*part).values.allFinite(), "parameters are finite");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Bytes bytes(data, size);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  if (bytes.flag()) {
    pose.linear() = bytes.rotation();
    pose.translation() = bytes.vector(10.0);
  }
  const auto points = any_points(bytes);
  auto whole = unless_refused([&] { return make_convex_hull(points, pose); });
  for (int cuts = bytes.count(1, 12); whole && cuts > 0; --cuts) {
    const bool across_longest = bytes.flag();
    const int axis = bytes.count(0, 2);
    const double fraction = (bytes.byte() + 1) / 257.0;
    const auto parts = unless_refused(
        [&] { return across_longest ? divide(*whole) : divide(*whole, axis, fraction); });
    if (!parts) break;
    check_sums(*whole, parts->first, parts->second);
    whole = bytes.flag() ? parts->first : parts->second;
  }
  return 0;
}
