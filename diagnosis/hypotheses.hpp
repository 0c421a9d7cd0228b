// What could be wrong: every effect at every place of a robot, and its columns.
#pragma once

#include <string>
#include <vector>

#include "shapeid/diagnosis/rich_model.hpp"

namespace shapeid::diagnosis {

/// "viscous_friction@knee"
[[nodiscard]] std::string hypothesis_id(const Robot& robot, const AppliedEffect& effect);

/// The unit of one of its numbers where it sits, from that in the catalogue, where joints turn.
[[nodiscard]] std::string unit_of(const Robot& robot, const AppliedEffect& effect,
                                  const std::string& unit);

/// All that the robot has sites for, each at its start. Payloads are left out (their columns are
/// the links' own), and what is sought before all others.
[[nodiscard]] std::vector<AppliedEffect> all_hypotheses(const Robot& robot);

/// Columns of hypotheses under a model: what each parameter adds to Y Phi + E theta - J^T f per
/// unit, at the model's present values. An effect's own columns, or central differences of its
/// transformation, in which f are the predicted contact forces, held fixed.
class HypothesisColumns {
 public:
  /// `robot` must outlive this.
  HypothesisColumns(const Robot& robot, RowSource source, const RichModel& model,
                    const std::vector<AppliedEffect>& hypotheses);

  [[nodiscard]] const Viewer& viewer() const { return viewer_; }
  /// Columns of one hypothesis after another: parameters of each.
  [[nodiscard]] Eigen::Index count() const { return count_; }
  [[nodiscard]] Eigen::Index first(std::size_t hypothesis) const { return first_[hypothesis]; }

  /// dof x count(). `view` and `predicted` are viewer()'s at this sample.
  [[nodiscard]] Eigen::MatrixXd at(const Recording& recording, std::size_t index, const View& view,
                                   const Prediction& predicted) const;

 private:
  struct Difference {
    Viewer plus, minus;
    double step;  ///< from minus to plus
  };
  [[nodiscard]] Eigen::VectorXd difference(const AppliedEffect& hypothesis, const Difference& d,
                                           const Recording& recording, std::size_t index,
                                           const View& view, const Prediction& predicted) const;

  RichModel model_;
  std::vector<AppliedEffect> hypotheses_;
  Viewer viewer_;
  std::vector<Eigen::Index> first_;
  Eigen::Index count_ = 0;
  std::vector<std::vector<Difference>> differences_;  ///< a hypothesis, a parameter
};

}  // namespace shapeid::diagnosis
