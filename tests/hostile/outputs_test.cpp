// Places that cannot be written to: full disks, links, devices, folders. What was there before
// stays whole, and the command says in one line what went wrong.
#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iterator>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "shapeid/models/error.hpp"
#include "shapeid/models/file_output.hpp"
#include "shapeid/models/log_writer.hpp"
#include "shapeid/tests/app/command.hpp"
#include "shapeid/tests/hostile/refused.hpp"
#include "shapeid/tests/support/files.hpp"

namespace shapeid::test {
namespace {

namespace fs = std::filesystem;

constexpr const char* ten_numbers =
    "convert --from pinocchio --to drake 2 0.2 -0.4 0.6 1 0.1 1.2 "
    "-0.2 0.3 1.4";

/// Whether something half-written was left behind.
bool leftovers() {
  return std::any_of(fs::directory_iterator(scratch()), fs::directory_iterator(),
                     [](const auto& entry) { return says(entry.path().string(), ".part"); });
}

/// The command with its standard output elsewhere, or limited, as the shell can do it.
CommandRun run_in_shell(const std::string& before, const std::string& arguments,
                        const std::string& after) {
  return program(in_bash(fmt::format("{} {} {}", before, command(arguments), after)));
}

/// A report that was for some eyes only stays so when it is made again.
TEST(HostileOutputs, PermissionsStayWhereAFileIsReplaced) {
  const std::string path = scratch_file("private.json", "{}\n");
  for (const mode_t mode : {0600U, 0640U, 0664U}) {
    ASSERT_EQ(::chmod(path.c_str(), mode), 0);
    write_file(path, "{\"again\": 1}\n");
    struct stat now {};
    ASSERT_EQ(::stat(path.c_str(), &now), 0);
    EXPECT_EQ(now.st_mode & 0777U, mode);
  }
}

/// And while it is made: a log takes as long as its robot moves.
TEST(HostileOutputs, PermissionsHoldWhileAFileIsReplaced) {
  const std::string path = scratch_file("private.csv", "time\n");
  for (const mode_t mode : {0600U, 0400U, 0640U}) {
    ASSERT_EQ(::chmod(path.c_str(), mode), 0);
    LogWriter out(path, {"time"});
    out.write({1.0});
    struct stat now {};
    ASSERT_EQ(::stat(fmt::format("{}.part{}", path, ::getpid()).c_str(), &now), 0);
    EXPECT_EQ(now.st_mode & 0777U, mode | 0200U);
    out.close();
    ASSERT_EQ(::stat(path.c_str(), &now), 0);
    EXPECT_EQ(now.st_mode & 0777U, mode);
  }
}

/// A folder that is locked twice waits for itself.
TEST(HostileOutputs, FilesOfOneFolderHaveOneFolder) {
  const std::string there = scratch_file("there.json", "{}\n");
  fs::create_directory_symlink(scratch(), scratch() + "/by_link");
  const std::string folder = fs::canonical(scratch()).string();
  EXPECT_EQ(OutputPlace(there).folder(), folder);
  EXPECT_EQ(OutputPlace(scratch() + "/by_link/there.json").folder(), folder);
  EXPECT_EQ(OutputPlace(scratch() + "/by_link/not_there.json").folder(), folder);
  EXPECT_EQ(OutputPlace(scratch() + "/by_link/./not_there.json").folder(), folder);
  EXPECT_EQ(OutputPlace("no_file_has_this_name").folder(), fs::current_path().string());
}

TEST(HostileOutputs, StandardOutputThatIsFull) {
  expect_one_line(run_in_shell("", ten_numbers, ">/dev/full"), 2, "standard output");
  expect_one_line(run_in_shell("", ten_numbers, ">&-"), 2, "standard output");
  expect_one_line(run_in_shell("", "--help", ">/dev/full"), 2, "standard output");
}

/// Where nobody can read what is said, the status still tells. (It was an abort: `2>&1 | head`.)
TEST(HostileOutputs, StandardErrorThatIsClosedOrFull) {
  const std::string warns = "convert --from pinocchio --to drake -1 0 0 0 1 0 1 0 0 1";
  for (const std::string where : {"2>/dev/full", "2>&-"}) {
    EXPECT_EQ(run_in_shell("", "inspect none.csv", where).status, 2) << where;
    EXPECT_EQ(run_in_shell("", "no-such-verb", where).status, 2) << where;
    EXPECT_EQ(run_in_shell("", warns, where).status, 0) << where;
    const CommandRun wrote = run_in_shell("", "simulate --seconds 0.2 --out said.csv", where);
    EXPECT_EQ(wrote.status, 0) << where;
  }
}

/// Under nohup a program outlives its terminal. (It ends by itself, whatever becomes of the
/// signals.)
TEST(HostileOutputs, AnIgnoredHangupStaysIgnored) {
  simulated_log("followed.csv", "--seconds 0.2");
  const std::string follows = command("track --whole-body --follow --patience 20 followed.csv " +
                                      quadruped_files + " >/dev/null 2>&1");
  for (const bool ignored : {true, false}) {
    // (Who runs the tests may ignore it already, as nohup does.)
    const CommandRun run = program(in_bash(fmt::format(
        "{} {} & p=\\$!; sleep 0.5; kill -HUP \\$p; sleep 0.3; kill -0 \\$p && echo alive; "
        "kill -TERM \\$p; wait \\$p",
        ignored ? "trap '' HUP;" : "env --default-signal=HUP", follows)));
    EXPECT_EQ(run.out, ignored ? "alive\n" : "") << run.err;
  }
}

// A limit on the size of files stands for a full disk: writing stops in the middle.
TEST(HostileOutputs, ADiskThatIsFull) {
  for (const std::string name : {"full.csv", "full.csv.gz"}) {
    scratch_file(name, "the one from before\n");
    const CommandRun run = run_in_shell("trap '' XFSZ; ulimit -f 2;",
                                        "simulate --seconds 0.2 --out " + name, ">/dev/null");
    expect_one_line(run, 2, name + ": cannot be written");
    EXPECT_EQ(text_of(scratch() + "/" + name), "the one from before\n");
    EXPECT_FALSE(leftovers());
  }
}

TEST(HostileOutputs, LinksAreFollowedAndStay) {
  const std::string target = scratch_file("target.txt", "old");
  const std::string link = scratch() + "/link.txt";
  fs::create_symlink("target.txt", link);
  write_file(link, "new");
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_EQ(text_of(target), "new");

  const std::string nowhere = scratch() + "/nowhere.txt";
  fs::create_symlink(scratch() + "/none/there.txt", nowhere);
  write_file(nowhere, "new");
  EXPECT_EQ(text_of(nowhere), "new");
}

TEST(HostileOutputs, DevicesAreWrittenToAndNotReplaced) {
  write_file("/dev/null", "anything");
  struct stat now {};
  ASSERT_EQ(stat("/dev/null", &now), 0);
  EXPECT_TRUE(S_ISCHR(now.st_mode));
  LogWriter log("/dev/null", {"a"});
  log.write({1.0});
  log.close();
  ASSERT_EQ(stat("/dev/null", &now), 0);
  EXPECT_TRUE(S_ISCHR(now.st_mode));

  EXPECT_TRUE(says(refusal([] { write_file("/dev/full", "anything"); }), "cannot be written"));
  EXPECT_TRUE(says(refusal([] {
                     LogWriter full("/dev/full", {"a"});
                     full.close();
                   }),
                   "cannot be written"));
  ASSERT_EQ(stat("/dev/full", &now), 0);
  EXPECT_TRUE(S_ISCHR(now.st_mode));
}

TEST(HostileOutputs, FoldersAreNoFiles) {
  EXPECT_TRUE(says(refusal([] { write_file(scratch(), "anything"); }), "is a folder"));
  EXPECT_TRUE(
      says(refusal([] { write_file(scratch() + "/none/file", "anything"); }), "cannot be written"));
  EXPECT_TRUE(says(refusal([] { write_file("", "anything"); }), "cannot be "));
  EXPECT_TRUE(says(refusal([] { LogWriter(scratch(), {"a"}); }), "is a folder"));
}

// A set of files is written as a whole or not at all.
TEST(HostileOutputs, AFolderWhereOneOfASetWouldBe) {
  simulated_log("set.csv", "--exact --seconds 2 --rate 50");
  scratch_file("box.yaml", "base: [{kind: cuboid, size: [0.5, 0.25, 0.15]}]\n");
  const std::string robots = SHAPEID_SOURCE_DIR "/models/robots/";
  const std::string inputs = fmt::format(
      "--robot {0}quadruped.urdf --log set.csv --exact --shapes box.yaml --out set", robots);
  fs::create_directories(scratch() + "/set/identified.urdf");
  for (const std::string verb : {"identify ", "diagnose "}) {
    const CommandRun run = shapeid(verb + inputs);
    EXPECT_EQ(run.status, 2) << run.err;
    EXPECT_TRUE(says(run.err, "identified.urdf: is a folder")) << run.err;
    EXPECT_EQ(std::distance(fs::directory_iterator(scratch() + "/set"), fs::directory_iterator()),
              1);
  }
}

/// A set of files that all say the same.
std::vector<FileText> set_of(const std::string& folder, const std::string& text) {
  std::vector<FileText> files;
  for (const char* name : {"a", "b", "c", "d", "e"}) files.push_back({folder + "/" + name, text});
  return files;
}

/// The folder's lock, as long as this is there.
class Lock {
 public:
  Lock(const std::string& folder, int kind)
      : file_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
    EXPECT_EQ(::flock(file_, kind), 0);
  }
  ~Lock() {
    ::flock(file_, LOCK_UN);  // a child that was begun meanwhile would go on holding it
    ::close(file_);
  }
  Lock(const Lock&) = delete;
  Lock& operator=(const Lock&) = delete;

