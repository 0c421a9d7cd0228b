// Ours, divided until the gap to the floor of infinitely many divisions closes.
#include <algorithm>
#include <stdexcept>

#include "shapeid/fast/division.hpp"
#include "shapeid/tests/experiments/methods/division_floor.hpp"
#include "shapeid/tests/experiments/methods/mass_columns.hpp"
#include "shapeid/tests/experiments/methods/method.hpp"

namespace shapeid::experiments {
namespace {

class Divided final : public Method {
 public:
  Divided(const Setting& setting, double closed, int most)
      : regions_(setting.shapes), closed_(closed) {
    options_.k2 = 0.0;  // docs/derivations/division.md: dense shapes first stops short of the floor
    options_.most_divisions = most;
    options_.expected_mass = setting.expected_mass;
  }

  Vector10 solve(const DataTerm& f) override { return answer(f).Phi; }

  Answer answer(const DataTerm& f) override {
    const double floor = limit_of_divisions(regions_, f, 0.1 * closed_).floor;
    const double enough = floor + std::max(closed_ * floor, nothing_beside_data * f.size());
    const Eigen::MatrixXd R = triangle_of(f);
    fast::Division division(regions_, options_);
    if (division.start(R) != fast::Outcome::solved) throw std::runtime_error("window declined");
    bool stuck = false;
    while (division.masses().value().data > enough && !stuck) {
      stuck = division.divide() != fast::Division::Step::divided;
    }
    const Vector10 Phi = division.masses().Phi();
    return {Phi, f.value(Phi), floor, !stuck, division.masses().shapes()};
  }

 private:
  BodyModel regions_;
  double closed_;
  DivisionOptions options_;
};

}  // namespace

std::unique_ptr<Method> make_divided(const Setting& setting, double closed, int most) {
  return std::make_unique<Divided>(setting, closed, most);
}

}  // namespace shapeid::experiments
