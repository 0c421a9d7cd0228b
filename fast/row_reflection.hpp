// Householder reflections on consecutive rows, applied to columns beside each other. Read by
// column_qr alone.
#pragma once

#include <Eigen/Core>

#include <cstddef>

namespace shapeid::fast {

/// 1 - scale v v^T on the rows [first, end).
struct RowReflection {
  Eigen::Index first, end;
  std::size_t place;  ///< of the numbers of v among those of all
  double scale;
};

/// Rows are taken four at a time, always the same four together: what was written as a whole is
/// read as a whole. Where a vector begins or ends within four there are zeros beside it, and
/// columns have room for as many rows.
namespace four_rows {
inline constexpr Eigen::Index together = 4;

constexpr Eigen::Index first(Eigen::Index row) noexcept { return row / together * together; }
constexpr Eigen::Index end(Eigen::Index row) noexcept { return first(row + together - 1); }
/// Numbers that a vector on rows [from, until) takes.
constexpr Eigen::Index numbers(Eigen::Index from, Eigen::Index until) noexcept {
  return end(until) - first(from);
}
}  // namespace four_rows

/// Columns a stride apart, each with zeros from its end on.
struct ColumnBlock {
  double* first;
  Eigen::Index stride;
  Eigen::Index* ends;
};

/// `count` columns by one reflection after the other, whose vectors' numbers are `vectors`. Ends
/// are moved to where zeros begin then.
void reflect_columns(const RowReflection* from, const RowReflection* to, const double* vectors,
                     ColumnBlock x, Eigen::Index count) noexcept;

/// A column by a reflection of two rows, with the numbers of its vector.
inline void reflect_two(const RowReflection& r, const double* numbers, double* x) noexcept {
  const double* v = numbers + r.first % four_rows::together;
  x += r.first;
  const double share = r.scale * (v[0] * x[0] + v[1] * x[1]);
  x[0] -= share * v[0];
  x[1] -= share * v[1];
}

/// Sum of the squares of rows [first, end) of a column with zeros from there on.
[[nodiscard]] double square_of(const double* x, Eigen::Index first, Eigen::Index end) noexcept;

}  // namespace shapeid::fast
