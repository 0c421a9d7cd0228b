// Points and Ours: masses >= 0 of given shapes.
#include "shapeid/tests/experiments/methods/mass_columns.hpp"
#include "shapeid/tests/experiments/methods/method.hpp"

namespace shapeid::experiments {
namespace {

class Shapes final : public Method {
 public:
  explicit Shapes(const BodyModel& model) : columns_(model) {}

  Vector10 solve(const DataTerm& f) override { return columns_.solve(f); }

  Answer answer(const DataTerm& f) override {
    const Vector10 Phi = solve(f);
    return {Phi, f.value(Phi), columns_.floor(f, Phi), true, columns_.size()};
  }

 private:
  MassColumns columns_;
};

}  // namespace

std::unique_ptr<Method> make_shapes(const BodyModel& model) {
  return std::make_unique<Shapes>(model);
}

}  // namespace shapeid::experiments
