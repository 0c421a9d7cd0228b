#include "shapeid/tests/bench/report/goals.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace shapeid::bench {
namespace {

const std::vector<std::string> qpoases = {"qpoases"};
const std::vector<std::string> lawson_hanson = {"lawson_hanson"};

/// The same work is what starts from the same input: "/triangle". Beside it the harder comparison
/// in which peers are handed A or H for nothing: "/solve".
struct Input {
  std::string suffix, name;
};
const std::vector<Input> inputs = {{"/triangle", ""}, {"/solve", ", A or H given to the peer"}};

void add_solve(std::vector<Goal>& goals, const std::string& work, const std::string& row,
               const std::string& ours, const std::vector<std::string>& who, double factor) {
  for (const Input& input : inputs) {
    goals.push_back({work + input.name, row + "/" + ours + input.suffix, who.front(), factor,
                     row + "/", who, input.suffix, "bench_solve --benchmark_filter=" + row + "/",
                     ours == "fast"});
  }
}

std::vector<Goal> make_goals() {
  std::vector<Goal> goals;
  for (const auto& [suffix, noise] :
       {std::pair("", "noisy"), std::pair("_noisefree", "noise-free")}) {
    const std::string base11 = std::string("base11") + suffix, base54 = "base54" + base11.substr(6);
    const std::string work11 = fmt::format("base link, 11 shapes, {}", noise);
    add_solve(goals, work11 + ", cold", base11, "fast", lawson_hanson, 3.0);
    add_solve(goals, work11 + ", warm", base11, "fast/warm", lawson_hanson, 4.0);
    add_solve(goals, work11 + ", cold", base11, "fast", qpoases, 20.0);
    add_solve(goals, work11 + ", warm", base11, "fast/warm", qpoases, 20.0);
    const std::string work54 = fmt::format("base link, 54 points, {}", noise);
    for (const auto& [start, ours] : {std::pair("cold", "fast"), std::pair("warm", "fast/warm")}) {
      add_solve(goals, work54 + ", " + start, base54, ours, lawson_hanson, 7.0);
      add_solve(goals, work54 + ", " + start, base54, ours, qpoases, 100.0);
    }
  }

  struct DivisionGoal {
    int shapes;
    double lawson_hanson, qpoases;
  };
  for (const DivisionGoal& goal : {DivisionGoal{7, 3.0, 8.0},
                                   {11, 5.0, 14.0},
                                   {30, 12.0, 30.0},
                                   {100, 35.0, 110.0},
                                   {300, 100.0, 900.0}}) {
    for (const auto& [suffix, name] :
         {std::pair("", ""), std::pair("_ours", ", each shape that is divided has mass in ours")}) {
      const std::string row = fmt::format("division{}{}", goal.shapes, suffix);
      const std::string work = fmt::format("division run to {} shapes{}", goal.shapes, name);
      const std::string command = fmt::format("bench_division --benchmark_filter={}/", row);
      goals.push_back({work, row + "/fast/warm/solve", "lawson_hanson", goal.lawson_hanson,
                       row + "/", lawson_hanson, "/solve", command});
      goals.push_back({work, row + "/fast/warm/solve", "qpoases, warm", goal.qpoases, row + "/",
                       qpoases, "/warm/solve", command});
    }
  }

  for (const auto& [shapes, factor] :
       {std::pair(52, 1.5), std::pair(104, 2.0), std::pair(208, 4.0), std::pair(650, 7.0)}) {
    const std::string row = fmt::format("body{}", shapes);
    for (const Input& input : inputs) {
      goals.push_back({fmt::format("whole body, {} shapes{}", shapes, input.name),
                       row + "/fast/warm" + input.suffix,
                       "any peer, warm or cold",
                       factor,
                       row + "/",
                       {},
                       input.suffix,
                       fmt::format("bench_body --benchmark_filter={}/", row)});
    }
  }

  const std::string window = "bench_window";
  goals.push_back({"ten samples in, masses out",
                   "window11/fast",
                   "the published stack",
                   5.0,
                   "window11/",
                   {"published"},
                   "",
                   window});
  goals.push_back({"ten samples in, masses out",
                   "window11/fast",
                   "the best mix of others' parts",
                   2.5,
                   "window11/",
                   {"best_mix"},
                   "",
                   window});
  goals.push_back({"full 18 x 130 regressor of a sample",
                   "regressor_full/fast",
                   "Pinocchio's computeJointTorqueRegressor",
                   1.0,
                   "regressor_full/",
                   {"pinocchio"},
                   "",
                   "bench_regressor"});
  goals.push_back({"base columns of the regressor alone",
                   "regressor_base/fast",
                   "Pinocchio's computeJointTorqueRegressor",
                   20.0,
                   "regressor_full/",
                   {"pinocchio"},
                   "",
                   "bench_regressor"});
  return goals;
}

bool counts(const Goal& goal, const Result& result) {
  const std::string solver = result.name.substr(goal.prefix.size());
  const bool warm =
      solver.find("/warm/") != std::string::npos || solver.find("/hotstart/") != std::string::npos;
  if (goal.cold && warm) return false;
  if (!goal.who.empty())
    return std::ranges::any_of(goal.who, [&](const auto& w) { return solver.starts_with(w); });
  return !solver.starts_with("fast") && !solver.starts_with("reference");
}

}  // namespace

const std::vector<Goal>& goals() {
  static const std::vector<Goal> all = make_goals();
  return all;
}

const Result* opponent(const Goal& goal, const Results& results) {
  std::vector<const Result*> peers = results.between(goal.prefix, goal.suffix);
  std::erase_if(peers, [&goal](const Result* r) { return !counts(goal, *r); });
  if (peers.empty()) return nullptr;
  const auto errors = [](const Result* r) { return r->counter("failures") + r->counter("wrong"); };
  return *std::ranges::min_element(peers, [&errors](const Result* a, const Result* b) {
    return std::pair(errors(a), a->median()) < std::pair(errors(b), b->median());
  });
}

}  // namespace shapeid::bench
