#include "shapeid/tests/experiments/data/load_data.hpp"

#include "shapeid/models/shapes_yaml.hpp"
#include "shapeid/reference/row_filter.hpp"
#include "shapeid/reference/triangle.hpp"
#include "shapeid/reference/window.hpp"
#include "shapeid/tests/experiments/methods/mass_columns.hpp"

namespace shapeid::experiments {

DataTerm prepared(const test::Quadruped& quadruped, const BodyModel& model,
                  const std::vector<SimulatedSample>& motion, double seconds,
                  const Preparation& preparation) {
  const Robot& robot = quadruped.robot;
  const std::vector<Sample> samples = measured(
      quadruped, motion, seconds, {preparation.noise, preparation.signals, preparation.seed});
  if (preparation.rows == 0.0) return whole(robot, model, samples);
  reference::RowFilterOptions options;
  options.cutoff = preparation.rows;
  reference::RowFilter filter(robot, model, ContactTreatment::project,
                              Eigen::VectorXd::Ones(robot.dof()), options);
  reference::Window window(robot, model, ContactTreatment::project,
                           Eigen::VectorXd::Ones(robot.dof()));
  const auto take = [&] {
    while (const auto rows = filter.next()) window.add_rows(rows->Y, rows->F);
  };
  for (const Sample& sample : samples) {
    filter.push(sample);
    take();
  }
  filter.finish();
  take();
  const Eigen::MatrixXd Y = window.Y();
  Eigen::MatrixXd YF(Y.rows(), Y.cols() + 1);
  YF << Y, window.F();
  return DataTerm(reference::triangle(YF));
}

Robot with_identified_base(const test::Quadruped& quadruped, double seconds) {
  constexpr std::uint64_t another = 101;  // a seed that no load has
  const auto motion = simulated(quadruped.robot, {gaits().front(), seconds, another, {}});
  const DataTerm f = prepared(quadruped, quadruped.base, motion, seconds, {});
  Robot robot = quadruped.robot;
  robot.links[0].inertia = {MassColumns(quadruped.base).solve(f)};
  return robot;
}

BodyModel load_area(const Robot& robot) {
  constexpr double top = 0.058, height = 0.06;  // m: of the top plate, and of the space above it
  return load_region(robot, 0, {-0.2, -0.1, top}, {0.2, 0.1, top + height});
}

LoadError load_error(const Vector10& found, const InertialParameters& truth) {
  const InertialParameters body{found};
  const Eigen::Matrix3d I = truth.tensor_about_centre();
  return {std::abs(body.mass() - truth.mass()),
          (body.centre_of_mass() - truth.centre_of_mass()).norm(),
          (body.tensor_about_centre() - I).norm() / I.norm()};
}

}  // namespace shapeid::experiments
