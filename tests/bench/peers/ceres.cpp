// Ceres: a trust region with bounds, for nonlinear problems; what many would reach for.
#include <ceres/ceres.h>

#include "shapeid/tests/bench/peers/mass_peer.hpp"

namespace shapeid::bench {
namespace {

/// A m - b with its constant Jacobian.
class Rows final : public ceres::CostFunction {
 public:
  explicit Rows(const Prepared& prepared) : prepared_(&prepared) {
    set_num_residuals(static_cast<int>(prepared.A.rows()));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(prepared.A.cols()));
  }

  bool Evaluate(double const* const* m, double* residuals, double** jacobians) const override {
    const Eigen::MatrixXd& A = prepared_->A;
    Eigen::Map<Eigen::VectorXd>(residuals, A.rows()) =
        A * Eigen::Map<const Eigen::VectorXd>(m[0], A.cols()) - prepared_->b;
    if (jacobians != nullptr && jacobians[0] != nullptr) {
      Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
          jacobians[0], A.rows(), A.cols()) = A;
    }
    return true;
  }

 private:
  const Prepared* prepared_;
};

class Ceres final : public MassPeer {
 public:
  [[nodiscard]] Form form() const override { return Form::rows; }

  bool solve(const DenseProblem&, const Prepared& prepared, const Eigen::VectorXd* warm,
             Eigen::VectorXd& m) override {
    const Eigen::Index n = prepared.A.cols();
    m = warm == nullptr ? Eigen::VectorXd(Eigen::VectorXd::Zero(n)) : *warm;
    ceres::Problem problem;
    problem.AddResidualBlock(new Rows(prepared), nullptr, m.data());  // owned by `problem`
    for (int j = 0; j < static_cast<int>(n); ++j) problem.SetParameterLowerBound(m.data(), j, 0.0);
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_QR;
    options.function_tolerance = options.gradient_tolerance = options.parameter_tolerance = 1e-15;
    options.max_num_iterations = 200;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    return summary.termination_type == ceres::CONVERGENCE;
  }
};

}  // namespace

void add_ceres(std::vector<PeerKind>& peers) {
  peers.push_back({"ceres", false, [] { return std::make_unique<Ceres>(); }, false, 60});
  peers.push_back({"ceres/warm", true, [] { return std::make_unique<Ceres>(); }, false, 60});
}

}  // namespace shapeid::bench
