#include "shapeid/tests/bench/problems/body.hpp"

#include <algorithm>
#include <numeric>

#include "shapeid/models/shapes_yaml.hpp"
#include "shapeid/reference/window.hpp"
#include "shapeid/tests/bench/problems/windows.hpp"
#include "shapeid/tests/support/load_problem.hpp"

namespace shapeid::bench {
namespace {

constexpr std::size_t body_window_samples = 1000;

/// The smallest cuboid along the link's axes that holds its shapes.
Shape bounding_cuboid(const std::vector<SoughtShape>& shapes) {
  Eigen::AlignedBox3d box;
  for (const SoughtShape& s : shapes) {
    const auto [lower, upper] = bounds(s.shape);
    box.extend(lower).extend(upper);
  }
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = box.center();
  return make_cuboid(box.sizes(), pose);
}

std::vector<Shape> halved(const Shape& whole, int count) {
  std::vector<Shape> parts = {whole};
  while (std::ssize(parts) < count) {
    const auto largest =
        std::max_element(parts.begin(), parts.end(),
                         [](const Shape& a, const Shape& b) { return volume(a) < volume(b); });
    const auto [first, second] = divide(*largest);
    *largest = first;
    parts.push_back(second);
  }
  return parts;
}

/// The file's inertias, each link's scaled by a factor of its own.
Eigen::VectorXd some_bodies(std::uint64_t seed) {
  test::Draw draw(seed);
  Eigen::VectorXd Phi = stacked_parameters(quadruped());
  for (Eigen::Index link = 0; link < quadruped().link_count(); ++link)
    Phi.segment<10>(10 * link) *= draw.between(0.7, 1.3);
  return Phi;
}

}  // namespace

BodyModel body_cuboids(int count) {
  BodyModel model;
  model.known = Eigen::VectorXd::Zero(10 * quadruped().link_count());
  model.free_links.resize(static_cast<std::size_t>(quadruped().link_count()));
  std::iota(model.free_links.begin(), model.free_links.end(), 0);
  for (const int link : model.free_links) {
    const Shape whole = bounding_cuboid(default_shapes(quadruped(), {link}).shapes);
    for (const Shape& part : halved(whole, count))
      model.shapes.push_back({link, part, std::to_string(model.shapes.size())});
  }
  return model;
}

std::vector<DenseProblem> body_windows(const BodyModel& model, SeedSet seeds, test::Noise noise,
                                       Density density, int sequences, int windows) {
  std::vector<DenseProblem> all;
  for (int k = 0; k < sequences; ++k) {
    const std::uint64_t seed = seed_of(seeds, static_cast<std::uint64_t>(k));
    const std::size_t count =
        body_window_samples + window_samples * static_cast<std::size_t>(windows - 1);
    const std::vector<Sample> samples =
        test::trot(quadruped(), some_bodies(seed), seed, count, noise);
    for (int w = 0; w < windows; ++w) {
      reference::Window window(quadruped(), model, ContactTreatment::project,
                               Eigen::VectorXd::Ones(quadruped().dof()));
      const std::size_t from = window_samples * static_cast<std::size_t>(w);
      for (std::size_t i = from; i < from + body_window_samples; ++i) window.add(samples[i]);
      all.push_back(compressed(window.problem(model), model, density));
      all.back().follows = w > 0;
    }
  }
  return all;
}

}  // namespace shapeid::bench
