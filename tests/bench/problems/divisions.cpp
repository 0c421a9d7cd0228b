#include "shapeid/tests/bench/problems/divisions.hpp"

#include <memory>
#include <stdexcept>

#include "shapeid/models/shapes_yaml.hpp"
#include "shapeid/reference/division.hpp"
#include "shapeid/reference/window.hpp"
#include "shapeid/tests/bench/peers/mass_peer.hpp"
#include "shapeid/tests/bench/problems/windows.hpp"

namespace shapeid::bench {
namespace {

constexpr std::size_t run_samples = 500;

/// Nothing known of the base but a box around its shapes.
BodyModel base_box() {
  const BodyModel shapes = base_shapes();
  Eigen::AlignedBox3d box;
  for (const SoughtShape& s : shapes.shapes) {
    const auto [lower, upper] = bounds(s.shape);
    box.extend(lower).extend(upper);
  }
  BodyModel model = load_region(quadruped(), 0, box.min(), box.max());
  model.known = shapes.known;
  return model;
}

/// Masses of one problem of a run after the other.
class Picker {
 public:
  explicit Picker(PickedBy by) {
    std::vector<PeerKind> kinds;
    if (by == PickedBy::ours) {
      add_fast(kinds);
      std::erase_if(kinds, [](const PeerKind& kind) { return !kind.warm; });
    } else {
      add_lawson_hanson(kinds);
    }
    solver_ = kinds.front().make();
  }

  const Eigen::VectorXd& masses(const DenseProblem& problem) {
    prepare(problem, Form::rows, prepared_);
    if (m_.size() > 0) carry_over(problem, m_, start_);
    if (!solver_->solve(problem, prepared_, m_.size() > 0 ? &start_ : nullptr, m_))
      throw std::runtime_error("a solver failed while a division run was recorded");
    return m_;
  }

 private:
  std::unique_ptr<MassPeer> solver_;
  Prepared prepared_;
  Eigen::VectorXd m_, start_;
};

}  // namespace

std::vector<DenseProblem> division_run(SeedSet seeds, std::uint64_t number, test::Noise noise,
                                       Density density, PickedBy picked_by, int shapes) {
  const std::uint64_t seed = seed_of(seeds, number);
  BodyModel model = base_box();
  reference::Window window(quadruped(), model, ContactTreatment::project,
                           Eigen::VectorXd::Ones(quadruped().dof()));
  for (const Sample& s : test::trot(quadruped(), some_truth(seed), seed, run_samples, noise))
    window.add(s);

  DivisionOptions options;
  // At lambda = 0 masses gather in at most ten parts. A reward for density would cut the same part
  // again and again.
  options.k2 = 0.0;
  options.expected_mass = stacked_parameters(quadruped())[0];  // the base's, as the file says
  Picker picker(picked_by);
  std::vector<DenseProblem> run;
  run.reserve(static_cast<std::size_t>(shapes));  // ours looks at a triangle as long as it divides
  run.push_back(compressed(window.problem(model), model, density));
  while (std::ssize(run) < shapes) {
    const DenseProblem& last = run.back();
    const Eigen::VectorXd m = picker.masses(last);
    Eigen::Index place =
        reference::next_to_divide(reference::division_criterion(model, m, options), options.tie);
    // Beyond some four hundred shapes all mass sits in parts that were cut as often as parts are
    // cut at all. The run goes on with the largest shape, for the sake of the number of columns.
    if (place < 0) shape_volumes(model).maxCoeff(&place);
    reference::Split split = reference::split_shape(model, last.triangle, m, place).value();
    DenseProblem next = {
        std::move(split.problem), last.R, {0, last.first.back() + 1}, true, std::nullopt};
    next.cut = Cut{place, next.triangle.V[place] / last.triangle.V[place]};
    model = std::move(split.model);
    run.push_back(std::move(next));
  }
  return run;
}

}  // namespace shapeid::bench
