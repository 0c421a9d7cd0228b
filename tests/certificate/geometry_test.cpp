// Columns of U against the shapes that they are said to be, and shapes against the regions.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "shapeid/proofs/certificate/certify.hpp"
#include "shapeid/proofs/certificate/exact_moments.hpp"
#include "shapeid/proofs/certificate/geometry.hpp"
#include "shapeid/reference/mass_solver.hpp"
#include "shapeid/tests/certificate/problems.hpp"
#include "shapeid/tests/support/generators.hpp"
#include "shapeid/tests/support/shape_generators.hpp"

namespace shapeid::certificate {
namespace {

using std::numbers::pi;

const Rational rounding = exact(1e-9);

/// One column a shape, all on the second of two links; `region` is where they may lie.
StatedProblem of_shapes(const std::vector<Shape>& shapes, const Shape& region) {
  StatedProblem p;
  const auto n = static_cast<Eigen::Index>(shapes.size());
  p.masses.U = Eigen::MatrixXd::Zero(20, n);
  p.masses.V.resize(n);
  for (const Shape& shape : shapes) {
    const auto j = static_cast<Eigen::Index>(p.shapes.size());
    p.masses.U.col(j).tail<10>() = unit_parameters(shape).values;
    p.masses.V[j] = volume(shape);
    p.shapes.push_back({1, shape});
  }
  p.regions = {{1, region}};
  return p;
}

/// Sines and cosines of doubles lie in their enclosures, and those are narrow.
RC_GTEST_PROP(Enclosure, HoldsSineAndCosine, ()) {
  const double angle = (*test::vector(1, 16.0))[0];
  const auto at = sine_and_cosine(exact(angle));
  RC_ASSERT(at.has_value());
  const Rational ulp = exact(std::ldexp(1.0, -52));  // the library's own error is below one
  for (const auto& [enclosure, value] :
       {std::pair(at->sine, std::sin(angle)), std::pair(at->cosine, std::cos(angle))}) {
    RC_ASSERT(distance(exact(value), enclosure) <= ulp);
    RC_ASSERT(enclosure.upper - enclosure.lower <= exact(std::ldexp(1.0, -120)));
  }
  const Enclosure one = at->sine * at->sine + at->cosine * at->cosine;
  RC_ASSERT(one.lower <= 1 && 1 <= one.upper);
}

TEST(Enclosure, EndsWhereCellsDo) {
  EXPECT_FALSE(sine_and_cosine(exact(17.0)));
  EXPECT_TRUE(sine_and_cosine(exact(-16.0)));
}

/// models/ and the exact integrals share nothing: shapes of all kinds, cells and slivers.
RC_GTEST_PROP(Geometry, ColumnsOfAllKindsAgree, ()) {
  const Shape shape = *test::solid();
  const Geometry found = check_geometry(of_shapes({shape}, shape), rounding);
  RC_ASSERT(found.first_disagreement.empty());
  RC_ASSERT(found.declared == 1 && found.agree == 1 && found.inside == 1);
}

/// A part in a million of any entry or of the volume is seen.
RC_GTEST_PROP(Geometry, EveryEntryCounts, ()) {
  const Shape shape = *test::solid();
  StatedProblem p = of_shapes({shape}, shape);
  const auto i = *rc::gen::inRange<Eigen::Index>(0, 21);
  if (i == 20) {
    p.masses.V[0] *= 1.0 + 1e-6;
  } else {
    // Relative to what the entry is measured by: one, a distance, its square.
    const InertialParameters unit = unit_parameters(shape);
    const double square = 0.5 * unit.tensor().trace();
    const Eigen::Index k = i % 10;
    p.masses.U(i, 0) += 1e-6 * (k == 0 ? 1.0 : (k < 4 ? std::sqrt(square) : square));
  }
  const Geometry found = check_geometry(p, rounding);
  RC_ASSERT(found.agree == 0 && !found.first_disagreement.empty());
}

/// One, the distance from the link's origin, and its square: near it and far from it.
TEST(Geometry, EntriesAreMeasuredByTheirUnits) {
  for (const double distance : {0.03125, 32.0}) {
    const Shape shape =
        make_cuboid(distance * Eigen::Vector3d(0.5, 0.25, 0.125),
                    Eigen::Isometry3d(Eigen::Translation3d(distance * Eigen::Vector3d(1, -1, 1))));
    const double square = 0.5 * unit_parameters(shape).tensor().trace();
    for (Eigen::Index i = 0; i < 10; ++i) {
      const double measure = i == 0 ? 1.0 : (i < 4 ? std::sqrt(square) : square);
      for (const auto& [share, agrees] : {std::pair(0.5, 1), std::pair(2.0, 0)}) {
        for (const double sign : {-1.0, 1.0}) {
          StatedProblem p = of_shapes({shape}, shape);
          p.masses.U(10 + i, 0) += sign * share * rounding.get_d() * measure;
          const Geometry found = check_geometry(p, rounding);
          EXPECT_EQ(found.agree, agrees) << distance << " " << i;
          const std::string name = parameter_names[static_cast<std::size_t>(i)];
          EXPECT_EQ(found.first_disagreement.starts_with(name + " of column 0 of U is said"),
                    agrees == 0)
              << found.first_disagreement;
        }
      }
    }
  }
}

/// Of a point all numbers are exact, and what is off by exactly as much as is allowed agrees.
TEST(Geometry, AsMuchAsIsAllowedAgrees) {
  const Shape point = make_point({3.0, 4.0, 0.0}, 0.5);
  constexpr double allowed = 0x1p-20, distance = 5.0;
  for (Eigen::Index i = 0; i < 10; ++i) {
    const double measure = i == 0 ? 1.0 : (i < 4 ? distance : distance * distance);
    StatedProblem p = of_shapes({point}, point);
    p.masses.U(10 + i, 0) += allowed * measure;
    EXPECT_EQ(check_geometry(p, exact(allowed)).agree, 1) << i;
    EXPECT_EQ(check_geometry(p, exact(std::nextafter(allowed, 0.0))).agree, 0) << i;
  }
  StatedProblem p = of_shapes({point}, point);
  p.masses.V[0] *= 1.0 + allowed;
  EXPECT_EQ(check_geometry(p, exact(allowed)).agree, 1);
  EXPECT_EQ(check_geometry(p, exact(std::nextafter(allowed, 0.0))).agree, 0);
}

/// A mesh that is not convex holds itself, and nothing else is shown of it.
TEST(Geometry, AMeshHoldsItself) {
  Polyhedron star = std::get<Polyhedron>(
      make_convex_hull({{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
                       Eigen::Isometry3d::Identity()));
  star.convex = false;
  Polyhedron other = star;
  std::swap(other.sides[0], other.sides[1]);
  EXPECT_EQ(check_geometry(of_shapes({star}, star), rounding).inside, 1);
  EXPECT_EQ(check_geometry(of_shapes({star}, other), rounding).inside, 0);
  other = star;
  for (Eigen::Vector3d& vertex : other.vertices) vertex *= 2.0;
  EXPECT_EQ(check_geometry(of_shapes({star}, other), rounding).inside, 0);
}

/// All parts of a division lie where the whole lies; none of them in a neighbour.
RC_GTEST_PROP(Geometry, PartsLieInTheirRegion, ()) {
  const Shape whole = *test::solid();
  RC_PRE(divisible(whole));
  const auto [first, second] = divide(whole);
  RC_PRE(divisible(second));
  const auto [third, fourth] = divide(second);
  RC_ASSERT(check_geometry(of_shapes({first, third, fourth}, whole), rounding).inside == 3);
  RC_ASSERT(check_geometry(of_shapes({whole, second}, first), rounding).inside == 0);
}

TEST(Geometry, CornersDecideInOtherKindsOfRegions) {
  const auto at = [](double x) { return Eigen::Isometry3d(Eigen::Translation3d(x, 0.0, 0.0)); };
  const auto inside = [](const Shape& part, const Shape& region) {
    return check_geometry(of_shapes({part}, region), rounding).inside == 1;
  };
  const Shape cube = make_cuboid({0.1, 0.1, 0.1}, at(0.0));
  const double corner = 0.05 * std::sqrt(3.0), edge = 0.05 * std::sqrt(2.0);
  EXPECT_TRUE(inside(cube, make_ellipsoid({corner, corner, corner}, at(0.0))));
  EXPECT_FALSE(inside(cube, make_ellipsoid({corner, corner, 0.99 * corner}, at(0.0))));
  EXPECT_TRUE(inside(cube, make_cylinder(edge, 0.1, at(0.0))));
  EXPECT_FALSE(inside(cube, make_cylinder(0.999 * edge, 0.1, at(0.0))));
  EXPECT_FALSE(inside(cube, make_cylinder(edge, 0.0999, at(0.0))));
  EXPECT_TRUE(inside(cube, make_cuboid({0.12, 0.1, 0.1}, at(0.01))));
  EXPECT_FALSE(inside(cube, make_cuboid({0.12, 0.1, 0.1}, at(0.011))));
  const Shape hull =
      make_convex_hull({{0.2, 0.0, 0.0},
                        {-0.2, 0.0, 0.0},
                        {0.0, 0.2, 0.0},
                        {0.0, -0.2, 0.0},
                        {0.0, 0.0, 0.2},
                        {0.0, 0.0, -0.2}},
                       at(0.0));  // |x| + |y| + |z| <= 0.2, and the cube's corners have 0.15
  EXPECT_TRUE(inside(cube, hull));
  EXPECT_TRUE(inside(make_point({0.1, 0.05, 0.05}, 1e-6), hull));
  EXPECT_FALSE(inside(make_point({0.1, 0.05, 0.0501}, 1e-6), hull));
  // A ball in a cuboid is not shown to be inside, although it is.
  EXPECT_FALSE(inside(make_ellipsoid({0.01, 0.01, 0.01}, at(0.0)), cube));
}

/// A turned region off the link's origin holds what lies in it, and not what lies in its image.
TEST(Geometry, RegionsLieWhereTheirFramesAre) {
  const Eigen::Vector3d centre(0.3, -0.2, 0.1);
  Eigen::Isometry3d frame(Eigen::Translation3d{centre});
  frame.rotate(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1.0, 2.0, -1.0).normalized()));
  const Eigen::Vector3d off = frame.linear() * Eigen::Vector3d(0.045, 0.0, 0.02);
  for (const Shape& region :
       {make_cuboid({0.1, 0.02, 0.06}, frame), make_cylinder(0.05, 0.06, frame),
        make_ellipsoid({0.06, 0.01, 0.05}, frame)}) {
    const auto holds = [&](const Eigen::Vector3d& x) {
      return check_geometry(of_shapes({make_point(x, 1e-6)}, region), rounding).inside == 1;
    };
    EXPECT_TRUE(holds(centre + off));
    EXPECT_FALSE(holds(-centre + off));
    EXPECT_FALSE(holds(centre + 1.5 * off));
  }
}

/// A frame whose rows depend on each other, though no double says so, is flat: it holds what lies
/// in its plane, and not a point beside it that elimination would put into its cell.
TEST(Geometry, AFlatRegionHoldsNothingBesideIt) {
  Cuboid flat = std::get<Cuboid>(make_cuboid({1.0, 1.0, 1.0}, Eigen::Isometry3d::Identity()));
  flat.frame.linear() << 0.5037819917777995, 0.7967812714998388, 1.5659885003428258,
      0.4767956243913716, 0.6840827281648956, 0.8108160992746889, 0.980577616169171,
      1.4808639996647344, 2.3768045996175147;  // the third row is the sum of the others
  ASSERT_FALSE(why_malformed(Shape(flat)));
  const auto holds = [&](const Eigen::Vector3d& x) {
    return check_geometry(of_shapes({make_point(x, 1e-6)}, flat), rounding).inside == 1;
  };
  EXPECT_TRUE(holds(Eigen::Vector3d::Zero()));
  EXPECT_FALSE(holds(Eigen::Vector3d(0.0, 0.0, 4096.0)));
}

/// A vertex that no face names is no part of a solid, and does not widen what is forgiven.
TEST(Geometry, AVertexOfNoFaceForgivesNothing) {
  Polyhedron cube = std::get<Polyhedron>(make_convex_hull(
      {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}},
      Eigen::Isometry3d::Identity()));
  const auto holds = [&](double x) {
    const Shape part = make_point({x, 0.5, 0.5}, 1e-6);
    return check_geometry(of_shapes({part}, cube), rounding).inside == 1;
  };
  EXPECT_TRUE(holds(-4e-10));
  EXPECT_FALSE(holds(-4e-5));
  cube.vertices.emplace_back(4e5, 0.5, 0.5);
  EXPECT_TRUE(holds(-4e-10));
  EXPECT_FALSE(holds(-4e-5));
}

/// Another link's region does not count, nor an entry on another link's rows.
TEST(Geometry, LinksAreKeptApart) {
  const Shape cube = make_cuboid({0.1, 0.1, 0.1}, Eigen::Isometry3d::Identity());
  StatedProblem p = of_shapes({cube}, cube);
  p.regions[0].link = 0;
  EXPECT_EQ(check_geometry(p, rounding).inside, 0);
  p.masses.U(3, 0) = 1e-300;
  EXPECT_EQ(check_geometry(p, rounding).agree, 0);
}

/// A writer of problems whose columns are not its shapes is told so, whatever the answer.
TEST(Geometry, AContradictionIsRejected) {
  StatedProblem p = test::load_problem();
  const Eigen::VectorXd m = reference::solve_masses(p.masses).m;
  p.shapes.assign(static_cast<std::size_t>(m.size()), p.regions.front());
  const Certified c = certify(p, test::honest_answer(p, m));
  ASSERT_FALSE(c.reasons.empty());
  EXPECT_NE(c.reasons.back().find("contradicts itself"), std::string::npos);
  EXPECT_EQ(c.proof.columns.agree, 0);
  EXPECT_EQ(c.proof.columns.inside, m.size());
}

/// The quarter of a cylinder, by hand: centre (4 / (3 pi)) R along x and y.
TEST(ExactMoments, OfAQuarterCylinder) {
  Shape quarter = make_cylinder(2.0, 1.0, Eigen::Isometry3d::Identity());
  std::get<Cylinder>(quarter).cell.upper.y() = 0.5 * pi;
  const auto found = exact_moments(quarter);
  ASSERT_TRUE(found);
  const Rational close = exact(1e-15);
  EXPECT_LT(distance(exact(pi), found->volume), close);
  EXPECT_LT(distance(exact(8.0 / (3.0 * pi)), found->parameters[1]), close);
  EXPECT_LT(distance(exact(8.0 / (3.0 * pi)), found->parameters[2]), close);
  EXPECT_LT(distance(exact(2.0), found->parameters[9]), close);  // R^2 / 2
}

/// All numbers dyadic, so that points lie on the surfaces exactly, and no rounding is allowed.
TEST(Geometry, TheSurfaceBelongsToTheRegion) {
  const Rational none = 0;
  const Eigen::Isometry3d pose(Eigen::Translation3d(0.25, -0.5, 2.0));
  const auto moved = [&](double x, double y, double z) {
    return make_point(pose * Eigen::Vector3d(x, y, z), 1e-3);
  };
  const std::vector<Eigen::Vector3d> corners = {{0, 0, 0}, {0.5, 0, 0}, {0, 0.25, 0}, {0, 0, 1}};
  struct Case {
    Shape region, on, outside;
  };
  const double more = std::ldexp(1.0, -40);
  for (const Case& c :
       {Case{make_cuboid({1.0, 0.5, 0.25}, pose), moved(0.5, -0.25, 0.125),
             moved(0.5, -0.25, 0.125 + more)},
        Case{make_cuboid({1.0, 0.5, 0.25}, pose), moved(-0.5, 0.25, -0.125),
             moved(-0.5 - more, 0.25, -0.125)},
        Case{make_ellipsoid({0.5, 0.25, 1.0}, pose), moved(0.0, -0.25, 0.0),
             moved(0.0, -0.25 - more, 0.0)},
        Case{make_cylinder(0.5, 1.0, pose), moved(0.5, 0.0, -0.5), moved(0.5, 0.0, -0.5 - more)},
        Case{make_cylinder(0.5, 1.0, pose), moved(0.0, 0.5, 0.25), moved(0.0, 0.5 + more, 0.25)},
        Case{make_convex_hull(corners, pose), moved(0.25, 0.125, 0.0),
             moved(0.25, 0.125 + more, 0.0)}}) {
    EXPECT_EQ(check_geometry(of_shapes({c.on}, c.region), none).inside, 1) << kind_name(c.region);
    EXPECT_EQ(check_geometry(of_shapes({c.outside}, c.region), none).inside, 0)
        << kind_name(c.region);
    EXPECT_EQ(check_geometry(of_shapes({c.outside}, c.region), rounding).inside, 1)
        << kind_name(c.region);
  }
}

}  // namespace
}  // namespace shapeid::certificate
