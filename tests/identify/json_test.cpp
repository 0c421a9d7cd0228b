#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "shapeid/models/error.hpp"
#include "shapeid/models/problem_json.hpp"
#include "shapeid/models/strict_json.hpp"
#include "shapeid/tests/support/load_problem.hpp"

namespace shapeid {
namespace {

MassProblem some_problem() {
  test::Draw draw(17);
  MassProblem p = test::load_window(
      draw, 3, test::cuboid_body(1.0, {0.1, -0.02, 0.05}, {0.04, 0.05, 0.06}), 0.01);
  test::fill_with_cuboids(p, {-0.2, -0.1, 0.0}, {0.2, 0.1, 0.1}, {3, 2, 1});
  p.lambda = 1.0 / 3.0;
  p.mass_bound = 12.5;
  p.F[0] = 5e-324;  // the smallest double
  return p;
}

TEST(ProblemJson, ReadsBackBitForBit) {
  const MassProblem p = some_problem();
  const MassProblem q = problem_from_json(problem_to_json(p), "p.json");
  EXPECT_EQ(p.Y, q.Y);
  EXPECT_EQ(p.F, q.F);
  EXPECT_EQ(p.W, q.W);
  EXPECT_EQ(p.U, q.U);
  EXPECT_EQ(p.V, q.V);
  EXPECT_EQ(p.lambda, q.lambda);
  EXPECT_EQ(p.mass_bound, q.mass_bound);
  EXPECT_EQ(problem_digest(p), problem_digest(q));
}

/// Everything that a problem may have.
StatedProblem whole_problem() {
  StatedProblem p{some_problem(), {}, {}};
  const Eigen::Index rows = p.masses.F.size();
  p.others = {Eigen::MatrixXd::Constant(rows, 2, 0.3), Eigen::Vector2d(0.0, -HUGE_VAL),
              Eigen::Vector2d(HUGE_VAL, 1.0 / 3.0)};
  const Eigen::Isometry3d pose(Eigen::Translation3d(0.1, -0.2, 0.3) *
                               Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()));
  p.regions = {{0, make_cuboid({0.1, 0.2, 0.3}, pose)},
               {0, make_cylinder(0.1, 0.2, pose)},
               {0, make_ellipsoid({0.1, 0.2, 0.3}, pose)},
               {0, make_convex_hull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, pose)},
               {0, make_point({1, 2, 3}, 1e-6)}};
  p.shapes.assign(6, p.regions.front());
  return p;
}

using Numbers = std::vector<double*>;

template <class Matrix>
void append_entries(Numbers& numbers, Matrix& M) {
  for (double& entry : M.reshaped()) numbers.push_back(&entry);
}

template <class Body>
void append_solid(Numbers& numbers, Body& body) {
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index k = 0; k < 4; ++k) numbers.push_back(&body.frame(i, k));
  }
  append_entries(numbers, body.cell.lower);
  append_entries(numbers, body.cell.upper);
}

void append_solid(Numbers& numbers, Polyhedron& body) {
  for (Eigen::Vector3d& vertex : body.vertices) append_entries(numbers, vertex);
}

void append_solid(Numbers& numbers, Point& point) {
  append_entries(numbers, point.position);
  numbers.push_back(&point.nominal_volume);
}

/// Every double of a problem.
Numbers numbers_of(StatedProblem& p) {
  Numbers numbers = {&p.masses.lambda, &p.masses.mass_bound};
  append_entries(numbers, p.masses.Y);
  append_entries(numbers, p.masses.U);
  append_entries(numbers, p.others.values);
  for (Eigen::VectorXd* v :
       {&p.masses.F, &p.masses.W, &p.masses.V, &p.others.lower, &p.others.upper}) {
    append_entries(numbers, *v);
  }
  for (std::vector<Region>* list : {&p.regions, &p.shapes}) {
    for (Region& region : *list) {
      std::visit([&](auto& body) { append_solid(numbers, body); }, region.shape);
    }
  }
  return numbers;
}

/// By one bit each; and no two of the changes look the same.
TEST(ProblemJson, DigestSeesEveryNumber) {
  StatedProblem p = whole_problem();
  std::set<std::string> digests = {problem_digest(p)};
  const Numbers numbers = numbers_of(p);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const double before = std::exchange(*numbers[i], std::nextafter(*numbers[i], HUGE_VAL));
    if (before == HUGE_VAL) *numbers[i] = 1.0;
    EXPECT_TRUE(digests.insert(problem_digest(p)).second) << "number " << i;
    *numbers[i] = before;
  }
  for (std::vector<Region>* list : {&p.regions, &p.shapes}) {
    for (Region& region : *list) {
      ++region.link;
      EXPECT_TRUE(digests.insert(problem_digest(p)).second) << "a link";
      --region.link;
    }
  }
  EXPECT_TRUE(digests.contains(problem_digest(p)));
}

