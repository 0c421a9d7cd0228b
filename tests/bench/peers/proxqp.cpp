// ProxQP's dense solver with box constraints (ProxSuite; header-only, vectorisation by hand off).
#include <proxsuite/proxqp/dense/dense.hpp>

#include <limits>

#include "shapeid/tests/bench/peers/mass_peer.hpp"

namespace shapeid::bench {
namespace {

/// Of the primal and dual residual: the loosest power of ten that kept objectives within the
/// tables' bound on the tuning seeds.
constexpr double accuracy = 1e-9;

/// Where it converges it needs a dozen; where H is singular it may never, and its own limit (10000)
/// would take minutes.
constexpr proxsuite::proxqp::isize most_iterations = 20;

class ProxQp final : public MassPeer {
 public:
  [[nodiscard]] Form form() const override { return Form::normal; }

  bool solve(const DenseProblem&, const Prepared& prepared, const Eigen::VectorXd* warm,
             Eigen::VectorXd& m) override {
    using proxsuite::nullopt;
    const Eigen::Index n = prepared.H.cols();
    const bool resized = resize(n);
    solver_->settings.initial_guess =
        warm == nullptr ? proxsuite::proxqp::InitialGuessStatus::NO_INITIAL_GUESS
        : resized       ? proxsuite::proxqp::InitialGuessStatus::WARM_START
                        : proxsuite::proxqp::InitialGuessStatus::WARM_START_WITH_PREVIOUS_RESULT;
    if (resized) {
      solver_->init(prepared.H, prepared.g, nullopt, nullopt, nullopt, nullopt, nullopt, zeros_,
                    unbounded_);
    } else {
      solver_->update(prepared.H, prepared.g, nullopt, nullopt, nullopt, nullopt, nullopt, zeros_,
                      unbounded_);
    }
    if (warm != nullptr && resized) {
      solver_->solve(*warm, nullopt, nullopt);
    } else {
      solver_->solve();
    }
    m = solver_->results.x;
    return solver_->results.info.status == proxsuite::proxqp::QPSolverOutput::PROXQP_SOLVED;
  }

 private:
  bool resize(Eigen::Index n) {
    if (zeros_.size() == n) return false;
    zeros_ = Eigen::VectorXd::Zero(n);
    unbounded_ = Eigen::VectorXd::Constant(n, std::numeric_limits<double>::infinity());
    solver_ = std::make_unique<proxsuite::proxqp::dense::QP<double>>(n, 0, 0, true);
    solver_->settings.eps_abs = accuracy;
    solver_->settings.eps_rel = 0.0;
    solver_->settings.max_iter = most_iterations;
    solver_->settings.max_iter_in = most_iterations;
    return true;
  }

  Eigen::VectorXd zeros_, unbounded_;
  std::unique_ptr<proxsuite::proxqp::dense::QP<double>> solver_;
};

}  // namespace

void add_proxqp(std::vector<PeerKind>& peers) {
  peers.push_back({"proxqp", false, [] { return std::make_unique<ProxQp>(); }});
  peers.push_back({"proxqp/warm", true, [] { return std::make_unique<ProxQp>(); }});
}

}  // namespace shapeid::bench
