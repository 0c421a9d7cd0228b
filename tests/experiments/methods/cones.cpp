// Full, and the set of Nonlinear, by the barrier method.
#include "shapeid/tests/experiments/methods/cone.hpp"
#include "shapeid/tests/experiments/methods/method.hpp"

namespace shapeid::experiments {
namespace {

class OverCone final : public Method {
 public:
  explicit OverCone(Cone cone) : cone_(std::move(cone)) {}

  Vector10 solve(const DataTerm& f) override { return least_over(cone_, f).Phi; }

  Answer answer(const DataTerm& f) override {
    const ConeOptimum best = least_over(cone_, f);
    return {best.Phi, best.value, best.floor, true, 10};
  }

 private:
  Cone cone_;
};

}  // namespace

std::unique_ptr<Method> make_positive(const Setting& setting) {
  return std::make_unique<OverCone>(positive_bodies(setting.length));
}

std::unique_ptr<Method> make_full(const Setting& setting) {
  return std::make_unique<OverCone>(consistent_bodies(setting.length));
}

}  // namespace shapeid::experiments