/// The texts and hashes that its authors publish.
TEST(Digest, IsFnv1a) {
  EXPECT_EQ(digest(""), "cbf29ce484222325");
  EXPECT_EQ(digest("a"), "af63dc4c8601ec8c");
  EXPECT_EQ(digest("foobar"), "85944171f73967e8");
}

TEST(AnswerJson, ReadsBack) {
  const Answer a{"0123456789abcdef", Eigen::Vector3d(0.1, 0.0, 2.0 / 3.0),
                 Eigen::VectorXd::LinSpaced(10, -1.0, 1.0 / 7.0), 1.0 / 3.0};
  const Answer b = answer_from_json(answer_to_json(a), "a.json");
  EXPECT_EQ(a.problem_digest, b.problem_digest);
  EXPECT_EQ(a.masses, b.masses);
  EXPECT_EQ(a.parameters, b.parameters);
  EXPECT_EQ(a.objective, b.objective);
}

TEST(AnswerJson, MassesMayBeLeftOut) {
  const Answer a{"0", {}, Eigen::VectorXd::Ones(10), 0.0};
  EXPECT_EQ(answer_from_json(answer_to_json(a), "a.json").masses.size(), 0);
}

/// An empty list is not the same as none: it has another size than any problem's masses.
TEST(AnswerJson, NoMassesAreNoList) {
  const std::string text =
      R"({"format":"shapeid-answer-1","problem_digest":"0","masses":[],"parameters":[1.0],)"
      R"("objective":0.0})";
  EXPECT_THROW(answer_from_json(text, "a.json"), InputError);
}

/// Rows of nothing are as many as there are rows, or none.
TEST(ProblemJson, EmptyColumnsHaveTheRowsOfTheProblem) {
  const auto with = [](const std::string& values) {
    return R"({"format":"shapeid-problem-1","free_links":0,"Y":[[],[]],"F":[1.0,2.0],"W":[1.0,2.0],)"
           R"("U":[],"V":[],"lambda":0.25,"mass_bound":3.0,"columns":{"values":)" +
           values + R"(,"lower":[],"upper":[]}})";
  };
  for (const char* values : {"[]", "[[],[]]"}) {
    EXPECT_NO_THROW(stated_problem_from_json(with(values), "p.json")) << values;
  }
  for (const char* values : {"[[]]", "[[],[],[]]"}) {
    EXPECT_THROW(stated_problem_from_json(with(values), "p.json"), InputError) << values;
  }
}

/// from_chars reads a sign behind the prefix, where none may be.
TEST(ProblemJson, ASignStandsBeforeTheNumber) {
  const auto with = [](const std::string& lambda) {
    return R"({"format":"shapeid-problem-1","free_links":0,"Y":[[]],"F":[1.0],"W":[1.0],"U":[],)"
           R"("V":[],"lambda":")" +
           lambda + R"(","mass_bound":3.0})";
  };
  EXPECT_EQ(problem_from_json(with("0x1p-2"), "p.json").lambda, 0.25);
  for (const char* lambda : {"0x-1p-2", "-0x-1p-2", "0x+1p-2", "0x", "0x0x1p0"}) {
    EXPECT_THROW(problem_from_json(with(lambda), "p.json"), InputError) << lambda;
  }
}

TEST(ProblemJson, HexadecimalNumbersAreExact) {
  const std::string text =
      R"({"format":"shapeid-problem-1","free_links":0,"Y":[[],[]],"F":["-0x1.8p-3","0x1p4"],)"
      R"("W":[1.0,2.0],"U":[],"V":[],"lambda":0.25,"mass_bound":3.0})";
  const MassProblem p = problem_from_json(text, "p.json");
  EXPECT_EQ(p.F[0], -0.1875);
  EXPECT_EQ(p.F[1], 16.0);
}

TEST(ProblemJson, ColumnsAndRegionsReadBack) {
  StatedProblem p{some_problem(), {}, {}};
  const Eigen::Index rows = p.masses.F.size();
  p.others = {Eigen::MatrixXd::Random(rows, 2), Eigen::Vector2d(0.0, -HUGE_VAL),
              Eigen::Vector2d(HUGE_VAL, 1.0 / 3.0)};
  const Eigen::Isometry3d pose(Eigen::Translation3d(0.1, -0.2, 0.3) *
                               Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()));
  p.regions = {{0, make_cuboid({0.1, 0.2, 0.3}, pose)},
               {0, divide(make_cylinder(0.1, 0.2, pose)).second},
               {0, make_ellipsoid({0.1, 0.2, 0.3}, pose)},
               {0, make_convex_hull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, pose)},
               {0, make_point({1, 2, 3}, 1e-6)}};
  const std::string text = problem_to_json(p);
  const StatedProblem q = stated_problem_from_json(text, "p.json");
  EXPECT_EQ(text, problem_to_json(q));
  EXPECT_EQ(p.others.values, q.others.values);
  EXPECT_EQ(p.others.lower, q.others.lower);
  EXPECT_EQ(p.others.upper, q.others.upper);
  ASSERT_EQ(q.regions.size(), 5U);
  for (std::size_t i = 0; i < q.regions.size(); ++i) {
    EXPECT_EQ(unit_parameters(p.regions[i].shape).values,
              unit_parameters(q.regions[i].shape).values);
  }
  EXPECT_THROW((void)problem_from_json(text, "p.json"), InputError);
}

