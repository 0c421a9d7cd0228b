// Ours, from samples to masses.
#include "shapeid/fast/mass_solver.hpp"
#include "shapeid/fast/window.hpp"
#include "shapeid/tests/bench/peers/window_stack.hpp"

namespace shapeid::bench {
namespace {

class FastStack final : public WindowStack {
 public:
  FastStack(const Robot& robot, const BodyModel& model)
      : window_(robot, model, ContactTreatment::project, Eigen::VectorXd::Ones(robot.dof())),
        solver_(1, static_cast<int>(model.shapes.size())) {
    const Eigen::MatrixXd U = shape_columns(model);
    const Eigen::VectorXd V = shape_volumes(model);
    for (Eigen::Index j = 0; j < U.cols(); ++j) complete_ = solver_.append(0, U.col(j), V[j]);
  }

  void take(const std::vector<Sample>& samples) override { samples_ = samples; }

  bool solve(std::size_t from, std::size_t count, Eigen::VectorXd& m) override {
    window_.clear();
    for (std::size_t i = from; i < from + count; ++i) {
      if (window_.add(samples_[i]) != fast::Verdict::taken) return false;
    }
    solver_.forget_masses();
    if (solver_.solve(window_.triangle().R()) != fast::Outcome::solved) return false;
    m = solver_.m();
    return complete_;
  }

 private:
  fast::Window window_;
  fast::MassSolver solver_;
  bool complete_ = true;
  std::vector<Sample> samples_;
};

}  // namespace

void add_fast(std::vector<StackKind>& stacks) {
  stacks.push_back({"fast", [](const Robot& robot, const BodyModel& model) {
                      return std::make_unique<FastStack>(robot, model);
                    }});
}

}  // namespace shapeid::bench
