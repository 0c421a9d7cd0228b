// Linear: least squares with mass >= 0.
#include <Eigen/QR>

#include "shapeid/tests/experiments/methods/method.hpp"

namespace shapeid::experiments {
namespace {

class Linear final : public Method {
 public:
  Vector10 solve(const DataTerm& f) override {
    Vector10 Phi = f.free_optimum();
    if (Phi[0] < 0.0) {  // then the minimum lies where the mass is zero
      Phi[0] = 0.0;
      Phi.tail<9>() = f.R().rightCols<9>().householderQr().solve(f.c());
    }
    return Phi;
  }

  Answer answer(const DataTerm& f) override {
    const Vector10 Phi = solve(f);
    // The slope along the mass is the only entry that the dual cone allows, and not below zero.
    const double slope = Phi[0] > 0.0 ? 0.0 : f.gradient(Phi)[0];
    const double floor = f.dual(slope * Vector10::Unit(0));
    return {Phi, f.value(Phi), floor, true, 10};
  }
};

}  // namespace

std::unique_ptr<Method> make_linear() { return std::make_unique<Linear>(); }

}  // namespace shapeid::experiments
