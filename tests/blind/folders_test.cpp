// Trials that have no answer are counted, and the script goes on after a crash.
#include "shapeid/tests/blind/parts/folders.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>

#include "shapeid/tests/support/scratch_folder.hpp"

namespace shapeid::blind {
namespace {

namespace fs = std::filesystem;

/// Folders of trials of nothing, with a seal and a log of no lines, and programs that stand for
/// those of a build.
class StandIn {
 public:
  StandIn() {
    fs::create_directories(scratch_.path("build/tests"));
    // Each trial says how its diagnosis ends; the answer is what the diagnosis was called with.
    program("build/shapeid",
            "how=$(cat \"$(dirname \"$3\")/how\")\n"
            "[ \"$how\" = killed ] && kill -KILL $$\n"
            "echo \"$@\"\nexit \"$how\"\n");
    program("build/tests/blind", "exit 0\n");
  }

  void add(int number, const std::string& how, const std::string& error = {}) const {
    const std::string trial = fmt::format("set/trial{:04d}/", number);
    fs::create_directories(scratch_.path(trial));
    Trial t;
    t.machine = "arm";
    t.error = error;
    (void)scratch_.write(trial + "sealed.json", to_json(t).dump());
    if (error.empty()) {
      (void)scratch_.write(trial + "log.csv", "time\n");
      (void)scratch_.write(trial + "cutoff", "12.5\n");
    }
    (void)scratch_.write(trial + "how", how);
    (void)scratch_.write("set/arguments", "\n");
  }
  [[nodiscard]] std::string set() const { return scratch_.path("set"); }
  [[nodiscard]] std::string file(int number, const std::string& name) const {
    return fmt::format("{}/trial{:04d}/{}", set(), number, name);
  }
  void write(int number, const std::string& name, const std::string& text) const {
    std::ofstream(file(number, name)) << text;
  }
  /// "no such file" if there is none.
  [[nodiscard]] std::string text(int number, const std::string& name) const {
    std::ifstream in(file(number, name));
    if (!in) return "no such file";
    return {std::istreambuf_iterator<char>(in), {}};
  }
  [[nodiscard]] int run() const {
    const std::string line = fmt::format("BUILD={} JOBS=1 {}/tests/blind/run {} >/dev/null 2>&1",
                                         scratch_.path("build"), SHAPEID_SOURCE_DIR, set());
    return std::system(line.c_str());
  }

 private:
  void program(const std::string& name, const std::string& body) const {
    const std::string path = scratch_.write(name, "#!/usr/bin/env bash\n" + body);
    fs::permissions(path, fs::perms::owner_all);
  }

  test::ScratchFolder scratch_;
};

TEST(Folders, TrialsWithoutAnAnswerAreCounted) {
  const StandIn set;
  set.add(0, "");
  set.write(0, "result.json", "");
  set.add(1, "");
  set.write(1, "crashed", "139\n");
  set.add(2, "");
  set.add(3, "", "the robot fell");
  const TrialFolders found = find_trials({set.set()});
  EXPECT_EQ(found.made, 3);
  EXPECT_EQ(how_many(found),
            "1 of 3 trials diagnosed, 1 more crashed; of 1 others the robot fell.");
  ASSERT_EQ(found.ended.size(), 2U);
  EXPECT_EQ(score_trial(found.ended[0]).judgement.outcome, Outcome::refused);
  EXPECT_EQ(score_trial(found.ended[1]).judgement.outcome, Outcome::crashed);
}

TEST(Folders, TheScriptGoesOnAfterACrash) {
  const StandIn set;
  set.add(0, "3");
  set.add(1, "killed");
  set.add(2, "1");
  set.add(3, "0");
  set.write(3, "reference.csv", "time\n");
  EXPECT_EQ(set.run(), 0);
  EXPECT_EQ(set.text(0, "crashed"), "3\n");
  EXPECT_EQ(set.text(0, "result.json"), "no such file");
  EXPECT_EQ(set.text(1, "crashed"), "137\n");
  EXPECT_EQ(set.text(2, "crashed"), "no such file");
  EXPECT_EQ(set.text(2, "result.json"), "");
  EXPECT_NE(set.text(3, "result.json").find("--reference"), std::string::npos);
  EXPECT_NE(set.text(3, "result.json").find("--cutoff 12.5 "), std::string::npos);
  EXPECT_EQ(how_many(find_trials({set.set()})), "2 of 4 trials diagnosed, 2 more crashed.");
  // Gone on with: what crashed is tried again.
  set.write(0, "how", "0");
  EXPECT_EQ(set.run(), 0);
  EXPECT_EQ(set.text(0, "crashed"), "no such file");
  EXPECT_NE(set.text(0, "result.json").find("--log"), std::string::npos);
}

/// What was ended from outside is no crash: it waits, and so do those after it.
TEST(Folders, AnEndFromOutsideIsNoCrash) {
  const StandIn set;
  set.add(0, "143");
  set.add(1, "0");
  EXPECT_NE(set.run(), 0);
  EXPECT_EQ(set.text(0, "crashed"), "no such file");
  EXPECT_EQ(how_many(find_trials({set.set()})), "0 of 2 trials diagnosed.");
}

}  // namespace
}  // namespace shapeid::blind
