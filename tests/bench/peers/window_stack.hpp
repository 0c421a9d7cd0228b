// Samples in, masses out: one window of the base link, the whole way.
#pragma once

#include <Eigen/Core>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "shapeid/models/body_model.hpp"
#include "shapeid/models/robot.hpp"
#include "shapeid/models/sample.hpp"

namespace shapeid::bench {

class WindowStack {
 public:
  WindowStack() = default;
  WindowStack(const WindowStack&) = delete;
  WindowStack& operator=(const WindowStack&) = delete;
  virtual ~WindowStack() = default;

  /// Called once for all windows, outside the clock: whatever form of the samples it likes.
  virtual void take(const std::vector<Sample>& samples) = 0;
  /// Masses of the window of `count` samples that starts at `from`. False if something failed.
  virtual bool solve(std::size_t from, std::size_t count, Eigen::VectorXd& m) = 0;
};

struct StackKind {
  std::string name;
  std::function<std::unique_ptr<WindowStack>(const Robot&, const BodyModel&)> make;
};

/// Ours, the published stack and the best mix of other people's parts, as far as they were found.
[[nodiscard]] std::vector<StackKind> window_stacks();

void add_fast(std::vector<StackKind>& stacks);

}  // namespace shapeid::bench
