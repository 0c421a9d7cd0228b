// Claims C4, C5. Equation (16) and Algorithm 1 at the pace of the robot.
#pragma once

#include <Eigen/Core>

#include <optional>
#include <string>
#include <vector>

#include "shapeid/fast/mass_solver.hpp"
#include "shapeid/fast/part_tree.hpp"
#include "shapeid/models/body_model.hpp"
#include "shapeid/models/division.hpp"

namespace shapeid::fast {

/// What `reference::divide_and_solve` does, on the triangle of a window: solves for the masses of
/// the model's shapes, then divides the shape of the largest v and solves again, warm-started. The
/// same shapes are divided in the same order, unless two v are nearer to each other than the
/// solvers' rounding (docs/benchmarks.md counts how often).
///
/// Nothing throws after construction, and nothing allocates but id() and a cut of a polyhedron
/// whose parts are not kept from an earlier one (see PartTree).
class Division {
 public:
  /// Copies what it needs of the model. Throws std::invalid_argument for options that make no
  /// sense.
  Division(const BodyModel& model, const DivisionOptions& options);

  /// lambda >= 0.
  void set_lambda(double lambda) noexcept { solver_.set_lambda(lambda); }

  enum class Start { last_masses, no_masses };
  /// Solves for the undivided shapes, from the masses that they had at the last start() or from
  /// none. If the solver declines, the undivided shapes are left with those masses. R is not
  /// copied: it must live, and stay as it is, until the last divide() after it.
  Outcome start(const Eigen::MatrixXd& R, Start from = Start::last_masses) noexcept;

  enum class Step {
    divided,
    nothing_divisible,  ///< no divisible shape carries mass
    no_room,            ///< options.most_divisions are done
    declined            ///< divided at equal density, with Phi and f as before: masses not solved
  };

  /// Divides the shape of the largest v, or the `at_once` shapes of the largest v, and solves once.
  /// The triangle of start() must still be there, and start() have solved it.
  Step divide(int at_once = 1) noexcept;

  enum class Stop { step, limit, nothing_divisible, declined };

  /// Divides one by one until the options say stop. With a floor (of the data term, however finely
  /// the shapes are divided) small steps end the run where they do in divide_and_solve().
  Stop run(std::optional<double> floor = std::nullopt) noexcept;

  struct Cut {
    int place;         ///< of the shape that was cut; its second part is the last shape
    double criterion;  ///< its v
    double objective_before, objective_after;
    Eigen::Vector3d step;  ///< as in DivisionStep; zero but for the last of several cuts at once
    int iterations;        ///< likewise
  };

  [[nodiscard]] const MassSolver& masses() const noexcept { return solver_; }
  /// kg, of the model's shapes at the last start() that was solved.
  [[nodiscard]] const Eigen::VectorXd& undivided_masses() const noexcept { return undivided_; }
  /// Since the last start().
  [[nodiscard]] const std::vector<Cut>& history() const noexcept { return history_; }
  /// "3", "3.0", "3.0.1": the model's id, then the way down the divisions. Allocates.
  [[nodiscard]] std::string id(int place) const;

 private:
  struct Candidate {
    int place;
    double v;
  };

  void collect_candidates() noexcept;
  [[nodiscard]] Candidate take_largest() noexcept;

  DivisionOptions options_;
  PartTree tree_;
  std::vector<int> links_;        ///< of the model's shapes, places among the free links
  std::vector<std::string> ids_;  ///< of the model's shapes
  Eigen::VectorXd undivided_;     ///< masses at the last start()
  double whole_volume_ = 0.0;
  MassSolver solver_;
  std::vector<int> parts_;  ///< which part stands at each place
  std::vector<Candidate> candidates_;
  std::vector<Cut> history_;
  Eigen::VectorXd last_Phi_;
  double undivided_objective_ = 0.0;  ///< at the last start()
};

}  // namespace shapeid::fast
