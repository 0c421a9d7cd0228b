// The passive shapes of a single link at lambda = 0: the case that a robot solves every few
// milliseconds.
#pragma once

#include <Eigen/Core>

#include <array>

#include "shapeid/fast/passive_set.hpp"
#include "shapeid/fast/wide.hpp"

namespace shapeid::fast {

/// Keeps Q^T [R c] whole, with Q^T A = [T; 0] for the passive columns A: at ten rows that is
/// cheaper than keeping reflections. Of T only the inverse is kept: the target is then a sum of its
/// columns, which grows by one term when a shape enters, and nothing waits for a back substitution.
class OneLink final : public ColumnSet {
 public:
  /// `columns` must outlive the object.
  explicit OneLink(const ShapeColumns& columns);

  void start(const Eigen::MatrixXd& R) noexcept override;
  [[nodiscard]] bool enter(int j) noexcept override;
  void dependence(Eigen::VectorXd& coefficients) noexcept override;
  void leave(int place) noexcept override;
  void refine(const Eigen::VectorXd& slopes) noexcept override;
  void solve_normal(Eigen::VectorXd& x) noexcept override;
  [[nodiscard]] const Eigen::VectorXd& target() noexcept override { return target_; }
  [[nodiscard]] bool keeps_slopes() const noexcept override { return true; }
  [[nodiscard]] const Eigen::VectorXd& slopes(
      const Eigen::VectorXd& /*of_residual*/) noexcept override {
    return slopes_;
  }

 private:
  using Vector10 = Eigen::Matrix<double, 10, 1>;

  const ShapeColumns* columns_;
  int size_ = 0;
  std::array<int, 10> passive_{};
  std::array<Dozen, 10> rows_;     ///< Q^T [R c 0]
  std::array<Dozen, 10> inverse_;  ///< columns of the inverse of T
  Dozen refused_;                  ///< Q^T of the column refused last
  Eigen::VectorXd target_, slopes_, correction_;
};

}  // namespace shapeid::fast
