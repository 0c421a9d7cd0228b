// Which links get the inertia that was found, which keep the given one, and what is said of them.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "shapeid/app/result.hpp"
#include "shapeid/models/urdf.hpp"
#include "shapeid/tests/app/arms.hpp"
#include "shapeid/tests/app/command.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid::test {
namespace {

using nlohmann::json;

double mass(int link) {
  const BoxMasses boxes = masses_of_arms()[at(link)];
  return boxes[0] + boxes[1];
}

/// The arms as they are but for one link, every box of which weighs so many times as much.
std::vector<BoxMasses> with_link(int link, double factor) {
  std::vector<BoxMasses> masses = masses_of_arms();
  for (double& box : masses[at(link)]) box *= factor;
  return masses;
}

class KeptLinks : public testing::Test {
 protected:
  static void SetUpTestSuite() { write_arms_log("arms", masses_of_arms(), {}); }

  /// Seeks l5 and l12 in arms that were given so, and reads back what is written.
  static void identify(const std::vector<BoxMasses>& given, const std::string& options) {
    scratch_file("given.urdf", arms_urdf(given));
    const CommandRun run = shapeid(
        "identify --robot given.urdf --free l5 l12 --exact --divisions 0 --json --out kept " +
        options);
    ASSERT_EQ(run.status, 0) << run.err;
    result = json::parse(run.out);
    before = read_arms(scratch() + "/given.urdf");
    after = read_arms(scratch() + "/kept/identified.urdf");
    ASSERT_EQ(after.links.size(), before.links.size());
  }

  static void expect_kept(int link) {
    EXPECT_EQ(after.links[at(link)].inertia.values, before.links[at(link)].inertia.values) << link;
  }
  /// Of this mass, and as the given one else.
  static void expect_light(int link, double kilograms) {
    const Vector10& given = before.links[at(link)].inertia.values;
    EXPECT_LT(
        scaled_difference(after.links[at(link)].inertia.values, kilograms / given[0] * given, 10),
        few_hundred_eps)
        << link;
  }
  static void expect_written(int link) {
    const std::string name = fmt::format("l{}", link);
    for (const json& answer : result.at("links")) {
      if (answer.at("name") != name) continue;
      const auto numbers = answer.at("parameters").get<std::vector<double>>();
      // Written about the centre of mass, read back about the origin.
      EXPECT_LT(scaled_difference(after.links[at(link)].inertia.values,
                                  Eigen::Map<const Vector10>(numbers.data()), 10),
                few_hundred_eps);
      EXPECT_NE(after.links[at(link)].inertia.values, before.links[at(link)].inertia.values);
      return;
    }
    ADD_FAILURE() << name << " is not in the answer";
  }
  /// Notes that speak of a link.
  static std::vector<std::string> notes_of(int link) {
    std::vector<std::string> notes;
    for (const json& note : result.at("notes")) {
      const auto text = note.get<std::string>();
      if (text.find(fmt::format("link l{} ", link)) != std::string::npos) notes.push_back(text);
    }
    return notes;
  }

  static json result;
  static Robot before, after;
};
json KeptLinks::result;
Robot KeptLinks::before, KeptLinks::after;

/// The hand l12 holds nothing, and its forearm l10 weighs less than is given: masses of the hand
/// could only make up for that if they were negative. With the hand as it was given the file would
/// be another model than was found.
TEST_F(KeptLinks, ALinkThatWasLeftWithNothing) {
  std::vector<BoxMasses> truth = with_link(12, 0.0);
  write_arms_log("empty", truth, {});
  std::vector<BoxMasses> given = with_link(10, 1.2);
  identify(given, "--log empty.csv");
  const double little = 1e-3 * mass(12);
  expect_light(12, little);
  expect_written(5);
  EXPECT_EQ(notes_of(12),
            std::vector<std::string>{fmt::format("link l12 is written with {:g} kg, its given "
                                                 "inertia scaled: it was left with 0 kg (limit 0)",
                                                 little)});
  EXPECT_TRUE(notes_of(5).empty());

  const CommandRun seen = shapeid("inspect --json kept/identified.urdf");
  EXPECT_EQ(seen.status, 0) << seen.err;
  EXPECT_TRUE(json::parse(seen.out).at("findings").empty()) << seen.out;
}

/// A limit between the masses of two links, below both, and above both.
TEST_F(KeptLinks, ALimitOnEitherSideOfAMass) {
  ASSERT_LT(mass(5), mass(12));
  std::vector<BoxMasses> given = with_link(5, 1.1);
  given[12] = {0.7, 0.8};
  identify(given, "--log arms.csv --min-mass " + fmt::format("{}", 0.999 * mass(5)));
  expect_written(5);
  expect_written(12);
  identify(given, "--log arms.csv --min-mass " + fmt::format("{}", 1.001 * mass(5)));
  expect_light(5, 1.001 * mass(5));
  expect_written(12);
  EXPECT_EQ(notes_of(5),
            std::vector<std::string>{fmt::format("link l5 is written with {1:g} kg, its given "
                                                 "inertia scaled: it was left with {0:g} kg "
                                                 "(limit {1:g})",
                                                 mass(5), 1.001 * mass(5))});
  EXPECT_TRUE(notes_of(12).empty());
  identify(given, "--log arms.csv --min-mass " + fmt::format("{}", 1.001 * mass(12)));
  expect_light(5, 1.001 * mass(12));
  expect_kept(12);  // lighter than that as it was given
}

/// Written all the same, and mistrusted from three times the given mass on.
TEST_F(KeptLinks, ALinkThatWeighsSeveralTimesWhatItShould) {
  identify(with_link(5, 1.0 / 2.9), "--log arms.csv");
  expect_written(5);
  EXPECT_TRUE(notes_of(5).empty()) << notes_of(5).front();
  const double given = mass(5) / 3.1;
  identify(with_link(5, 1.0 / 3.1), "--log arms.csv");
  expect_written(5);
  ASSERT_EQ(notes_of(5).size(), 1U);
  const std::string begins =
      fmt::format("link l5 was found with {:.3g} kg, given {:.3g}: ", mass(5), given);
  EXPECT_EQ(notes_of(5).front().substr(0, begins.size()), begins);
  EXPECT_TRUE(notes_of(12).empty());
}

/// Arms whose l1 and l5 weigh half a kilogram, and these masses (kg) found for them.
class WrittenLinks : public testing::Test {
 protected:
  WrittenLinks() {
    std::vector<BoxMasses> given = masses_of_arms();
    given[1] = given[5] = {0.25, 0.25};
    UrdfOptions fixed;
    fixed.root = Root::fixed;
    robot = parse_urdf(arms_urdf(given), "arms.urdf", fixed).robot;
  }
  [[nodiscard]] app::Result found(double one, double five) const {
    app::Result result;
    result.found.run.model.free_links = {1, 5};
    result.found.data.determined.assign(20, true);
    result.sought.known = Eigen::VectorXd::Zero(Eigen::Index{10} * robot.link_count());
    result.found.Phi = stacked_parameters(robot);
    result.found.Phi.segment<10>(10) *= one / 0.5;
    result.found.Phi.segment<10>(50) *= five / 0.5;
    return result;
  }

