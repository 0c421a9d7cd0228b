// The small form of every experiment gives what was recorded.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "shapeid/tests/experiments/data/cheetah.hpp"
#include "shapeid/tests/experiments/studies/recorded.hpp"

namespace shapeid::experiments {
namespace {

// The same build on the same machine gives the same numbers to the last digit. Another compiler
// rounds differently, and a second of trot multiplies that by some thousands; what solvers leave
// where the optimum is zero is rounding altogether.
constexpr double relative = 1e-3;
constexpr double smallest = 1e-5;

TEST(Recorded, SmallFormsGiveTheNumbersOfTheFile) {
  std::ifstream in(SHAPEID_SOURCE_DIR "/tests/experiments/recorded.json");
  auto recorded = nlohmann::json::parse(in).get<std::map<std::string, double>>();
  if (!cheetah_folder()) {
    fmt::print("skipped: numbers measured.*, for SHAPEID_DATA has no mini_cheetah_umich\n");
    std::erase_if(recorded, [](const auto& entry) { return entry.first.starts_with("measured."); });
  }
  for (const std::string& line : differences(recorded, small_values(), relative, smallest)) {
    ADD_FAILURE() << line
                  << "; after a change that is meant: build/release/tests/experiments record "
                     "tests/experiments/recorded.json";
  }
}

TEST(Recorded, DifferencesAreSeen) {
  const std::map<std::string, double> recorded = {{"a", 1.0}, {"b", 0.0}};
  EXPECT_EQ(differences(recorded, {{"a", 1.0005}, {"b", 5e-6}}, relative, smallest).size(), 0U);
  EXPECT_EQ(differences(recorded, {{"a", 1.005}, {"b", 0.0}}, relative, smallest).size(), 1U);
  EXPECT_EQ(differences(recorded, {{"a", 1.0}, {"b", 1e-4}}, relative, smallest).size(), 1U);
  EXPECT_EQ(differences(recorded, {{"a", 1.0}}, relative, smallest).size(), 1U);
  EXPECT_EQ(differences(recorded, {{"a", 1.0}, {"b", 0.0}, {"c", 0.0}}, relative, smallest).size(),
            1U);
}

}  // namespace
}  // namespace shapeid::experiments
