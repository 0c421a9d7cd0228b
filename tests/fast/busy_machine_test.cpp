// How long a window takes when other processes want the same cores. Printed, never asserted: that
// is the machine's affair. What is asserted is that the answers are the same.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <thread>
#include <vector>

#include "shapeid/fast/identifier.hpp"
#include "shapeid/tests/fast/cases.hpp"
#include "shapeid/tests/support/trot.hpp"

namespace shapeid {
namespace {

/// A process that computes until it is ended.
class BusyProcess {
 public:
  BusyProcess() : child_(fork()) {
    if (child_ == 0) prctl(PR_SET_PDEATHSIG, SIGKILL);  // not to outlive a test that is ended
    volatile unsigned counter = 0;
    while (child_ == 0) counter = counter + 1;
  }
  BusyProcess(const BusyProcess&) = delete;
  BusyProcess& operator=(const BusyProcess&) = delete;
  ~BusyProcess() {
    if (child_ <= 0) return;
    kill(child_, SIGKILL);
    waitpid(child_, nullptr, 0);
  }

 private:
  pid_t child_;
};

struct Paced {
  double slowest_window = 0.0, slowest_call = 0.0;  ///< s
  std::vector<Eigen::VectorXd> answers;
};

/// Ten thousand windows of ten samples.
Paced run(const Robot& robot, const std::vector<Sample>& samples) {
  fast::IdentifierSettings settings;
  settings.expected_mass = 6.0;
  fast::Identifier identifier(robot, test::bundled_shapes(robot), settings);
  Paced result;
  for (int round = 0; round < 200; ++round) {
    for (const Sample& s : samples) {
      if (identifier.feed(s) != fast::Identifier::Fed::answered) continue;
      const fast::WindowAnswer& answer = identifier.answer();
      result.slowest_window = std::max(result.slowest_window, answer.seconds);
      result.slowest_call =
          std::max({result.slowest_call, answer.slowest_sample, answer.last_call});
      if (round == 0) result.answers.push_back(identifier.Phi());
    }
  }
  return result;
}

TEST(FastBusyMachine, AnswersDoNotDependOnWhoElseComputes) {
  const Robot robot = test::bundled_quadruped();
  const std::vector<Sample> samples =
      test::trot(robot, stacked_parameters(robot), 7, 500, test::Noise::sensors);
  const Paced alone = run(robot, samples);
  Paced beside;
  {
    // One for each core: the identifier's share is half of one.
    const std::vector<BusyProcess> others(std::max(1U, std::thread::hardware_concurrency()));
    beside = run(robot, samples);
  }
  fmt::print(
      "10,000 windows, slowest: {:.0f} us (call {:.0f} us); beside a busy process a core: "
      "{:.0f} us (call {:.0f} us)\n",
      1e6 * alone.slowest_window, 1e6 * alone.slowest_call, 1e6 * beside.slowest_window,
      1e6 * beside.slowest_call);
  EXPECT_EQ(alone.answers.size(), samples.size() / 10);
  EXPECT_EQ(alone.answers, beside.answers);
}

}  // namespace
}  // namespace shapeid
