// The method as it runs on the robot: samples in, parameters out. The thing to embed in a
// controller.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <optional>

#include "shapeid/fast/division.hpp"
#include "shapeid/fast/sliding_triangle.hpp"
#include "shapeid/fast/window.hpp"
#include "shapeid/models/body_model.hpp"
#include "shapeid/models/contact_treatment.hpp"
#include "shapeid/models/division.hpp"
#include "shapeid/models/robot.hpp"
#include "shapeid/models/sample.hpp"

namespace shapeid::fast {

struct IdentifierSettings {
  ContactTreatment contacts = ContactTreatment::project;
  /// Diagonal of W, generalised order, within twelve decades; empty: ones.
  Eigen::VectorXd weight = {};
  std::size_t window = 10;     ///< samples a window
  std::size_t stride = 10;     ///< samples from one window to the next: 10 at 500 Hz is 20 ms
  double alpha = 0.5;          ///< equation (17), in (0, 1]
  double expected_mass = 0.0;  ///< M0, kg, of all free shapes together: 1e-6 to 1e6
  /// Default: computed from each window until one's forces are a thousandth of the weight of all
  /// links (squares_of_weight()), then fixed.
  std::optional<double> lambda = {};
  std::optional<double> mass_bound = {};  ///< kg, for the gap; default: ten times M0
  /// Windows start at the masses of the one before. If not, an answer depends on its window alone,
  /// to the last bit: what a restart in the middle of a stream needs.
  bool warm = true;
  /// Divisions in every window. Its expected_mass is the one above.
  DivisionOptions division{.most_divisions = 0};
};

/// One window's answer, besides masses and parameters; times are of the last window that was
/// complete, answered or declined.
struct WindowAnswer {
  double time = 0.0;  ///< s, of the window's last sample
  Objective value;    ///< f of the present shapes, before the filter
  /// f is at most this much above its minimum over the present shapes, if the masses there add up
  /// to no more than the mass bound.
  double gap = 0.0;
  int iterations = 0;  ///< small systems, of all divisions together
  int divisions = 0;
  Division::Stop stopped_by = Division::Stop::limit;  ///< what ended the divisions
  double seconds = 0.0;  ///< of all calls that took a sample since the last window, its solve
                         ///< and divisions
  double slowest_sample = 0.0;  ///< s, of the calls that only kept a sample
  double last_call = 0.0;       ///< s, of the call that completed the window
};

/// What `reference::OnlineIdentifier` does, on compressed windows. After construction nothing
/// throws, nothing allocates but the division of polyhedra (PartTree), and the work of a call is
/// bounded. Torques are those of the links: what rotors take is taken off before (rotor_inertias()
/// times ddq), as a log's reader does. Can be neither copied nor moved. A division by zero may
/// happen in it and be put right: traps of floating-point must be off. Unlike there, a window is
/// declined whose forces and torques are, as a root mean square, beyond a hundred times the weight
/// of all links (torques: at a metre): it would leave its scale to lambda.
class Identifier {
 public:
  /// Copies what it needs. Throws InputError for settings that make no sense, for a malformed
  /// robot, and for a model that is not this robot's.
  Identifier(const Robot& robot, const BodyModel& model, const IdentifierSettings& settings);

  enum class Fed {
    kept,             ///< no window is complete yet
    answered,         ///< a window was solved: answer(), masses(), Phi() and filtered() are new
    sample_declined,  ///< sizes are not the robot's, a number is not finite or a square that
                      ///< follows from it is not, or forces are missing: as if not fed
    window_declined   ///< not solved, see outcome(): the last answer stays; ask the reference
  };

  /// Takes a sample; every `stride` samples, once `window` are there, solves.
  Fed feed(const Sample& sample) noexcept;

  /// As if no sample had been fed so far: for when the next does not follow the last. The last
  /// answer, lambda, filter (17) and the masses to start at stay.
  void forget_samples() noexcept;

  /// The compressed rows of the last window that was complete; until the next feed.
  [[nodiscard]] const Triangle& window() const noexcept { return last_window_; }
  /// Of the last window that was answered.
  [[nodiscard]] const WindowAnswer& answer() const noexcept { return answer_; }
  /// kg, one a shape of the model, before any division.
  [[nodiscard]] const Eigen::VectorXd& undivided_masses() const noexcept {
    return division_.undivided_masses();
  }
  /// Parameters of the free links, 10 each, before filter (17).
  [[nodiscard]] const Eigen::VectorXd& Phi() const noexcept { return Phi_; }
  /// Phi_bar of the free links (17). It does not minimise any single window's objective.
  [[nodiscard]] const Eigen::VectorXd& filtered() const noexcept { return filtered_; }
  /// How the last window's solve ended.
  [[nodiscard]] Outcome outcome() const noexcept { return outcome_; }
  /// lambda in use; empty until it is fixed.
  [[nodiscard]] std::optional<double> lambda() const noexcept { return lambda_; }
  /// The divided shapes of the last window.
  [[nodiscard]] const Division& division() const noexcept { return division_; }
  /// Since construction.
  [[nodiscard]] std::size_t samples_by_six_rows() const noexcept {
    return by_six_rows_ + rows_.samples_by_six_rows();
  }

  /// All that is remembered, for a checkpoint; with settings.warm the last masses are not, and the
  /// next window starts cold.
  template <class Archive>
  void state(Archive& archive) {
    archive("lambda", lambda_);
    archive("rows", rows_);
    archive("sliding", sliding_);
    archive("in_block", in_block_);
    archive("in_window", in_window_);
    archive("since_last", since_last_);
    archive("by_six_rows", by_six_rows_);
    archive("has_answer", has_answer_);
    archive("Phi", Phi_);
    archive("filtered", filtered_);
  }

 private:
  [[nodiscard]] bool solve(const Eigen::MatrixXd& R) noexcept;

  int joints_;
  std::size_t contacts_;
  Division division_;
  std::size_t block_, window_, stride_;  ///< samples
  bool warm_, has_answer_ = false;
  Outcome outcome_ = Outcome::solved;
  double alpha_, expected_mass_, mass_bound_;
  std::optional<double> lambda_;
  double squares_of_weight_;  ///< of || b ||^2
  double volume_ = 0.0;
  Window rows_;                             ///< of the present block
  std::optional<SlidingTriangle> sliding_;  ///< the last blocks, if windows overlap
  Triangle last_window_;
  std::size_t in_block_ = 0, in_window_ = 0, since_last_ = 0;
  std::size_t by_six_rows_ = 0;  ///< samples of earlier blocks
  WindowAnswer answer_;
  double spent_ = 0.0, slowest_ = 0.0;
  Eigen::VectorXd Phi_, filtered_;
};

}  // namespace shapeid::fast