  Robot robot;
};

TEST_F(WrittenLinks, AreHeavierThanTheLimit) {
  app::Result both = found(0.75, 1.25);
  app::choose_written_links(both, robot, 0.5);
  ASSERT_EQ(both.written.size(), 2U);
  EXPECT_EQ(both.written[0].link, 1);
  EXPECT_EQ(both.written[0].inertia.values, both.found.Phi.segment<10>(10));
  EXPECT_EQ(both.written[1].link, 5);
  EXPECT_EQ(both.written[1].inertia.values, both.found.Phi.segment<10>(50));
  EXPECT_TRUE(both.notes.empty());

  app::Result one = found(0.75, 1.25);
  app::choose_written_links(one, robot, 0.75);
  ASSERT_EQ(one.written.size(), 1U);
  EXPECT_EQ(one.written[0].link, 5);
  EXPECT_EQ(one.notes, std::vector<std::string>{"link l1 keeps the given inertia: it was left with "
                                                "0.75 kg (limit 0.75)"});
}

TEST_F(WrittenLinks, AreMistrustedAboveThreeTimesTheGivenMass) {
  app::Result result = found(1.5, std::nextafter(1.5, 2.0));
  app::choose_written_links(result, robot, 0.0);
  EXPECT_EQ(result.written.size(), 2U);
  ASSERT_EQ(result.notes.size(), 1U);
  EXPECT_TRUE(result.notes[0].starts_with("link l5 was found with 1.5 kg, given 0.5: "));

  result.notes.clear();
  result.found.data.determined[10] = false;
  app::choose_written_links(result, robot, 0.0);
  EXPECT_TRUE(result.notes.empty()) << "the data do not say what it weighs";

  // Of a link without a given mass nobody knows what it should weigh.
  robot.links[5].inertia.values.setZero();
  app::Result unknown = found(1.5, 1.5);
  unknown.found.Phi.segment<10>(50) = unknown.found.Phi.segment<10>(10);
  app::choose_written_links(unknown, robot, 0.0);
  EXPECT_EQ(unknown.written.size(), 2U);
  EXPECT_TRUE(unknown.notes.empty());
}

/// What a known link carries may weigh more than the link.
TEST_F(WrittenLinks, AreNotMistrustedForALoad) {
  app::Result result = found(0.5, 2.5);
  result.sought.known = stacked_parameters(robot);
  app::choose_written_links(result, robot, 0.0);
  EXPECT_EQ(result.written.size(), 2U);
  EXPECT_TRUE(result.notes.empty());
}

/// Twice the moment about one axis that the other two allow together.
TEST_F(WrittenLinks, AreBodiesThatAReaderTakes) {
  app::Result result = found(0.75, 1.25);
  auto five = result.found.Phi.segment<10>(50);
  five[4] = 2.0 * (five[7] + five[9]);
  app::choose_written_links(result, robot, 0.0);
  ASSERT_EQ(result.written.size(), 1U);
  EXPECT_EQ(result.written[0].link, 1);
  ASSERT_EQ(result.notes.size(), 1U);
  EXPECT_TRUE(result.notes[0].starts_with(
      "link l5 keeps the given inertia: what was found cannot be written ("))
      << result.notes[0];
}

}  // namespace
}  // namespace shapeid::test
