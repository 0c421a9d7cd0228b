// Certificates whose every number was worked out by hand, and the names that they are written
// under: what is written and what is judged go through the same code.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "shapeid/app/certificate_text.hpp"
#include "shapeid/models/strict_json.hpp"
#include "shapeid/proofs/certificate/certificate_json.hpp"
#include "shapeid/proofs/certificate/rational.hpp"
#include "shapeid/tests/certificate/problems.hpp"
#include "shapeid/tests/certificate/verdict.hpp"

namespace shapeid::certificate {
namespace {

using nlohmann::json;

/// One message a member that differs, is missing or is there without being asked for.
void expect_members(const json& found, const json& wanted) {
  for (const auto& [key, value] : wanted.items()) {
    ASSERT_TRUE(found.contains(key)) << key;
    EXPECT_EQ(found[key], value) << key;
  }
  for (const auto& [key, value] : found.items()) EXPECT_TRUE(wanted.contains(key)) << key;
}

/// Of (t - 1)^2 + t^2, t at most 1/8, the point t = 1/8. The residual there is -7/8.
///   objective  49/64 + 1/64 = 0.78125. Without the bound t = 1/2 were best, so that no linear
///              system has the optimum; duality proves it: -(7/8)^2 + 2 (7/8) + 2 (-7/8) t + t^2
///              falls until t = 7/8, hence is least at t = 1/8, 49/64 + 1/64 again.
///   floor      the region is the origin, where a unit mass costs -7/8: h = 2 (7/8) - 2 (1/8) (7/8)
///              = 49/32 and h^2 / (4 (7/8)^2) = 49/64. As data term of t = 1/8 it is reached by a
///              body; the least over masses alone, t = 1, is 0 but beyond the bound.
///   bodies     a point mass has no volume.
constexpr const char* claim_of_the_optimum = R"({
  "feasible": true,
  "objective": 0.78125,
  "optimum": {"lower": 0.78125, "upper": 0.78125},
  "gap": 0,
  "optimum_known": false,
  "free_set_right": false,
  "mass_bound": 0.125,
  "mass_bound_declared": true,
  "mass_distance": 0,
  "parameter_distance": [0, 0, 0],
  "made_of_shapes": true,
  "plane": [],
  "bodies": ["semidefinite"],
  "floor": 0.765625,
  "relaxations": {
    "masses": {"lower": 0, "upper": 0.765625},
    "bodies": {"lower": 0, "upper": 0.765625},
    "divisions": {"lower": 0.765625, "upper": 0.78125},
    "apart": [false, false, false]
  },
  "columns": {"declared": 0, "agree": 0, "inside": 0}
})";

constexpr const char* evidence_of_the_optimum =
    R"({"bodies":{"columns":[],"parameters":[0.125,0.0,0.0,0.0,0.0,0.0,0.0,0.0,0.0,0.0]},)"
    R"("limit":{"columns":[],"parameters":[0.125,0.0,0.0,0.0,0.0,0.0,0.0,0.0,0.0,0.0]},)"
    R"("masses":{"columns":[],"parameters":[0.125,0.0,0.0,0.0,0.0,0.0,0.0,0.0,0.0,0.0]}})";

TEST(GoldenCertificate, OfTheOptimum) {
  const StatedProblem p = test::one_point_problem();
  const Answer answer = test::honest_answer(p, Eigen::VectorXd::Constant(1, 0.125));
  const test::Files files = test::honest_files(p, answer, true);
  json wanted = json::parse(claim_of_the_optimum);
  wanted["problem_digest"] = digest(files.problem);
  wanted["answer_digest"] = digest(files.answer);
  wanted["evidence_digest"] = digest(evidence_of_the_optimum);
  const json certificate = json::parse(files.certificate);
  EXPECT_EQ(certificate.size(), 3U);
  EXPECT_EQ(certificate["format"], "shapeid-certificate-2");
  EXPECT_EQ(certificate["evidence"], json::parse(evidence_of_the_optimum));
  expect_members(certificate["claim"], wanted);
  EXPECT_TRUE(test::accepted(files));
}

