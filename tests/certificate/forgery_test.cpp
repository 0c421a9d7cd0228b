// Files that were tampered with: every single field, one after the other.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "shapeid/models/error.hpp"
#include "shapeid/models/strict_json.hpp"
#include "shapeid/reference/mass_solver.hpp"
#include "shapeid/tests/certificate/problems.hpp"
#include "shapeid/tests/certificate/verdict.hpp"
#include "shapeid/tests/support/load_problem.hpp"

namespace shapeid::certificate {
namespace {

using nlohmann::json;
using test::Files;

struct Honest {
  StatedProblem problem;
  Answer answer;
  Files files;
};

/// A small problem with everything in it: other columns, regions, a floor.
Honest honest(bool others) {
  test::Draw draw(5);
  Honest h;
  h.problem.masses = test::load_window(
      draw, 3, test::cuboid_body(1.0, {0.1, -0.02, 0.05}, {0.04, 0.05, 0.06}), 0.01);
  MassProblem& p = h.problem.masses;
  test::fill_with_cuboids(p, {-0.2, -0.1, 0.0}, {0.2, 0.1, 0.1}, {3, 2, 1});
  p.lambda = default_lambda(p, 1.0);
  h.problem.regions = {
      {0, make_cuboid({0.4, 0.2, 0.1}, Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.0, 0.05)))}};
  for (int cell = 0; cell < 6; ++cell) {
    const double side = 0.4 / 3.0;
    const Eigen::Vector3d centre(-0.2 + (cell % 3 + 0.5) * side, cell < 3 ? -0.05 : 0.05, 0.05);
    h.problem.shapes.push_back(
        {0, make_cuboid({side, 0.1, 0.1}, Eigen::Isometry3d(Eigen::Translation3d(centre)))});
  }
  const Eigen::VectorXd m = reference::solve_masses(p).m;
  Eigen::VectorXd x;
  if (others) {
    // A column that the residual does not feel: its best x is zero, between its bounds.
    Eigen::VectorXd column(p.F.size());
    for (double& c : column) c = draw.sign();
    const Eigen::VectorXd r = p.W.cwiseProduct(p.Y * (p.U * m) - p.F);
    column -= r * (column.dot(r) / r.squaredNorm());
    h.problem.others = {column, Eigen::VectorXd::Constant(1, -1.0),
                        Eigen::VectorXd::Constant(1, 2.0)};
    x = Eigen::VectorXd::Zero(1);
  }
  h.answer = test::honest_answer(h.problem, m, x);
  h.files = test::honest_files(h.problem, h.answer, true);
  return h;
}

/// The smallest change there is.
json nudged(const json& leaf) {
  if (leaf.is_boolean()) return !leaf.get<bool>();
  if (leaf.is_string()) return leaf.get<std::string>() + "0";
  if (leaf.is_number()) return std::nextafter(leaf.get<double>(), HUGE_VAL);
  return 1.0;  // null, or an empty list
}

/// A change of one part in a thousand, of what is zero but for rounding by a thousandth.
json shaken(const json& leaf) {
  constexpr double rounding = 1e-12;
  if (!leaf.is_number()) return nudged(leaf);
  const double x = leaf.get<double>();
  return std::abs(x) < rounding ? 1e-3 : 1.001 * x;
}

/// Calls `judge(where, text)` for the document with each leaf changed, then with each member taken
/// away.
template <class Change, class Judge>
void for_every_forgery(const std::string& text, Change change, Judge judge) {
  const json document = json::parse(text);
  const json leaves = document.flatten();
  for (const auto& [path, leaf] : leaves.items()) {
    const json::json_pointer place(path);
    json forged = document;
    forged[place] = change(leaf);
    judge(path, forged.dump());
    json shorter = document;
    if (shorter[place.parent_pointer()].is_array()) {
      shorter[place.parent_pointer()].erase(std::stoul(place.back()));
    } else {
      shorter[place.parent_pointer()].erase(place.back());
    }
    judge(path + " taken away", shorter.dump());
  }
}

