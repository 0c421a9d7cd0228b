// The answer for links far from the root: every number stands at the link that it is of, in
// result.json, in the table and in identified.urdf.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "shapeid/models/problem_json.hpp"
#include "shapeid/models/urdf.hpp"
#include "shapeid/tests/app/arms.hpp"
#include "shapeid/tests/app/command.hpp"
#include "shapeid/tests/app/farthest.hpp"
#include "shapeid/tests/support/files.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid::test {
namespace {

using nlohmann::json;

// None is carried by another one of them: neighbours could hide each other's mass.
const std::vector<int> sought = {1, 5, 6, 9, 12};
const std::string free_links = "--free l9 l12 l1 l6 l5";

/// Ten numbers of a link; one that is not known is infinite.
Vector10 ten(const json& link, const std::string& key) {
  Vector10 values;
  for (std::size_t p = 0; p < 10; ++p) {
    const json& number = link.at(key).at(p);
    values[static_cast<Eigen::Index>(p)] =
        number.is_null() ? std::numeric_limits<double>::infinity() : number.get<double>();
  }
  return values;
}

class LinksAnswer : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    std::vector<BoxMasses> given = masses_of_arms();
    for (const int link : sought) {
      given[at(link)][0] *= 1.5 - 0.02 * link;
      given[at(link)][1] *= 0.6 + 0.03 * link;
    }
    scratch_file("arms.urdf", arms_urdf(given));
    write_arms_log("exact", masses_of_arms(), {});
  }

  /// What is printed; result.json and more are in found/.
  static std::string identify(const std::string& options) {
    const CommandRun run = shapeid(
        "identify --robot arms.urdf --exact --lambda 0 --divisions 0 --out found " + options);
    EXPECT_EQ(run.status, 0) << run.err;
    return run.out;
  }
  static json result() { return json::parse(text_of(scratch() + "/found/result.json")); }
  static json links(const std::string& options) {
    identify(options);
    json links = result().at("links");
    EXPECT_EQ(links.size(), sought.size());
    return links;
  }
};

MassProblem rows_found() {
  return problem_from_json(text_of(scratch() + "/found/problem.json"), "problem.json");
}

// kg, kg m, kg m^2: what an answer may be off by and still tell every link from every other one.
constexpr double far_below_any_difference = 1e-6;

TEST_F(LinksAnswer, HasTheTruthOfEveryLink) {
  const json links = LinksAnswer::links("--log exact.csv " + free_links);
  const MassProblem rows = rows_found();
  Eigen::VectorXd masses(rows.shapes());
  Eigen::Index next = 0;
  const std::vector<BoxMasses> arms = masses_of_arms();
  for (const int link : sought) {
    for (const double mass : arms[at(link)]) masses[next++] = mass;
  }
  ASSERT_EQ(next, masses.size());
  const double error =
      farthest(rows.Y * rows.U, rows.F, masses, result().at("objective").at("data"));
  for (std::size_t k = 0; k < sought.size(); ++k) {
    const int link = sought[k];
    EXPECT_EQ(links[k].at("name"), fmt::format("l{}", link));
    const Vector10 truth = arm_link(link, masses_of_arms()[at(link)]).values;
    const double allowed = rows.U.middleRows<10>(static_cast<Eigen::Index>(10 * k)).norm() * error;
    EXPECT_LE((ten(links[k], "parameters") - truth).norm(), allowed) << link;
    EXPECT_LT(allowed, far_below_any_difference);
  }
}

