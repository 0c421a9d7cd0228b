// Slow readers, slow writers, readers that go away and disks that are full: nothing is lost
// silently.
#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include "shapeid/tests/app/command.hpp"
#include "shapeid/tests/support/files.hpp"
#include "shapeid/tests/track/logs.hpp"

namespace shapeid::test {
namespace {

using std::chrono::milliseconds;

const std::string& log_text() {
  static const std::string text = joined(trot_log());
  return text;
}

std::string followed_without_haste() {
  scratch_file("calm.csv", log_text());
  const CommandRun run = shapeid(track("calm.csv"));
  EXPECT_EQ(run.status, 0) << run.err;
  return run.out;
}

/// `track -` between two pipes whose other ends are ours.
class Piped {
 public:
  explicit Piped(const std::string& options = "") {
    std::array<int, 2> in{}, out{};
    if (pipe(in.data()) != 0 || pipe(out.data()) != 0) throw std::runtime_error("no pipe");
    const std::string line = "exec " + command(track(options + " -"));
    child_ = fork();
    if (child_ == 0) {
      dup2(in[0], STDIN_FILENO);
      dup2(out[1], STDOUT_FILENO);
      for (const int end : {in[0], in[1], out[0], out[1]}) close(end);
      execl("/bin/sh", "sh", "-c", line.c_str(), nullptr);
      _exit(127);
    }
    close(in[0]);
    close(out[1]);
    to_ = in[1];
    from_ = out[0];
    fcntl(to_, F_SETFL, O_NONBLOCK);
  }
  Piped(const Piped&) = delete;
  Piped& operator=(const Piped&) = delete;
  ~Piped() {
    close_input();
    close(from_);
    if (child_ > 0) {
      kill(child_, SIGKILL);
      waitpid(child_, nullptr, 0);
    }
  }