 private:
  int file_;
};

// Several processes write the same set. Who looks with the lock sees one set, whosever, whole.
TEST(HostileOutputs, SetsOfSeveralProcessesAreNotMixed) {
  constexpr int writers = 3, times = 150;
  const std::string folder = scratch() + "/shared";
  fs::create_directories(folder);
  write_files(set_of(folder, "first"));
  std::vector<pid_t> children;
  for (int writer = 0; writer < writers; ++writer) {
    children.push_back(fork());
    ASSERT_GE(children.back(), 0);
    if (children.back() != 0) continue;
    for (int i = 0; i < times; ++i) write_files(set_of(folder, fmt::format("{} {}", writer, i)));
    _exit(0);
  }
  std::size_t mixed = 0;
  for (std::size_t ended = 0; ended < children.size();) {
    int status = 0;
    if (waitpid(-1, &status, WNOHANG) > 0) {
      EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
      ++ended;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));  // their turn
    const Lock lock(folder, LOCK_SH);
    const std::string one = text_of(folder + "/a");
    for (const FileText& file : set_of(folder, one)) mixed += text_of(file.path) == one ? 0 : 1;
  }
  EXPECT_EQ(mixed, 0U);
  // No lock is left, nor anything else beside the set.
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 5);
}

// What is written waits beside until the folder is free.
TEST(HostileOutputs, ASetWaitsForItsFolder) {
  const std::string folder = scratch() + "/held";
  fs::create_directories(folder);
  write_files(set_of(folder, "old"));
  auto lock = std::make_unique<Lock>(folder, LOCK_EX);
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    write_files(set_of(folder, "new"));
    _exit(0);
  }
  const std::string last = fmt::format("{}/e.part{}", folder, child);
  constexpr int tries = 1000;
  for (int i = 0; i < tries && !fs::exists(last); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  for (const FileText& file : set_of(folder, "old")) EXPECT_EQ(text_of(file.path), file.text);
  lock.reset();
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  for (const FileText& file : set_of(folder, "new")) EXPECT_EQ(text_of(file.path), file.text);
}

