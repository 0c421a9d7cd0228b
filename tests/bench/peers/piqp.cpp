// PIQP's dense interior point method. It has no warm start.
#include <piqp/piqp.hpp>

#include "shapeid/tests/bench/peers/mass_peer.hpp"

namespace shapeid::bench {
namespace {

/// The loosest power of ten that kept objectives within the tables' bound on the tuning seeds.
constexpr double accuracy = 1e-10;

class Piqp final : public MassPeer {
 public:
  [[nodiscard]] Form form() const override { return Form::normal; }

  bool solve(const DenseProblem&, const Prepared& prepared, const Eigen::VectorXd*,
             Eigen::VectorXd& m) override {
    using piqp::nullopt;
    if (zeros_.size() == prepared.H.cols()) {
      solver_->update(prepared.H, prepared.g);
    } else {
      zeros_ = Eigen::VectorXd::Zero(prepared.H.cols());
      solver_ = std::make_unique<piqp::DenseSolver<double>>();
      solver_->settings().eps_abs = accuracy;
      solver_->settings().eps_rel = 0.0;
      solver_->settings().compute_timings = false;
      solver_->setup(prepared.H, prepared.g, nullopt, nullopt, nullopt, nullopt, nullopt, zeros_,
                     nullopt);
    }
    const piqp::Status status = solver_->solve();
    m = solver_->result().x;
    return status == piqp::Status::PIQP_SOLVED;
  }

 private:
  Eigen::VectorXd zeros_;
  std::unique_ptr<piqp::DenseSolver<double>> solver_;
};

}  // namespace

void add_piqp(std::vector<PeerKind>& peers) {
  peers.push_back({"piqp", false, [] { return std::make_unique<Piqp>(); }});
}

}  // namespace shapeid::bench
