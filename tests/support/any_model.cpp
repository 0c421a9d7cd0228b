#include "shapeid/tests/support/any_model.hpp"

#include <string>
#include <vector>

#include "shapeid/tests/support/generators.hpp"
#include "shapeid/tests/support/load_problem.hpp"

namespace shapeid::test {
namespace {

struct DrawnShape {
  int kind = 0;
  bool second_link = false;
  Eigen::Vector3d size = Eigen::Vector3d::Ones();
  Eigen::Isometry3d placement = Eigen::Isometry3d::Identity();
};

rc::Gen<DrawnShape> drawn_shape() {
  const auto side = real(0.02, 0.3);
  return rc::gen::map(
      rc::gen::tuple(rc::gen::inRange(0, 5), rc::gen::arbitrary<bool>(),
                     rc::gen::tuple(side, side, side), pose(0.3)),
      [](const auto& t) {
        const auto& [x, y, z] = std::get<2>(t);
        return DrawnShape{std::get<0>(t), std::get<1>(t), {x, y, z}, std::get<3>(t)};
      });
}

Shape made(const DrawnShape& drawn) {
  const Eigen::Vector3d& s = drawn.size;
  switch (drawn.kind) {
    case 0:
      return make_cuboid(s, drawn.placement);
    case 1:
      return make_cylinder(0.5 * s.x(), s.z(), drawn.placement);
    case 2:
      return make_ellipsoid(0.5 * s, drawn.placement);
    case 3:  // a tetrahedron without symmetry
      return make_convex_hull(
          {{s.x(), 0.01, 0.0}, {0.0, s.y(), 0.02}, {0.03, 0.0, s.z()}, {-0.02, -0.01, -0.03}},
          drawn.placement);
    default:
      return make_point(drawn.placement.translation(), s.prod());
  }
}

ModelWithRows assemble(const std::vector<DrawnShape>& shapes, std::uint64_t seed, int samples,
                       double noise, double mass) {
  ModelWithRows result;
  BodyModel& model = result.model;
  for (const DrawnShape& drawn : shapes) {
    model.shapes.push_back(
        {drawn.second_link ? 2 : 0, made(drawn), std::to_string(model.shapes.size())});
  }
  for (const int link : {0, 2}) {
    for (const SoughtShape& s : model.shapes) {
      if (s.link != link) continue;
      model.free_links.push_back(link);
      break;
    }
  }
  model.known = Eigen::VectorXd::Zero(30);

  const auto links = static_cast<Eigen::Index>(model.free_links.size());
  Draw draw(seed);
  MassProblem& p = result.problem;
  const Eigen::Index rows_of_link = Eigen::Index{6} * samples;
  p.Y = Eigen::MatrixXd::Zero(rows_of_link * links, 10 * links);
  p.F.resize(p.Y.rows());
  p.W.resize(p.Y.rows());
  for (Eigen::Index i = 0; i < links; ++i) {
    const auto hidden = cuboid_body(mass, draw.vector(0.3), {0.05, 0.08, 0.12});
    const MassProblem rows = load_window(draw, samples, hidden, noise);
    p.Y.block(rows_of_link * i, 10 * i, rows_of_link, 10) = rows.Y;
    p.F.segment(rows_of_link * i, rows_of_link) = rows.F;
    p.W.segment(rows_of_link * i, rows_of_link) = rows.W;
  }
  result.expected_mass = mass * static_cast<double>(links);
  use_shapes(p, model, result.expected_mass);
  return result;
}

}  // namespace

rc::Gen<ModelWithRows> model_with_rows() {
  const auto shapes = rc::gen::mapcat(rc::gen::inRange(1, 7), [](int count) {
    return rc::gen::container<std::vector<DrawnShape>>(static_cast<std::size_t>(count),
                                                       drawn_shape());
  });
  return rc::gen::resize(
      rc::kNominalSize,
      rc::gen::map(rc::gen::tuple(shapes, rc::gen::arbitrary<std::uint64_t>(),
                                  rc::gen::inRange(1, 20), real(0.0, 0.1), magnitude(0.1, 10.0)),
                   [](const auto& t) { return std::apply(assemble, t); }));
}

BodyModel one_cuboid(const Eigen::Vector3d& centre, const Eigen::Vector3d& sides) {
  BodyModel model;
  model.known = Eigen::VectorXd::Zero(10);
  model.free_links = {0};
  model.shapes = {{0, make_cuboid(sides, Eigen::Isometry3d(Eigen::Translation3d(centre))), "0"}};
  return model;
}

void use_shapes(MassProblem& problem, const BodyModel& model, double expected_mass) {
  problem.U = shape_columns(model);
  problem.V = shape_volumes(model);
  problem.lambda = default_lambda(problem, expected_mass);
  problem.mass_bound = 10.0 * expected_mass;
}

}  // namespace shapeid::test
