#include "shapeid/fast/reflections.hpp"

#include <cstddef>

#include "shapeid/models/contract.hpp"

namespace shapeid::fast {
namespace {

/// As many numbers as one vector register of the machine that is compiled for holds.
constexpr int width = EIGEN_MAX_STATIC_ALIGN_BYTES > 16 ? EIGEN_MAX_STATIC_ALIGN_BYTES / 8 : 2;

[[maybe_unused]] Violation why_other_sizes(const Eigen::Ref<Eigen::MatrixXd>& columns,
                                           const Eigen::Ref<Eigen::MatrixXd>& above,
                                           Eigen::Index rows, int count) {
  if (columns.rows() == rows && above.rows() == count && above.cols() == columns.cols()) {
    return std::nullopt;
  }
  return "columns do not fit the reflections";
}

}  // namespace

void Reflections::append(double top, double inverse_half) noexcept {
  const auto c = static_cast<std::size_t>(count_);
  const Eigen::Map<const Eigen::VectorXd> v(v_ + count_ * stride_, rows_);
  for (std::size_t d = 0; d < c; ++d) {
    const auto earlier = static_cast<Eigen::Index>(d);
    products_[c][d] = v.dot(Eigen::Map<const Eigen::VectorXd>(v_ + earlier * stride_, rows_));
  }
  top_[c] = top;
  inverse_half_[c] = inverse_half;
  ++count_;
}

void Reflections::apply(Eigen::Ref<Eigen::MatrixXd> columns,
                        Eigen::Ref<Eigen::MatrixXd> above) const noexcept {
  SHAPEID_CONTRACT(why_other_sizes(columns, above, rows_, count_));
  apply_any(columns, above.data(), above.outerStride());
}

void Reflections::apply(Eigen::Ref<Eigen::MatrixXd> columns) const noexcept {
  apply_any(columns, nullptr, 0);
}

void Reflections::apply_any(Eigen::Ref<Eigen::MatrixXd> columns, double* above,
                            Eigen::Index stride_above) const noexcept {
  switch (count_) {
    case 1:
      return apply_all<1>(columns, above, stride_above);
    case 2:
      return apply_all<2>(columns, above, stride_above);
    case 3:
      return apply_all<3>(columns, above, stride_above);
    case 4:
      return apply_all<4>(columns, above, stride_above);
    default:
      return;
  }
}

template <int vectors>
void Reflections::apply_all(Eigen::Ref<Eigen::MatrixXd> columns, double* above,
                            Eigen::Index stride_above) const noexcept {
  const Eigen::Index stride = columns.outerStride();
  const auto above_column = [&](Eigen::Index j) {
    return above == nullptr ? nullptr : above + j * stride_above;
  };
  // Sums that do not wait for each other, as many as registers hold.
  constexpr int together = vectors == 1 ? 4 : 2;
  Eigen::Index j = 0;
  for (; j + together <= columns.cols(); j += together) {
    apply_to<vectors, together>(columns.data() + j * stride, stride, above_column(j), stride_above);
  }
  for (; j < columns.cols(); ++j) {
    apply_to<vectors, 1>(columns.data() + j * stride, stride, above_column(j), stride_above);
  }
}

// One after the other, reflection c takes the share s_c = x_c^T (column as the earlier ones left
// it) / half_c of x_c away. x_c^T of what they left is x_c^T column less (x_c^T x_d) s_d for each
// earlier d: so all products with the column as it came are enough, and the column changes once.
template <int vectors, int columns>
void Reflections::apply_to(double* column, Eigen::Index stride, double* above,
                           Eigen::Index stride_above) const noexcept {
  // Few sums would wait for each other's additions: then two registers each.
  constexpr int pack = vectors * columns < 8 ? 2 * width : width;
  using Pack = Eigen::Array<double, pack, 1>;
  using Read = Eigen::Map<const Pack>;
  using Write = Eigen::Map<Pack>;
  const Eigen::Index packed = rows_ - rows_ % pack;
  Pack sums[vectors][columns];
  for (auto& row : sums) {
    for (Pack& sum : row) sum.setZero();
  }
  for (Eigen::Index i = 0; i < packed; i += pack) {
    Pack x[columns];
    for (int j = 0; j < columns; ++j) x[j] = Read(column + j * stride + i);
    for (int c = 0; c < vectors; ++c) {
      const Pack v = Read(v_ + c * stride_ + i);
      for (int j = 0; j < columns; ++j) sums[c][j] += v * x[j];
    }
  }
  double shares[vectors][columns];
  for (int j = 0; j < columns; ++j) {
    double* const tops = above == nullptr ? nullptr : above + j * stride_above;
    for (int c = 0; c < vectors; ++c) {
      const auto which = static_cast<std::size_t>(c);
      double sum = sums[c][j].sum();
      if (tops != nullptr) sum += top_[which] * tops[c];
      for (Eigen::Index i = packed; i < rows_; ++i) {
        sum += v_[c * stride_ + i] * column[j * stride + i];
      }
      for (int d = 0; d < c; ++d) {
        sum -= products_[which][static_cast<std::size_t>(d)] * shares[d][j];
      }
      shares[c][j] = sum * inverse_half_[which];
      if (tops != nullptr) tops[c] -= top_[which] * shares[c][j];
    }
  }
  for (Eigen::Index i = 0; i < packed; i += pack) {
    Pack x[columns];
    for (int j = 0; j < columns; ++j) x[j] = Read(column + j * stride + i);
    for (int c = 0; c < vectors; ++c) {
      const Pack v = Read(v_ + c * stride_ + i);
      for (int j = 0; j < columns; ++j) x[j] -= shares[c][j] * v;
    }
    for (int j = 0; j < columns; ++j) Write(column + j * stride + i) = x[j];
  }
  for (Eigen::Index i = packed; i < rows_; ++i) {
    for (int j = 0; j < columns; ++j) {
      for (int c = 0; c < vectors; ++c) {
        column[j * stride + i] -= shares[c][j] * v_[c * stride_ + i];
      }
    }
  }
}

}  // namespace shapeid::fast