/// An arm's first link turns about the z axis alone, which is level: its weight shows by m rx and
/// m ry, its inertia by Izz. All of a link further on is shown.
TEST_F(LinksAnswer, HasWhatTheDataSayByThemselves) {
  const json links = LinksAnswer::links("--log exact.csv " + free_links);
  EXPECT_TRUE(result().at("slower_cutoff").is_null()) << "nothing is filtered";
  std::vector<Eigen::Index> columns;
  std::vector<double> values, truths;
  for (std::size_t k = 0; k < sought.size(); ++k) {
    EXPECT_TRUE(links[k].at("move_behind_slower_filter").is_null());
    const Vector10 value = ten(links[k], "data_value"),
                   error = ten(links[k], "data_standard_error");
    for (std::size_t p = 0; p < 10; ++p) {
      const bool shows = sought[k] > 2 || p == 1 || p == 2 || p == 9;
      EXPECT_EQ(links[k].at("determined")[p], shows) << sought[k] << " " << p;
      const auto i = static_cast<Eigen::Index>(p);
      EXPECT_EQ(std::isfinite(value[i]), shows);
      EXPECT_EQ(std::isfinite(error[i]), shows);
      if (!shows) continue;
      columns.push_back(static_cast<Eigen::Index>(10 * k) + i);
      values.push_back(value[i]);
      truths.push_back(arm_link(sought[k], masses_of_arms()[at(sought[k])]).values[i]);
    }
  }
  ASSERT_EQ(columns.size(), 43U);
  const Eigen::Map<const Eigen::VectorXd> found(values.data(), 43), truth(truths.data(), 43);
  const MassProblem rows = rows_found();
  const Eigen::MatrixXd Y = rows.Y(Eigen::all, columns);
  // Least squares leave no more than the truth does.
  const double allowed = farthest(Y, rows.F, truth, (Y * truth - rows.F).squaredNorm());
  EXPECT_LE((found - truth).norm(), allowed);
  EXPECT_LT(allowed, far_below_any_difference);
}

TEST_F(LinksAnswer, IsWrittenWhereItBelongs) {
  const json links = LinksAnswer::links("--log exact.csv " + free_links);
  const Robot given = read_arms(scratch() + "/arms.urdf");
  const Robot written = read_arms(scratch() + "/found/identified.urdf");
  ASSERT_EQ(written.links.size(), at(links_of_arms));
  std::size_t next = 0;
  for (int link = 0; link < links_of_arms; ++link) {
    const Vector10& before = given.links[at(link)].inertia.values;
    const Vector10& after = written.links[at(link)].inertia.values;
    if (next == sought.size() || sought[next] != link) {
      EXPECT_EQ(after, before) << link;
      continue;
    }
    EXPECT_EQ(ten(links[next], "given"), before) << link;
    // Written about the centre of mass, read back about the origin.
    EXPECT_LT(scaled_difference(after, ten(links[next], "parameters"), 10), few_hundred_eps);
    ++next;
  }
  EXPECT_EQ(next, sought.size());
}

/// Where torque of even joints alone is noisy, errors are those of even links alone: the arms share
/// nothing but the table. What the odd ones have is rounding, to whatever the motion magnifies it.
TEST_F(LinksAnswer, HasTheErrorsOfTheArmThatIsNoisy) {
  write_arms_log("noisy", masses_of_arms(), {.odd = 0.0, .even = 0.1});
  const json links = LinksAnswer::links("--log noisy.csv " + free_links);
  for (const char* key : {"standard_error", "data_standard_error"}) {
    double odd = 0.0, even = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < sought.size(); ++k) {
      const Vector10 errors = ten(links[k], key);
      if (sought[k] % 2 == 0) {
        even = std::min(even, errors.minCoeff());
        continue;
      }
      for (const double error : errors) {
        if (std::isfinite(error)) odd = std::max(odd, error);
      }
    }
    constexpr double magnified_rounding = 1e-6;  // beside the least error that noise makes
    EXPECT_LT(odd, magnified_rounding * even) << key;
  }
}

/// About the centre of every link a box of another size, so that one mass is all that is sought.
std::string one_box_each() {
  std::string text;
  for (const int link : sought) {
    const Eigen::Vector3d place = arm_link(link, masses_of_arms()[at(link)]).centre_of_mass();
    text +=
        fmt::format("l{}: [{{kind: cuboid, size: [{}, 0.1, 0.07], pose: {{xyz: [{}, {}, {}]}}}}]\n",
                    link, 0.05 + 0.01 * link, place.x(), place.y(), place.z());
  }
  return text;
}

/// Phi = m u of a link: its ten errors are to each other as its ten parameters are.
TEST_F(LinksAnswer, HasErrorsInTheProportionOfTheirLink) {
  scratch_file("one_box.yaml", one_box_each());
  write_arms_log("noisy", masses_of_arms(), {.odd = 0.02, .even = 0.05});
  for (const json& link : LinksAnswer::links("--log noisy.csv --shapes one_box.yaml")) {
    const Vector10 Phi = ten(link, "parameters"), errors = ten(link, "standard_error");
    ASSERT_GT(errors[0], 0.0);
    EXPECT_LT(scaled((errors - errors[0] / Phi[0] * Phi.cwiseAbs()).norm(), Phi.norm(), 10),
              few_hundred_eps);
  }
}

