// Rigid links with effects, and what this model says about one sample.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <vector>

#include "shapeid/diagnosis/curve.hpp"
#include "shapeid/diagnosis/effect.hpp"
#include "shapeid/diagnosis/recording.hpp"
#include "shapeid/diagnosis/rigid_rows.hpp"
#include "shapeid/reference/sample_rows.hpp"

namespace shapeid::diagnosis {

/// The start of the search: shape numbers at their start, values zero.
[[nodiscard]] AppliedEffect at_start(const Effect& effect, int site);

struct RichModel {
  Eigen::VectorXd Phi;  ///< 10 per link of the robot
  std::vector<AppliedEffect> effects;
  std::vector<Curve> curves = {};  ///< added to what the others predict
  /// As the reference log has it, and not the log.
  bool earlier = false;
  [[nodiscard]] RichModel in_reference() const;
  [[nodiscard]] bool has_acting(const AppliedEffect& a) const {
    return earlier ? a.acts_in_reference() : a.acts_in_log();
  }
  /// Those of the effects that act.
  [[nodiscard]] std::vector<AppliedEffect> acting() const;
};

/// What the load is predicted from, a little earlier or later than a view.
struct Neighbour {
  Eigen::VectorXd applied;  ///< S^T tau, dof
  Eigen::MatrixXd Y, J;     ///< as in View, with the contacts of the view
  Eigen::VectorXd carried;  ///< likewise
};

/// A sample as the model sees it: transformations done.
struct Scene {
  Sample sample;
  std::vector<reference::LinkMotion> motions;
  Eigen::MatrixXd J;  ///< contact rows x dof, before Transformation::rows
  /// J^T f of measured contact forces, dof, likewise; zero where they are not used. It is on the
  /// side of the prediction: a gain scales what the joints need not provide as well.
  Eigen::VectorXd carried;
  Surroundings surroundings;
};

/// With all that rows are made of.
struct View : Scene {
  Eigen::MatrixXd Y;           ///< dof x (10 per link), before Transformation::rows
  Eigen::VectorXd correction;  ///< Recording::correction()
  /// The begin and the end of each of Viewer::load_rates(); empty of a sample without a log.
  std::vector<Neighbour> around;
};

/// s to either side over which the load's rate is a central difference. A predicted load has the
/// position's second derivative in it, its rate the third, whose noise is largest just below the
/// filter's cutoff: 20 ms take half of what is at 15 Hz, and 2 % of 3 Hz. Loads of legs change
/// faster than that.
[[nodiscard]] inline double neighbour_step(const Robot& robot) {
  return robot.root == Root::fixed ? 0.02 : 0.002;
}

/// A span of time over which the load's rate is taken.
struct LoadRate {
  int joint;          ///< all_joints: for which there is no other
  double begin, end;  ///< s from now
  static constexpr int all_joints = -1;
  [[nodiscard]] double span() const { return end - begin; }
};

/// Of each joint whose load some of the effects filter, not to first order alone: over sqrt(3) time
/// constants to either side of one of them ago, with which they have the filter's response to third
/// order, but over neighbour_step() at least, and not further back than `reach` (s). Of two effects
/// of one joint (one came since a reference log) the time constants add up.
[[nodiscard]] std::vector<LoadRate> slopes_of_filters(const Robot& robot,
                                                      const std::vector<AppliedEffect>& effects,
                                                      double reach);

/// For what filters the load among some effects, and what may be tried beside them: the rate of now
/// for this and those that are to first order, and a slope for each of the others.
[[nodiscard]] std::vector<LoadRate> load_rates(const Robot& robot,
                                               const std::vector<AppliedEffect>& effects,
                                               const std::vector<AppliedEffect>& tried);

/// Whether some of them look at Instant::load_rate.
[[nodiscard]] bool needs_load_rate(const std::vector<AppliedEffect>& effects);

/// Prepares views of a robot with the transformations among some effects, and with neighbours for
/// load_rates(). The robot must outlive this. Not for several threads at once.
class Viewer {
 public:
  Viewer(const Robot& robot, RowSource source, const std::vector<AppliedEffect>& effects,
         const std::vector<AppliedEffect>& tried = {});

