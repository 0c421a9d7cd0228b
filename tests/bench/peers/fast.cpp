// Ours.
#include "shapeid/fast/mass_solver.hpp"

#include "shapeid/tests/bench/peers/mass_peer.hpp"

namespace shapeid::bench {
namespace {

class Fast final : public MassPeer {
 public:
  [[nodiscard]] Form form() const override { return Form::triangle; }

  bool solve(const DenseProblem& problem, const Prepared&, const Eigen::VectorXd* warm,
             Eigen::VectorXd& m) override {
    const fast::Outcome outcome =
        warm != nullptr && problem.cut ? divide(problem) : solve(problem, warm != nullptr);
    if (outcome == fast::Outcome::solved) m = solver_->m();
    return outcome == fast::Outcome::solved;
  }

 private:
  /// Its own last masses are the warm start.
  fast::Outcome solve(const DenseProblem& problem, bool warm) {
    if (!solver_ || solver_->shapes() != problem.triangle.shapes()) load(problem);
    if (!warm) solver_->forget_masses();
    return solver_->solve(problem.R);
  }

  fast::Outcome divide(const DenseProblem& problem) {
    const MassProblem& p = problem.triangle;
    const Eigen::Index place = problem.cut->place, last = p.shapes() - 1;
    if (!solver_->divide(static_cast<int>(place), p.U.col(place), p.V[place], p.U.col(last),
                         p.V[last]))
      return fast::Outcome::too_many_steps;
    return solver_->solve_again();
  }

  void load(const DenseProblem& problem) {
    const MassProblem& p = problem.triangle;
    const int links = static_cast<int>(problem.first.size()) - 1;
    if (!solver_ || solver_->links() != links)
      solver_ = std::make_unique<fast::MassSolver>(links, most_shapes);
    solver_->clear();
    solver_->set_lambda(p.lambda);
    for (int link = 0; link < links; ++link) {
      const auto place = static_cast<std::size_t>(link);
      for (Eigen::Index j = problem.first[place]; j < problem.first[place + 1]; ++j) {
        if (!solver_->append(link, p.U.col(j).segment<10>(10 * link), p.V[j])) return;
      }
    }
  }

  static constexpr int most_shapes = 1024;
  std::unique_ptr<fast::MassSolver> solver_;
};

}  // namespace

void add_fast(std::vector<PeerKind>& peers) {
  peers.push_back({"fast", false, [] { return std::make_unique<Fast>(); }, true});
  peers.push_back({"fast/warm", true, [] { return std::make_unique<Fast>(); }, true});
}

}  // namespace shapeid::bench
