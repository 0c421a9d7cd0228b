// Nonlinear as published, and Full by log-Cholesky parameters: a smooth map onto the inside of the
// set, and a general nonlinear solver.
#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>

#include "shapeid/tests/experiments/methods/cone.hpp"
#include "shapeid/tests/experiments/methods/method.hpp"

namespace shapeid::experiments {
namespace {

template <typename T>
using Three = Eigen::Matrix<T, 3, 3>;

/// The six entries of a symmetric matrix in the order of the tensor.
template <typename T>
void put_tensor(const Three<T>& I, T* Phi) {
  Phi[4] = I(0, 0);
  Phi[5] = I(0, 1);
  Phi[6] = I(0, 2);
  Phi[7] = I(1, 1);
  Phi[8] = I(1, 2);
  Phi[9] = I(2, 2);
}

/// Mass e^x, centre of mass, and I_C = L L^T about it with e^x on the diagonal of L.
struct MassCentreTensor {
  template <typename T>
  static void map(const T* x, T* Phi) {
    const T m = exp(x[0]);
    const Eigen::Matrix<T, 3, 1> c(x[1], x[2], x[3]);
    Three<T> L = Three<T>::Zero();
    L(0, 0) = exp(x[4]);
    L(1, 0) = x[5];
    L(1, 1) = exp(x[6]);
    L(2, 0) = x[7];
    L(2, 1) = x[8];
    L(2, 2) = exp(x[9]);
    Phi[0] = m;
    for (int i = 0; i < 3; ++i) Phi[1 + i] = m * c[i];
    const Three<T> apart = Three<T>::Identity() * c.squaredNorm() - c * c.transpose();
    put_tensor(Three<T>(L * L.transpose() + m * apart), Phi);
  }

  static Vector10 start(double mass) {
    Vector10 x = Vector10::Zero();  // a ball of radius one about the origin: I_C = 2/5 m
    x[0] = std::log(mass);
    x[4] = x[6] = x[9] = 0.5 * std::log(0.4 * mass);
    return x;
  }
};

/// Sigma = e^(2 a) U U^T (Rucker and Wensing 2022), U upper triangular with e^d on its diagonal.
struct LogCholesky {
  template <typename T>
  static void map(const T* x, T* Phi) {
    using Four = Eigen::Matrix<T, 4, 4>;
    Four U = Four::Zero();
    U(0, 0) = exp(x[1]);
    U(1, 1) = exp(x[2]);
    U(2, 2) = exp(x[3]);
    U(3, 3) = T(1.0);
    U(0, 1) = x[4];
    U(1, 2) = x[5];
    U(0, 2) = x[6];
    for (int i = 0; i < 3; ++i) U(i, 3) = x[7 + i];
    const Four sigma = exp(T(2.0) * x[0]) * U * U.transpose();
    const Three<T> second = sigma.template topLeftCorner<3, 3>();
    Phi[0] = sigma(3, 3);
    for (int i = 0; i < 3; ++i) Phi[1 + i] = sigma(i, 3);
    put_tensor(Three<T>(Three<T>::Identity() * second.trace() - second), Phi);
  }

  static Vector10 start(double mass) {
    Vector10 x = Vector10::Zero();
    x[0] = 0.5 * std::log(mass);
    x[1] = x[2] = x[3] = 0.5 * std::log(0.2);  // the same ball: covariance 1/5
    return x;
  }
};

/// Lengths in units of the body's size, so that all ten unknowns have one scale.
Vector10 units(double length) {
  Vector10 u;
  u[0] = 1.0;
  u.segment<3>(1).setConstant(length);
  u.tail<6>().setConstant(length * length);
  return u;
}

template <typename Map>
struct Residual {
  Matrix10 R;  ///< times the units
  Vector10 c;

  template <typename T>
  bool operator()(const T* x, T* residual) const {
    Eigen::Matrix<T, 10, 1> Phi;
    Map::map(x, Phi.data());
    Eigen::Map<Eigen::Matrix<T, 10, 1>> r(residual, 10);
    r = R.template cast<T>() * Phi - c.template cast<T>();
    // A step so long that e^x overflows is one that Ceres should take back.
    using std::isfinite;  // of double; that of a Jet is found beside it
    return std::all_of(r.begin(), r.end(), [](const T& entry) { return isfinite(entry); });
  }
};

template <typename Map>
class Smooth final : public Method {
 public:
  Smooth(Cone cone, const Setting& setting, Effort effort)
      : cone_(std::move(cone)), setting_(setting) {
    options_.linear_solver_type = ceres::DENSE_QR;
    options_.logging_type = ceres::SILENT;
    if (effort == Effort::hard) {
      options_.max_num_iterations = 200;
      options_.function_tolerance = 1e-14;
      options_.gradient_tolerance = 1e-14;
      options_.parameter_tolerance = 1e-14;
    }
  }

  Vector10 solve(const DataTerm& f) override {
    const Vector10 u = units(setting_.length);
    Vector10 x = Map::start(setting_.expected_mass);
    ceres::Problem problem;
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<Residual<Map>, 10, 10>(
                                 new Residual<Map>{f.R() * u.asDiagonal(), f.c()}),
                             nullptr, x.data());  // owned by `problem`
    ceres::Solve(options_, &problem, &summary_);
    Vector10 Phi;
    Map::map(x.data(), Phi.data());
    return u.cwiseProduct(Phi);
  }

  Answer answer(const DataTerm& f) override {
    const Vector10 Phi = solve(f);
    return {Phi, f.value(Phi), least_over(cone_, f).floor,
            summary_.termination_type == ceres::CONVERGENCE, 10};
  }

 private:
  Cone cone_;
  Setting setting_;
  ceres::Solver::Options options_;
  ceres::Solver::Summary summary_;
};

}  // namespace

std::unique_ptr<Method> make_nonlinear(const Setting& setting, Effort effort) {
  return std::make_unique<Smooth<MassCentreTensor>>(positive_bodies(setting.length), setting,
                                                    effort);
}

std::unique_ptr<Method> make_log_cholesky(const Setting& setting, Effort effort) {
  return std::make_unique<Smooth<LogCholesky>>(consistent_bodies(setting.length), setting, effort);
}

}  // namespace shapeid::experiments