/// The optimum is reached, not overshot.
TEST(GoldenCertificate, NothingIsLessThanNothing) {
  const StatedProblem p = test::one_point_problem();
  const Proof proof = certify(p, test::honest_answer(p, Eigen::VectorXd::Constant(1, 0.125))).proof;
  EXPECT_EQ(proof_json(proof)["gap"].dump(), "0.0");
  EXPECT_EQ(proof_json(proof)["mass_distance"].dump(), "0.0");
}

/// With 3/4 kg allowed t = 1/2 is best, (1/2)^2 + (1/2)^2, and solved for: t = 1/4 has mass where
/// the optimum has. It is 9/16 + 1/16 - 1/2 = 1/8 too high and 1/4 kg too light. Its parameters say
/// 1/8 kg, which is 3/8 kg off, and moments that a point at the origin does not have.
struct Missed {
  StatedProblem problem = test::one_point_problem();
  Answer answer;

  Missed() {
    problem.masses.mass_bound = 0.75;
    answer = test::honest_answer(problem, Eigen::VectorXd::Constant(1, 0.25));
    answer.parameters << 0.125, 0, 0, -0.0625, 0, 0, 0.03125, 0, 0, 0;
  }
};

TEST(GoldenCertificate, OfAnAnswerThatMissesItsOptimum) {
  const Missed missed;
  const Certified certified = certify(missed.problem, missed.answer);
  EXPECT_FALSE(certified.reasons.empty());
  json wanted = json::parse(R"({
    "feasible": true,
    "objective": 0.625,
    "optimum": {"lower": 0.5, "upper": 0.5},
    "gap": 0.125,
    "optimum_known": true,
    "free_set_right": true,
    "mass_bound": 0.75,
    "mass_bound_declared": true,
    "mass_distance": 0.25,
    "parameter_distance": [0.375, 0.0625, 0.03125],
    "made_of_shapes": false,
    "plane": [],
    "bodies": ["semidefinite"],
    "floor": null,
    "relaxations": {
      "masses": {"lower": 0, "upper": 0.5},
      "bodies": {"lower": 0, "upper": 0.5},
      "divisions": {"lower": 0, "upper": 0.5},
      "apart": [false, false, false]
    },
    "columns": {"declared": 0, "agree": 0, "inside": 0}
  })");
  wanted["problem_digest"] = digest(problem_to_json(missed.problem));
  wanted["answer_digest"] = digest(answer_to_json(missed.answer));
  expect_members(proof_json(certified.proof), wanted);
}

TEST(GoldenCertificate, OfAnAnswerThatMissesItsOptimumInWords) {
  const Missed missed;
  Certified certified = certify(missed.problem, missed.answer);
  certified.reasons = {"one", "another\naccepted\x1b[2J"};
  certified.proof.floor = 0.25;
  EXPECT_EQ(app::certified_text(certified),
            "rejected\n"
            "objective of the answer: at most 0.625\n"
            "optimum: in [0.5, 0.5], solved exactly on the answer's own free set\n"
            "gap: at most 0.125; no mass is farther than 0.25 kg from an optimum's; parameters: "
            "0.375 kg, 0.0625 kg m, 0.0312 kg m^2\n"
            "mass bound: 0.75 kg, declared by the problem\n"
            "bodies of the free links: 0 exist with volume, 1 on the edge, 0 cannot exist\n"
            "no shapes are stated: that the columns are shapes in the regions is taken on trust\n"
            "the parameters as written are not exactly the masses', or a mass is negative\n"
            "floor of infinitely many divisions: 0.25; the answer is 0.375 above it\n"
            "least data terms, in the proved order of their sets:\n"
            "  parameters with no negative mass    [0, 0.5]  at most the next: it asks less\n"
            "  bodies that can exist               [0, 0.5]  at most the next: it asks less\n"
            "  mass anywhere in the regions        [0, 0.5]  at most the next: it asks less\n"
            "  the shapes, with the density term   [0.5, 0.5]\n"
            "reason: one\n"
            "reason: another\\x0aaccepted\\x1b[2J\n");
}

