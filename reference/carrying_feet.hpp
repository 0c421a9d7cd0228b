// What the joints' torques say of feet that are declared in the air.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "shapeid/models/mean.hpp"
#include "shapeid/models/robot.hpp"
#include "shapeid/models/sample.hpp"

namespace shapeid::reference {

/// A foot that is declared in the air for longer than any swing, and whose leg's torques ask for as
/// much of a force as those of feet that are declared to stand (supporting_forces(), by the given
/// links; the base is in none of these rows), has a dead flag. It must be so with legs that weigh
/// nothing, too: given masses may be placeholders. A leg that is so straight that a
/// torque makes twice the force that it makes of those which stand says nothing: friction and an
/// offset of its torque would look like a force. Contacts of one link are one foot.
/// Sums alone are kept. The robot must outlive this.
class CarryingFeet {
 public:
  explicit CarryingFeet(const Robot& robot);

  /// In the order of time; another log may begin at any.
  void add(const Sample& sample);

  /// Throws Refusal "contact-labels" if there is such a foot.
  void judge();

 private:
  /// A foot in the air.
  struct Stretch {
    double begin = 0.0, end = 0.0;  ///< s
    Mean force, of_torques;         ///< N, once it is longer than a swing
    /// What can be believed of it.
    [[nodiscard]] double least() const { return std::min(force.value(), of_torques.value()); }
    [[nodiscard]] double seconds() const { return end - begin; }
  };
  struct Foot {
    int link = 0;
    std::vector<std::size_t> contacts;
    bool in_the_air = false;
    Stretch now, strongest;
  };

  /// Of a contact's row of forces, or of what torques make of these, the foot's.
  [[nodiscard]] static Eigen::RowVectorXd on(const Foot& foot, const Eigen::MatrixXd& contacts);
  [[nodiscard]] static bool stands(const Foot& foot, const Sample& sample);
  static void land(Foot& foot);
  [[nodiscard]] std::string names(const Foot& foot) const;

  const Robot* robot_;
  Eigen::VectorXd Phi_;
  std::vector<Foot> feet_;
  Mean standing_;    ///< N
  Mean per_torque_;  ///< of feet that stand: N that an N m, or N, at a joint makes
  bool begun_ = false;
  double last_ = 0.0, looked_at_ = 0.0;  ///< s
};

}  // namespace shapeid::reference