  [[nodiscard]] View view(const Recording& recording, std::size_t index) const;
  /// Of a sample whose own transformations are done already (moved()).
  [[nodiscard]] View view(Sample moved, Surroundings surroundings) const;
  [[nodiscard]] Scene scene(Sample moved, Surroundings surroundings) const;
  /// Y Phi of a scene, dof: what the rigid links take, before Transformation::rows.
  [[nodiscard]] Eigen::VectorXd links(const Scene& scene, const Eigen::VectorXd& Phi) const;
  /// Applies the row transformations, in order but for those that scale, which come last.
  void transform(const Scene& scene, Rows& rows) const;
  [[nodiscard]] const Robot& robot() const { return robot_; }
  [[nodiscard]] const RowSource& source() const { return source_; }
  [[nodiscard]] const std::vector<LoadRate>& load_rates() const { return load_rates_; }
  /// The sample after all sample transformations.
  [[nodiscard]] Sample moved(const Recording& recording, std::size_t index) const;

 private:
  /// The sample dt later after the first `count` of the transformations.
  [[nodiscard]] Sample moved(const Recording& recording, std::size_t index, double dt,
                             std::size_t count) const;

  Robot robot_;
  RowSource source_;
  mutable std::optional<RigidRows> rows_;  ///< of robot_, once it is transformed
  std::vector<AppliedEffect> transforming_;
  std::vector<LoadRate> load_rates_;
};

/// Refers to all that it is given.
[[nodiscard]] Instant instant_of(const Viewer& viewer, const Scene& scene,
                                 const PredictedLoad& load);

/// Y Phi + E theta and J with all transformations done: the model's rows before any projection.
struct Prediction {
  Eigen::VectorXd force;  ///< dof: what joints must provide, and contacts of no measured force
  Eigen::MatrixXd J;      ///< contact rows x dof
  Eigen::VectorXd links;  ///< Viewer::links()
  PredictedLoad load;     ///< of the rigid links
};
[[nodiscard]] Prediction predict(const Viewer& viewer, const View& view, const RichModel& model);
/// The same with `links` (Viewer::links()) and the load given.
[[nodiscard]] Prediction predict(const Viewer& viewer, const Scene& scene, Eigen::VectorXd links,
                                 const RichModel& model, const PredictedLoad& load);

/// Rows of the mass problem for the links that are sought, with everything else that the model
/// knows (other links, effects) moved over: what reference::sample_rows() says of rigid links.
[[nodiscard]] reference::SampleRows mass_rows(const Viewer& viewer, const View& view,
                                              const RichModel& model,
                                              const std::vector<int>& free_links);

/// Which of the dof rows count, in fits and in errors. Dry friction holds a joint that stands still
/// against any torque up to where it breaks away, and no model of motion says which: on a fixed
/// base without contacts these joints' rows are left out. With contacts the projection mixes all
/// rows, and all count. Claim C17.
[[nodiscard]] Eigen::Array<bool, Eigen::Dynamic, 1> counted_rows(const Viewer& viewer,
                                                                 const Recording& recording,
                                                                 std::size_t index,
                                                                 const View& view);

/// S^T tau as logged, plus the correction if there is one, dof.
[[nodiscard]] Eigen::VectorXd logged_force(const Viewer& viewer, const View& view);

/// The columns of `force` (dof) after the part that contact forces can explain is taken out:
/// P = I - J^T (J^T)^+.
[[nodiscard]] Eigen::MatrixXd beyond_contacts(const Viewer& viewer, const Eigen::MatrixXd& J,
                                              const Eigen::MatrixXd& force);

/// Predicted minus logged, beyond what contact forces can explain, dof: the yardstick.
[[nodiscard]] Eigen::VectorXd residual(const Viewer& viewer, const View& view,
                                       const RichModel& model);

}  // namespace shapeid::diagnosis
