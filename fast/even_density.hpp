// The passive shapes at lambda > 0, however many of them share a link.
#pragma once

#include <Eigen/Core>

#include <vector>

#include "shapeid/fast/column_qr.hpp"
#include "shapeid/fast/damped_ten.hpp"
#include "shapeid/fast/link_density.hpp"
#include "shapeid/fast/passive_set.hpp"

namespace shapeid::fast {

/// With lambda > 0 any number of shapes of a link can be passive, and their columns depend on each
/// other. Where the passive shapes of a link alone minimise f, their density m_j / V_j is u_j . w,
/// with ten numbers w for the link (docs/derivations/fast-masses.md). So the unknowns are ten a
/// link, not one a shape: with X the rows sqrt(V_j) u_j^T of the passive shapes of a link and X = Q
/// T its rank-revealing QR, Phi = T^T y and the density term is lambda || y ||^2. The y of all
/// links solve one damped least-squares problem, of at most ten unknowns a link.
class EvenDensity final : public PassiveSet {
 public:
  /// `columns` and `V` (m^3, an entry a shape) must outlive the object. Columns know their scale on
  /// the rows before refine().
  EvenDensity(const ShapeColumns& columns, const Eigen::VectorXd& V);

  /// Takes effect with the next target(). Positive.
  void set_lambda(double lambda) noexcept;

  void start(const Eigen::MatrixXd& R) noexcept override;
  [[nodiscard]] bool enter(int j) noexcept override;
  void dependence(Eigen::VectorXd& coefficients) noexcept override;
  void leave(int place) noexcept override;
  [[nodiscard]] bool can_divide() const noexcept override { return true; }
  void divide(int place, int other, bool adds_up) noexcept override;
  void refine(const Eigen::VectorXd& slopes) noexcept override;
  [[nodiscard]] bool sound() const noexcept override { return sound_; }
  [[nodiscard]] const Eigen::VectorXd& target() noexcept override;
  [[nodiscard]] const Eigen::VectorXd& slopes(const Eigen::VectorXd& of_residual) noexcept override;

 private:
  using Ten = LinkDensity::Ten;

  /// One link's share.
  struct Density {
    LinkDensity rows;
    Eigen::Index first = 0;  ///< of its unknowns y

    /// Its unknowns among those of all links; zeros behind them.
    [[nodiscard]] Ten share_of(const Eigen::VectorXd& y) const noexcept;
    /// The w of which these are the unknowns.
    [[nodiscard]] Ten weights(const Ten& y) const noexcept;
  };

  void rebuild(int link) noexcept;
  [[nodiscard]] Ten row_of(int j) const noexcept;
  void factorise() noexcept;
  void factorise_from(int link) noexcept;
  void solve() noexcept;
  void solve_normal(Eigen::VectorXd& x) const noexcept;
  void spread(const Eigen::VectorXd& y) noexcept;
  [[nodiscard]] double lost(std::size_t place, const Eigen::VectorXd& slopes) const noexcept;
  [[nodiscard]] bool is_one_link() const noexcept { return densities_.size() == 1; }

  const ShapeColumns* columns_;
  const Eigen::VectorXd* V_;
  const Eigen::MatrixXd* R_ = nullptr;
  double lambda_ = 0.0;
  std::vector<Density> densities_;
  std::vector<int> passive_;
  bool sound_ = true;
  bool solved_ = false;               ///< y_ and the weights are those of the passive shapes
  DampedTen ten_;                     ///< of one link
  ColumnQr qr_;                       ///< of several
  int factorised_ = 0;                ///< links whose columns are in qr_, if E is still the same
  std::vector<Eigen::Index> unfelt_;  ///< unknowns y that no row of several links feels
  Eigen::VectorXd b_, y_, correction_, target_, slopes_;
  // Ten numbers a link:
  Eigen::VectorXd weights_;         ///< w, or its correction
  Eigen::VectorXd missing_;         ///< slopes u_j . missing, what y left before that correction
  Eigen::VectorXd along_;           ///< u_j . weights_ of the passive shapes
  Eigen::VectorXd noise_;           ///< what rounding leaves of a slope R^T r that is zero
  std::vector<Eigen::Index> ends_;  ///< where zeros begin in the columns of qr_
};

}  // namespace shapeid::fast