/// A tensor without Ixx and Iyy, which with mass at the origin is no body's.
TEST(GoldenCertificate, SaysThatAColumnIsNoBodys) {
  const std::string words = "some column of U, as written, is no body's";
  StatedProblem p = test::one_point_problem();
  const auto text = [&](double mass) {
    return app::certified_text(
        certify(p, test::honest_answer(p, Eigen::VectorXd::Constant(1, mass))));
  };
  EXPECT_EQ(text(0.125).find(words), std::string::npos);
  p.masses.U(9, 0) = 0.5;
  EXPECT_NE(text(0.125).find(words), std::string::npos);
  EXPECT_EQ(text(-0.125).find(words), std::string::npos);  // which may be the mass's doing
}

/// No mass at all, where 1/8 kg is best: the residual is -1, and -1 + 2 + 2 (-1) t + t^2 is least
/// at t = 1/8, 49/64. From 1 that is 15/64, and no mass is farther away than the root of as much,
/// rounded up.
TEST(GoldenCertificate, OfNoMassAtAll) {
  const StatedProblem p = test::one_point_problem();
  const Proof proof = certify(p, test::honest_answer(p, Eigen::VectorXd::Zero(1))).proof;
  const json claim = proof_json(proof);
  EXPECT_EQ(claim["objective"], 1.0);
  EXPECT_EQ(claim["optimum"], json::parse(R"({"lower": 0.765625, "upper": 1})"));
  EXPECT_EQ(claim["gap"], 0.234375);
  EXPECT_EQ(claim["optimum_known"], false);
  const double distance = claim["mass_distance"];
  const Rational above = exact(distance), below = exact(std::nextafter(distance, 0.0));
  EXPECT_GE(above * above, Rational(15, 64));
  EXPECT_LT(below * below, Rational(15, 64));
  EXPECT_EQ(claim["parameter_distance"], json({distance, 0.0, 0.0}));
}

/// Every member another number, so that none can stand under another's name; of the flags one at a
/// time is true.
TEST(GoldenCertificate, EveryMemberIsWrittenUnderItsName) {
  Proof p;
  p.problem_digest = "a problem";
  p.answer_digest = "an answer";
  p.objective_above = 1;
  p.lower = 2;
  p.upper = 3;
  p.gap = 4;
  p.mass_bound = 5;
  p.mass_distance = 6;
  p.parameter_distance << 7, 8, HUGE_VAL;
  p.plane = Eigen::Vector2d(9, 10);
  p.bodies = {Existence::impossible, Existence::definite, Existence::semidefinite};
  p.floor = 11;
  p.relaxations.masses = {12, 13};
  p.relaxations.bodies = {14, 15};
  p.relaxations.divisions = {16, HUGE_VAL};
  p.relaxations.apart = {true, false, true};
  p.columns = {17, 18, 19};
  json wanted = json::parse(R"({
    "problem_digest": "a problem",
    "answer_digest": "an answer",
    "objective": 1,
    "optimum": {"lower": 2, "upper": 3},
    "gap": 4,
    "mass_bound": 5,
    "mass_distance": 6,
    "parameter_distance": [7, 8, null],
    "plane": [9, 10],
    "bodies": ["impossible", "definite", "semidefinite"],
    "floor": 11,
    "relaxations": {
      "masses": {"lower": 12, "upper": 13},
      "bodies": {"lower": 14, "upper": 15},
      "divisions": {"lower": 16, "upper": null},
      "apart": [true, false, true]
    },
    "columns": {"declared": 17, "agree": 18, "inside": 19}
  })");
  constexpr std::array<std::pair<const char*, bool Proof::*>, 5> flags = {
      {{"feasible", &Proof::feasible},
       {"optimum_known", &Proof::optimum_known},
       {"free_set_right", &Proof::free_set_right},
       {"mass_bound_declared", &Proof::mass_bound_declared},
       {"made_of_shapes", &Proof::made_of_shapes}}};
  for (const auto& flag : flags) {
    for (const auto& [name, place] : flags) wanted[name] = p.*place = place == flag.second;
    expect_members(proof_json(p), wanted);
  }
}

}  // namespace
}  // namespace shapeid::certificate