struct Broken {
  std::string find, replace, says;
};

TEST(ProblemJson, SaysWhichShapeIsWrong) {
  const std::string good = R"({"kind":"point","link":0,"position":[0,0,0],"nominal_volume":1})";
  const auto says = [&](const std::string& second) {
    const std::string text =
        R"({"format":"shapeid-problem-1","free_links":1,"Y":[],"F":[],"W":[],"U":[[],[],[],[],[],)"
        R"([],[],[],[],[]],"V":[],"lambda":0,"mass_bound":0,"regions":[)" +
        good + "," + second + "]}";
    try {
      (void)stated_problem_from_json(text, "p.json");
    } catch (const InputError& e) {
      return std::string(e.what());
    }
    return std::string("accepted");
  };
  EXPECT_EQ(says(good), "accepted");
  EXPECT_EQ(says("1"), "p.json, regions[1]: not an object; a shape");
  EXPECT_EQ(says(R"({"kind":"ball"})"),
            "p.json, regions[1], key kind: unknown kind of shape 'ball'; cuboid, cylinder, "
            "ellipsoid, polyhedron or point");
  EXPECT_EQ(says(R"({"kind":"point","link":0,"position":[0,0,0],"nominal_volume":-1})")
                .find("p.json, regions[1]: "),
            0U);
  EXPECT_EQ(says(R"({"kind":"point","link":1,"position":[0,0,0],"nominal_volume":1})"),
            "p.json: region 1 is on free link 1, there are 1, counted from 0; see "
            "docs/formats/problem.md");
}

TEST(ProblemJson, SaysWhatIsWrongWithBrokenFiles) {
  const std::string good =
      R"({"format":"shapeid-problem-1","free_links":0,"Y":[[],[]],"F":[1.5,2.5],"W":[1.0,2.0],)"
      R"("U":[],"V":[],"lambda":0.25,"mass_bound":3.0})";
  ASSERT_NO_THROW((void)problem_from_json(good, "p.json"));
  const std::vector<Broken> table = {
      {"}", "", "p.json: is not JSON (at byte 130); see docs/formats/problem.md"},
      {"shapeid-problem-1", "shapeid-problem-9",
       "p.json: has no or another format; \"format\" must be \"shapeid-problem-1\""},
      {"\"lambda\":0.25,", "", "p.json, key lambda: missing key; it is required"},
      {"\"lambda\"", "\"lambda2\"",
       "p.json, key lambda2: unknown key; see docs/formats/problem.md"},
      {"0.25", "\"x\"", "p.json, key lambda: not a finite number; write finite decimals"},
      {"0.25", "1e999", "p.json: a number is larger than any double; write finite decimals"},
      {"0.25", "-0.25",
       "p.json: lambda is -0.25, must be finite and >= 0; see docs/formats/problem.md"},
      {"[1.0,2.0]", "[1.0]", "p.json: rows disagree: Y 2, F 2, W 1; see docs/formats/problem.md"},
      {"[1.0,2.0]", "[1.0,-2.0]",
       "p.json: weight 1 is -2, not positive; see docs/formats/problem.md"},
      {"[1.5,2.5]", "[1.5,null]",
       "p.json, key F: entry 1 is not a finite number; write finite decimals"},
      {"[[],[]]", "[[],[1]]", "p.json, key Y: row 1 has 1 numbers; every row has 0"},
      {"[[],[]]", "3", "p.json, key Y: not a list; a list of rows"},
      {"[[],[]]", "[[],3]", "p.json, key Y: row 1 is not a list; a list of numbers"},
      {"\"free_links\":0", "\"free_links\":-1",
       "p.json, key free_links: not a count; a whole number from 0 to 10000"},
      {"\"free_links\":0", "\"free_links\":1e300",
       "p.json, key free_links: not a count; a whole number from 0 to 10000"},
      {"\"lambda\":0.25,", "\"lambda\":0.25,\"lambda\":0.25,",
       "p.json, key lambda: the key is there twice; once"},
      {"0.25", "\"0x1p\"", "p.json, key lambda: not a finite number; write finite decimals"},
      {"3.0", "-3.0",
       "p.json: the mass bound is negative or not finite; see docs/formats/problem.md"},
  };
  for (const Broken& b : table) {
    std::string text = good;
    text.replace(text.find(b.find), b.find.size(), b.replace);
    try {
      (void)problem_from_json(text, "p.json");
      ADD_FAILURE() << "accepted: " << text;
    } catch (const InputError& e) {
      EXPECT_EQ(std::string(e.what()), b.says);
    }
  }
}

}  // namespace
}  // namespace shapeid
