// The passive shapes of several links at lambda = 0.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <span>
#include <vector>

#include "shapeid/fast/column_qr.hpp"
#include "shapeid/fast/passive_set.hpp"

namespace shapeid::fast {

/// A QR decomposition of the passive columns a_j = R u_j, of which those of the first links are
/// short: R is a triangle, so a column ends with the ten rows of its link.
class ManyLinks final : public ColumnSet {
 public:
  /// `columns` must outlive the object.
  explicit ManyLinks(const ShapeColumns& columns);

  void start(const Eigen::MatrixXd& R) noexcept override;
  [[nodiscard]] bool enter(int j) noexcept override;
  /// Factorised together.
  [[nodiscard]] std::size_t enter_first(std::span<const int> shapes) noexcept override;
  void dependence(Eigen::VectorXd& coefficients) noexcept override;
  void leave(int place) noexcept override;
  void refine(const Eigen::VectorXd& slopes) noexcept override;
  void solve_normal(Eigen::VectorXd& x) noexcept override { qr_.solve_normal(x); }
  [[nodiscard]] bool sound() const noexcept override { return sound_; }
  [[nodiscard]] const Eigen::VectorXd& target() noexcept override;
  [[nodiscard]] const Eigen::VectorXd& slopes(
      const Eigen::VectorXd& of_residual) noexcept override {
    return of_residual;
  }

 private:
  [[nodiscard]] Eigen::Index write(int j, Eigen::Index k) noexcept;
  ColumnQr::Push push(int j) noexcept;
  [[nodiscard]] std::size_t push_all(std::span<const int> shapes) noexcept;
  void rebuild() noexcept;

  const ShapeColumns* columns_;
  const Eigen::MatrixXd* R_ = nullptr;
  ColumnQr qr_;
  std::vector<int> passive_;
  std::vector<Eigen::Index> ends_;  ///< of columns that enter together
  bool sound_ = true;
  bool solved_ = false;  ///< target_ is that of the passive shapes
  Eigen::VectorXd target_, correction_;
};

}  // namespace shapeid::fast
