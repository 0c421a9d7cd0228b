// The reference path: slow and plain on purpose. It stands in the tables as a bound from above.
#include "shapeid/reference/mass_solver.hpp"

#include "shapeid/tests/bench/peers/mass_peer.hpp"

namespace shapeid::bench {
namespace {

class Reference final : public MassPeer {
 public:
  [[nodiscard]] Form form() const override { return Form::triangle; }

  bool solve(const DenseProblem& problem, const Prepared&, const Eigen::VectorXd* warm,
             Eigen::VectorXd& m) override {
    try {
      m = warm == nullptr ? reference::solve_masses(problem.triangle).m
                          : reference::solve_masses(problem.triangle, *warm).m;
      return true;
    } catch (const Defect&) {
      return false;
    }
  }
};

}  // namespace

void add_reference(std::vector<PeerKind>& peers) {
  for (const bool warm : {false, true})
    peers.push_back({warm ? "reference/warm" : "reference", warm,
                     [] { return std::make_unique<Reference>(); }, true, 60});
}

}  // namespace shapeid::bench