// Said before the work, and so before inputs are read that are not there.
TEST(HostileOutputs, PlacesThatCannotBeWrittenAreFoundFirst) {
  scratch_file("plain", "a file\n");
  fs::create_symlink(scratch() + "/none/there", scratch() + "/astray");
  const std::string robot = "--robot none.urdf --log none.csv ";
  for (const std::string& verb : {"identify " + robot, "diagnose " + robot, "batch " + robot,
                                  "load --area base 0 1 0 1 0 1 " + robot, std::string("demo ")}) {
    for (const std::string folder :
         {"plain", "plain/in/it", "/proc/none/there", "astray", "/proc"}) {
      SCOPED_TRACE(verb + folder);
      const CommandRun run = shapeid(verb + "--out " + folder);
      const bool in_file = folder.starts_with("plain");
      // By the name that was given: what was tried in a folder is nobody's.
      expect_one_line(run, 2, in_file ? "plain: is no folder" : "shapeid: " + folder + ": ");
    }
    expect_one_line(shapeid(verb + "--out " + std::string(300, 'a')), 2, "cannot be made");
  }
  expect_one_line(shapeid("track --robot none.urdf none.csv --checkpoint none/there"), 2,
                  "none/there: cannot be written");
  expect_one_line(shapeid("certify none.json none.json --out none/there"), 2,
                  "none/there: cannot be written");
  // What is only refused later has made nothing.
  expect_one_line(shapeid("identify --out made/by/it " + robot), 2, "none.csv");
  EXPECT_FALSE(fs::exists(scratch() + "/made"));
  EXPECT_FALSE(leftovers());
}

// What a user types may hold anything as well.
TEST(HostileOutputs, ArgumentsInMessages) {
  expect_one_line(shapeid("inspect \"$(printf 'a\\nb.csv')\""), 2, "a\\x0ab.csv");
}

}  // namespace
}  // namespace shapeid::test