/// A row of a link's table, column by column.
struct Row {
  std::string name, given, found, error, data_error, unit, by;
};

std::string cut(const std::string& line, std::size_t from, std::size_t length) {
  const std::string cell = line.substr(from, length);
  const std::size_t first = cell.find_first_not_of(' ');
  if (first == std::string::npos) return "";
  return cell.substr(first, cell.find_last_not_of(' ') - first + 1);
}

std::map<std::string, std::vector<Row>> tables(const std::string& text) {
  std::map<std::string, std::vector<Row>> tables;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("link ")) continue;
    std::vector<Row>& rows = tables[line.substr(5)];
    std::getline(lines, line);  // the head
    while (rows.size() < 10 && std::getline(lines, line) && line.size() > 68) {
      rows.push_back({cut(line, 2, 6), cut(line, 8, 12), cut(line, 20, 12), cut(line, 32, 12),
                      cut(line, 44, 14), cut(line, 60, 7), cut(line, 68, std::string::npos)});
    }
  }
  return tables;
}

std::string shown(double x) { return std::isfinite(x) ? fmt::format("{:.3g}", x) : "none"; }

/// The numbers of the table are those of result.json, and so is what they come from.
TEST_F(LinksAnswer, IsTheSameInWords) {
  constexpr std::array<std::array<const char*, 2>, 10> names = {{{"m", "kg"},
                                                                 {"m rx", "kg m"},
                                                                 {"m ry", "kg m"},
                                                                 {"m rz", "kg m"},
                                                                 {"Ixx", "kg m^2"},
                                                                 {"Ixy", "kg m^2"},
                                                                 {"Ixz", "kg m^2"},
                                                                 {"Iyy", "kg m^2"},
                                                                 {"Iyz", "kg m^2"},
                                                                 {"Izz", "kg m^2"}}};
  scratch_file("one_box.yaml", one_box_each());
  write_arms_log("noisy", masses_of_arms(), {.odd = 0.02, .even = 0.05});
  const auto tables = test::tables(identify("--log noisy.csv --shapes one_box.yaml"));
  ASSERT_EQ(tables.size(), sought.size());
  std::map<std::string, int> seen;
  const json document = result();
  for (const json& link : document.at("links")) {
    const std::vector<Row>& rows = tables.at(link.at("name"));
    ASSERT_EQ(rows.size(), 10U);
    for (std::size_t p = 0; p < 10; ++p) {
      const auto number = [&](const char* key) {
        return ten(link, key)[static_cast<Eigen::Index>(p)];
      };
      const Row& row = rows[p];
      EXPECT_EQ(row.name, names[p][0]);
      EXPECT_EQ(row.unit, names[p][1]);
      EXPECT_EQ(row.given, fmt::format("{:.5g}", number("given")));
      EXPECT_EQ(row.found, fmt::format("{:.5g}", number("parameters")));
      EXPECT_EQ(row.error, shown(number("standard_error")));
      EXPECT_EQ(row.data_error, shown(number("data_standard_error")));
      const std::string by = link.at("determined_by")[p];
      const bool is_impossible = by == "shapes, the data impossible";
      EXPECT_EQ(row.by, is_impossible ? fmt::format("{}: {:.5g}", by, number("data_value")) : by);
      EXPECT_EQ(is_impossible || by == "shapes and bounds", !link.at("determined")[p]);
      if (link.at("determined")[p]) {
        EXPECT_EQ(by == "shapes, against the data", link.at("against_data")[p]);
        const double share = number("standard_error") / number("data_standard_error");
        if (!link.at("against_data")[p]) {
          EXPECT_EQ(by, share * share < 0.5 ? "shapes, the data agree" : "data");
        }
      }
      ++seen[by];
    }
  }
  for (const char* by :
       {"data", "shapes, the data agree", "shapes, against the data", "shapes and bounds"}) {
    EXPECT_GT(seen[by], 0) << by;
  }
}

}  // namespace
}  // namespace shapeid::test