TEST(Forgery, EveryFieldOfEveryFileCounts) {
  for (const bool others : {false, true}) {
    const Files good = honest(others).files;
    ASSERT_TRUE(test::accepted(good));
    int tried = 0;
    const auto refused = [&](const std::string& what, const Files& files) {
      ++tried;
      EXPECT_FALSE(test::accepted(files)) << what;
    };
    for_every_forgery(good.problem, nudged, [&](const std::string& where, const std::string& text) {
      refused("problem " + where, {text, good.answer, good.certificate});
      refused("problem without certificate " + where, {text, good.answer, ""});
    });
    for_every_forgery(good.answer, nudged, [&](const std::string& where, const std::string& text) {
      refused("answer " + where, {good.problem, text, good.certificate});
    });
    for_every_forgery(good.certificate, nudged,
                      [&](const std::string& where, const std::string& text) {
                        refused("certificate " + where, {good.problem, good.answer, text});
                      });
    EXPECT_GT(tried, 1000);
  }
}

/// Without a certificate rounding is forgiven; a part in a thousand is not.
TEST(Forgery, EveryFieldOfAnAnswerAloneCounts) {
  const Files good = honest(true).files;
  ASSERT_TRUE(test::accepted({good.problem, good.answer, ""}));
  for_every_forgery(good.answer, shaken, [&](const std::string& where, const std::string& text) {
    EXPECT_FALSE(test::accepted({good.problem, text, ""})) << where;
  });
}

/// Whether an answer or a claim is refused for what was computed, not for what a file is called.
bool refused_by_mathematics(const Files& files) {
  const std::vector<std::string> reasons = test::refusals(files);
  return std::any_of(reasons.begin(), reasons.end(), [](const std::string& reason) {
    return reason.find("digest") == std::string::npos;
  });
}

/// A forger who names the right digests meets the mathematics. It feels every number of the rows
/// and shapes; a bound that holds nothing back, and a place in a region that is not the lowest, it
/// need not feel.
TEST(Forgery, DigestsMadeGoodDoNotHelp) {
  const std::set<std::string> felt = {"Y", "F", "W", "lambda", "U", "V", "shapes"};
  std::map<std::string, int> judged = {{"mass_bound", 0}, {"regions", 0}, {"columns", 0}};
  for (const std::string& member : felt) judged[member] = 0;
  for (const bool others : {false, true}) {
    const Honest h = honest(others);
    for_every_forgery(
        h.files.problem, shaken, [&](const std::string& where, const std::string& text) {
          const std::string member = where.substr(1, where.find('/', 1) - 1);
          if (!judged.contains(member) || where.find("taken") != std::string::npos) return;
          StatedProblem forged;
          try {
            forged = stated_problem_from_json(text, "problem.json");
          } catch (const InputError&) {
            return;  // a kind of shape that there is not, half a link
          }
          Answer answer = h.answer;
          answer.problem_digest = problem_digest(forged);
          json certificate = json::parse(h.files.certificate);
          certificate["claim"]["problem_digest"] = answer.problem_digest;
          certificate["claim"]["answer_digest"] = digest(answer_to_json(answer));
          const bool refused =
              refused_by_mathematics({text, answer_to_json(answer), certificate.dump()});
          EXPECT_TRUE(refused || !felt.contains(member)) << where;
          if (refused) ++judged[member];
        });
  }
  for (const auto& [member, count] : judged) {
    EXPECT_GT(count, 0) << member << ": no forgery was refused by the mathematics";
  }
}

TEST(Forgery, DuplicateKeysAreRefused) {
  const Files good = honest(false).files;
  for (std::string Files::*const file : {&Files::problem, &Files::answer, &Files::certificate}) {
    Files forged = good;
    std::string& text = forged.*file;
    const std::string format = json::parse(text)["format"].dump();
    text.insert(text.find('{') + 1, "\"format\":" + format + ",");
    EXPECT_FALSE(test::accepted(forged));
  }
}

}  // namespace
}  // namespace shapeid::certificate
