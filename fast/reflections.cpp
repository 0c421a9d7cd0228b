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
  apply_to_all({columns.data(), columns.outerStride()}, {above.data(), above.outerStride()},
               columns.cols());
}

void Reflections::apply(Eigen::Ref<Eigen::MatrixXd> columns) const noexcept {
  apply_to_all({columns.data(), columns.outerStride()}, {nullptr, 0}, columns.cols());
}

void Reflections::apply_to_all(Columns columns, Columns above, Eigen::Index count) const noexcept {
  switch (count_) {
    case 1:
      return apply_some<1>(columns, above, count);
    case 2:
      return apply_some<2>(columns, above, count);
    case 3:
      return apply_some<3>(columns, above, count);
    case 4:
      return apply_some<4>(columns, above, count);
    default:
      return;
  }
}

template <int vectors>
void Reflections::apply_some(Columns columns, Columns above, Eigen::Index count) const noexcept {
  // Sums that do not wait for each other, as many as registers hold.
  constexpr int together = vectors == 1 ? 4 : 2;
  const auto from = [](Columns c, Eigen::Index j) {
    return Columns{c.data + j * c.stride, c.stride};  // no rows above: null plus nothing
  };
  Eigen::Index j = 0;
  for (; j + together <= count; j += together) {
    apply_to<vectors, together>(from(columns, j), from(above, j));
  }
  for (; j < count; ++j) apply_to<vectors, 1>(from(columns, j), from(above, j));
}

// One after the other, reflection c takes the share s_c = x_c^T (column as the earlier ones left
// it) / half_c of x_c away. x_c^T of what they left is x_c^T column less (x_c^T x_d) s_d for each
// earlier d: so all products with the column as it came are enough, and the column changes once.
template <int vectors, int together>
void Reflections::apply_to(Columns columns, Columns above) const noexcept {
  double* const column = columns.data;
  const Eigen::Index stride = columns.stride;
  // Few sums would wait for each other's additions: then two registers each.
  constexpr int pack = vectors * together < 8 ? 2 * width : width;
  using Pack = Eigen::Array<double, pack, 1>;
  using Read = Eigen::Map<const Pack>;
  using Write = Eigen::Map<Pack>;
  const Eigen::Index packed = rows_ - rows_ % pack;
  Pack sums[vectors][together];
  for (auto& row : sums) {
    for (Pack& sum : row) sum.setZero();
  }
  for (Eigen::Index i = 0; i < packed; i += pack) {
    Pack x[together];
    for (int j = 0; j < together; ++j) x[j] = Read(column + j * stride + i);
    for (int c = 0; c < vectors; ++c) {
      const Pack v = Read(v_ + c * stride_ + i);
      for (int j = 0; j < together; ++j) sums[c][j] += v * x[j];
    }
  }
  double shares[vectors][together];
  for (int j = 0; j < together; ++j) {
    double* const tops = above.data == nullptr ? nullptr : above.data + j * above.stride;
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
    Pack x[together];
    for (int j = 0; j < together; ++j) x[j] = Read(column + j * stride + i);
    for (int c = 0; c < vectors; ++c) {
      const Pack v = Read(v_ + c * stride_ + i);
      for (int j = 0; j < together; ++j) x[j] -= shares[c][j] * v;
    }
    for (int j = 0; j < together; ++j) Write(column + j * stride + i) = x[j];
  }
  for (Eigen::Index i = packed; i < rows_; ++i) {
    for (int j = 0; j < together; ++j) {
      for (int c = 0; c < vectors; ++c) {
        column[j * stride + i] -= shares[c][j] * v_[c * stride_ + i];
      }
    }
  }
}

}  // namespace shapeid::fast
