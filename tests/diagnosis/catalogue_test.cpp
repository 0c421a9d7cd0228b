// The catalogue is complete, documented and consistent in itself.
#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <string>

#include "shapeid/diagnosis/effects.hpp"
#include "shapeid/tests/diagnosis/arm.hpp"
#include "shapeid/tests/support/files.hpp"

namespace shapeid::diagnosis {
namespace {

namespace fs = std::filesystem;

std::set<std::string> ids() {
  std::set<std::string> names;
  for (const Effect& e : all_effects()) names.insert(e.id);
  return names;
}

TEST(Catalogue, EveryFileIsRegisteredOnce) {
  std::set<std::string> files;
  for (const auto& file : fs::directory_iterator(SHAPEID_SOURCE_DIR "/diagnosis/effects")) {
    if (file.path().extension() == ".cpp") files.insert(file.path().stem().string());
  }
  EXPECT_EQ(files, ids());
  EXPECT_EQ(all_effects().size(), ids().size());
}

TEST(Catalogue, PageIsTheCatalogue) {
  EXPECT_TRUE(test::text_of(SHAPEID_SOURCE_DIR "/docs/effects.md") == catalogue_page())
      << "renew it: ./run shapeid diagnose --list > docs/effects.md";
}

/// What floats has an accelerometer; what stands on a fixed base has none.
TEST(Catalogue, PlacesAreTheRobots) {
  Robot robot = test::arm();
  for (const Root root : {Root::fixed, Root::floating}) {
    robot.root = root;
    EXPECT_EQ(site_count(robot, SiteKind::accelerometer), root == Root::floating ? 1 : 0);
    EXPECT_EQ(site_count(robot, SiteKind::joint), 3);
    EXPECT_EQ(site_count(robot, SiteKind::link), 4);
    EXPECT_EQ(site_count(robot, SiteKind::contact), 0);
    EXPECT_EQ(site_count(robot, SiteKind::whole), 1);
  }
}

TEST(Catalogue, EveryEffectSaysWhatItIs) {
  for (const Effect& e : all_effects()) {
    SCOPED_TRACE(e.id);
    EXPECT_EQ(find_effect(e.id), &e);
    EXPECT_FALSE(e.title.empty() || e.equation.empty() || e.source.empty());
    EXPECT_FALSE(e.confused_with.empty() || e.separate_by.empty() || e.under_contact.empty());
    ASSERT_FALSE(e.parameters.empty());
    EXPECT_NE(e.columns != nullptr, e.transform.any()) << "columns or a transformation";
    EXPECT_LE(e.shape.size(), 2U);
    std::set<std::string> names;
    for (const Parameter& p : e.parameters) {
      EXPECT_FALSE(p.unit.empty());
      EXPECT_GT(p.size, 0.0);
      EXPECT_GE(p.limit, p.size) << p.name;
      EXPECT_TRUE(names.insert(p.name).second) << p.name;
    }
    for (const ShapeNumber& s : e.shape) {
      EXPECT_TRUE(0.0 < s.lower && s.lower <= s.start && s.start <= s.upper) << s.name;
      EXPECT_TRUE(names.insert(s.name).second) << s.name;
    }
  }
  EXPECT_EQ(find_effect("no such effect"), nullptr);
}

}  // namespace
}  // namespace shapeid::diagnosis