  /// As much as it takes without waiting.
  std::size_t offer(const char* bytes, std::size_t size) const {
    const ssize_t taken = write(to_, bytes, size);
    return taken > 0 ? static_cast<std::size_t>(taken) : 0;
  }
  void close_input() {
    if (to_ >= 0) close(to_);
    to_ = -1;
  }
  /// At most so many bytes, if there are any within the time; empty at the end as well.
  [[nodiscard]] std::string take(std::size_t size, milliseconds patience) const {
    pollfd waiting{from_, POLLIN, 0};
    if (poll(&waiting, 1, static_cast<int>(patience.count())) <= 0) return {};
    std::string bytes(size, '\0');
    const ssize_t count = read(from_, bytes.data(), size);
    bytes.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
    return bytes;
  }
  /// Everything up to the end.
  [[nodiscard]] std::string rest() const {
    std::string all;
    for (std::string more; !(more = take(65536, milliseconds(10000))).empty();) all += more;
    return all;
  }
  /// Whether there is something to take.
  [[nodiscard]] bool has_spoken() const {
    pollfd waiting{from_, POLLIN, 0};
    return poll(&waiting, 1, 0) > 0;
  }
  /// kB that are in memory.
  [[nodiscard]] long resident() const {
    std::ifstream status(fmt::format("/proc/{}/status", child_));
    for (std::string word; status >> word;) {
      long size = 0;
      if (word == "VmRSS:" && status >> size) return size;
    }
    return 0;
  }
  [[nodiscard]] int wait() {
    int status = 0;
    waitpid(child_, &status, 0);
    child_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  int to_ = -1, from_ = -1;
  pid_t child_ = -1;
};

/// Offers what is left of the log, as long as something is taken within the time.
void fill(const Piped& run, std::size_t& written, milliseconds patience) {
  auto last = std::chrono::steady_clock::now();
  while (written < log_text().size() && std::chrono::steady_clock::now() - last < patience) {
    const std::size_t taken = run.offer(log_text().data() + written, log_text().size() - written);
    written += taken;
    if (taken > 0) last = std::chrono::steady_clock::now();
    std::this_thread::sleep_for(milliseconds(1));
  }
}

// A reader that stops for as long as it likes: `track` waits, and so does who writes to it.
TEST(TrackStreams, ASlowReaderLosesNothingAndFillsNoMemory) {
  constexpr milliseconds stalled(1000), moment(20);
  constexpr long pages = 256;  // kB, that an allocator may keep or give back meanwhile
  Piped run;
  std::size_t written = 0;
  // However long it takes to start, it has started when it says something.
  for (int i = 0; i < 30000 && !run.has_spoken(); ++i) fill(run, written, milliseconds(1));
  ASSERT_TRUE(run.has_spoken());
  fill(run, written, stalled);
  EXPECT_LT(written, log_text().size() / 2) << "the writer should have had to wait";
  const long before = run.resident();
  std::this_thread::sleep_for(stalled);
  EXPECT_LE(run.resident(), before + pages);
  std::string said;
  while (written < log_text().size()) {
    said += run.take(1000, moment);
    fill(run, written, milliseconds(0));
    written += run.offer(log_text().data() + written, log_text().size() - written);
  }
  run.close_input();
  said += run.rest();
  EXPECT_EQ(run.wait(), 0);
  EXPECT_TRUE(said == followed_without_haste());
}

TEST(TrackStreams, ASlowWriterIsWaitedFor) {
  constexpr std::size_t portion = 7001;  // bytes: no line ends there but by chance
  Piped run;
  std::string said;
  for (std::size_t written = 0; written < log_text().size();) {
    const std::size_t size = std::min(portion, log_text().size() - written);
    written += run.offer(log_text().data() + written, size);
    said += run.take(65536, milliseconds(5));
  }
  run.close_input();
  said += run.rest();
  EXPECT_EQ(run.wait(), 0);
  EXPECT_TRUE(said == followed_without_haste());
}

/// The robot's program hangs, and keeps its end of the pipe open.
TEST(TrackStreams, AWriterThatFallsSilentIsLeftWhenPatienceEnds) {
  ASSERT_FALSE(log_text().empty());  // made before anyone waits for it
  Piped run("--follow --patience 3");
  std::string said;
  for (std::size_t written = 0; written < log_text().size();) {
    said += run.take(65536, milliseconds(5));
    written += run.offer(log_text().data() + written, log_text().size() - written);
  }
  said += run.rest();
  EXPECT_EQ(run.wait(), 0);
  EXPECT_TRUE(said == followed_without_haste());
}

/// Who deletes or rotates the log writes no more into the file that is open here.
TEST(TrackStreams, ALogThatIsNotThereAnyMoreEndsTheFollowing) {
  scratch_file("another.csv", log_text());
  const auto followed_until = [](const std::string& change) {
    scratch_file("moved.csv", log_text());
    // The change comes when the log is open and lines are printed, at whatever time that is.
    std::filesystem::remove(scratch() + "/said.txt");
    const std::string line =
        fmt::format("{} >said.txt & while [ ! -s said.txt ]; do sleep 0.01; done; {}; wait \\$!",
                    command(track("--follow moved.csv")), change);
    return program("timeout 60 " + in_bash(line));
  };
  expect_one_line(followed_until("rm moved.csv"), 2, "moved.csv:");
  expect_one_line(followed_until("rm moved.csv"), 2, "is not there any more");
  expect_one_line(followed_until("cp another.csv new.csv; mv new.csv moved.csv"), 2,
                  "is another file now");
  // Between the two commands it is not there, after them it is another.
  expect_one_line(followed_until("mv moved.csv moved.csv.1; cp another.csv moved.csv"), 2,
                  "follow a log that stays where it is");
  EXPECT_TRUE(text_of(scratch() + "/said.txt") == followed_without_haste());
}

TEST(TrackStreams, ACutoffThatSettlesAfterTheLogIsNamed) {
  scratch_file("calm.csv", log_text());
  expect_one_line(shapeid(track("--cutoff 1e-9 calm.csv")), 1, "with --cutoff 1e-09 the first");
  EXPECT_EQ(shapeid(track("--cutoff 1e-9 calm.csv")).err.find("256"), std::string::npos);
}

void expect_said(const CommandRun& run) {
  expect_one_line(run, 2, "standard output cannot be written");
}

TEST(TrackStreams, AFullDiskIsSaid) {
  scratch_file("calm.csv", log_text());
  for (const std::string& what :
       {track("calm.csv"), std::string("inspect calm.csv"), std::string("--help"),
        std::string("convert --from pinocchio --to drake 2 0.2 -0.4 0.6 1 0.1 1.2 -0.2 0.3 1.4")}) {
    expect_said(program(in_bash(command(what) + " >/dev/full")));
  }
}

TEST(TrackStreams, AReaderThatGoesAwayIsSaid) {
  scratch_file("calm.csv", log_text());
  expect_said(program(
      in_bash(command(track("calm.csv")) + " | head -n 3 >/dev/null; exit \\${PIPESTATUS[0]}")));
}

// The limit on a file's size stands for the disk that is full.
TEST(TrackStreams, ACheckpointThatCannotBeWrittenLeavesTheOldOneWhole) {
  const std::string half = log_text().substr(0, log_text().size() / 2);
  scratch_file("growing.csv", half);
  const std::string options = track("--checkpoint kept.json --resume growing.csv");
  std::filesystem::remove(scratch() + "/kept.json");
  const CommandRun first = shapeid(options);
  ASSERT_EQ(first.status, 0) << first.err;
  const std::string kept = text_of(scratch() + "/kept.json");

  scratch_file("growing.csv", log_text());
  const CommandRun failed = program(in_bash("trap '' XFSZ; ulimit -f 4; " + command(options) +
                                            " | cat >/dev/null; exit "
                                            "\\${PIPESTATUS[0]}"));
  EXPECT_EQ(failed.status, 2);
  EXPECT_NE(failed.err.find("kept.json: cannot be written"), std::string::npos) << failed.err;
  EXPECT_TRUE(text_of(scratch() + "/kept.json") == kept);
  for (const auto& file : std::filesystem::directory_iterator(scratch())) {
    EXPECT_EQ(file.path().string().find("kept.json.part"), std::string::npos) << file.path();
  }

  const CommandRun again = shapeid(options);
  ASSERT_EQ(again.status, 0) << again.err;
  EXPECT_TRUE(first.out + again.out == followed_without_haste());
}

}  // namespace
}  // namespace shapeid::test
