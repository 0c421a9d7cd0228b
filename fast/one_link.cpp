#include "shapeid/fast/one_link.hpp"

#include <cmath>
#include <cstddef>

#include "shapeid/fast/column_qr.hpp"
#include "shapeid/fast/wide.hpp"

namespace shapeid::fast {
namespace {

using Ten = std::array<Dozen, 10>;

alignas(32) constexpr Four places[] = {
    {0.0, 1.0, 2.0, 3.0}, {4.0, 5.0, 6.0, 7.0}, {8.0, 9.0, 10.0, 11.0}};

constexpr std::size_t at(int i) noexcept { return static_cast<std::size_t>(i); }

/// What a column that enters makes of the rows from k on.
struct Image {
  double square = 0.0;  ///< of the length of its part there, and of the rest of it
  double rest = 0.0;
  Dozen w;  ///< Q^T of it
  Dozen s;  ///< sum over these rows of w_i row_i
};

SHAPEID_WIDE void look_at(const Ten& rows, const double* column, std::size_t k,
                          Image& image) noexcept {
  Dozen u;
  load_ten(column, u);
  for (std::size_t i = 0; i < 10; ++i) {
    const Dozen& row = rows[i];
    const Four sum = row.part[0] * u.part[0] + row.part[1] * u.part[1] + row.part[2] * u.part[2];
    image.w[i] = (sum[0] + sum[2]) + (sum[1] + sum[3]);
  }
  Dozen s;
  double square = 0.0, rest = 0.0;
  for (std::size_t i = 0; i < k; ++i) rest += image.w[i] * image.w[i];
  for (std::size_t i = k; i < 10; ++i) {
    square += image.w[i] * image.w[i];
    add(s, image.w[i], rows[i]);
  }
  image.s = s;
  image.square = square;
  image.rest = rest;
}

/// Householder's reflection that makes w[k], of the rows from k on, `target` and the others zero;
/// the inverse of T gains its column for (w_0 ... w_(k-1), target).
SHAPEID_WIDE void reflect(Ten& rows, Ten& inverse, const Image& image, std::size_t k, double length,
                          double target) noexcept {
  const double inverse_length = 1.0 / target;
  Dozen column;
  for (std::size_t i = 0; i < k; ++i) add(column, -image.w[i] * inverse_length, inverse[i]);
  for (std::size_t p = 0; p < 3; ++p) {
    const Four is_k = places[p] == static_cast<double>(k) ? Four{} + 1.0 : Four{};
    inverse[k].part[p] = column.part[p] + inverse_length * is_k;
  }
  const double first = image.w[k] - target;  // the signs differ, so that nothing cancels
  const double factor = 1.0 / (length * (length + std::abs(image.w[k])));
  Dozen s;
  for (std::size_t p = 0; p < 3; ++p) {
    s.part[p] = factor * (image.s.part[p] - target * rows[k].part[p]);
  }
  add(rows[k], -first, s);
  for (std::size_t i = k + 1; i < 10; ++i) add(rows[i], -image.w[i], s);
}

/// (a, b) <- (c a - s b, c b + s a)
[[gnu::always_inline]] inline void rotate(double c, double s, Dozen& a, Dozen& b) noexcept {
  for (std::size_t p = 0; p < 3; ++p) {
    const Four first = a.part[p], second = b.part[p];
    a.part[p] = c * first - s * second;
    b.part[p] = c * second + s * first;
  }
}

/// Rotations of neighbouring rows and columns that gather entry `leaving` of the columns in column
/// k, and that entry taken out of the columns before it.
SHAPEID_WIDE void take_out(Ten& rows, Ten& columns, std::size_t leaving, std::size_t k) noexcept {
  for (std::size_t i = leaving; i < k; ++i) {
    const double a = columns[i + 1][leaving], b = columns[i][leaving];
    const double scale = 1.0 / std::sqrt(a * a + b * b), c = a * scale, s = b * scale;
    rotate(c, s, columns[i], columns[i + 1]);
    rotate(c, s, rows[i], rows[i + 1]);
  }
  for (std::size_t i = leaving; i < k; ++i) {
    // The last of the entries behind is the next column's first, and no place of this one's.
    for (std::size_t p = 0; p < 3; ++p) {
      Four behind;
      load(&columns[i][4 * p + 1], behind);
      const Four moved = places[p] < static_cast<double>(k) ? behind : Four{};
      columns[i].part[p] = places[p] < static_cast<double>(leaving) ? columns[i].part[p] : moved;
    }
  }
}

}  // namespace

OneLink::OneLink(const ShapeColumns& columns)
    : columns_(&columns),
      target_(Eigen::VectorXd::Zero(10)),
      slopes_(Eigen::VectorXd::Zero(10)),
      correction_(Eigen::VectorXd::Zero(10)) {}

void OneLink::start(const Eigen::MatrixXd& R) noexcept {
  size_ = 0;
  inverse_.fill(Dozen{});
  target_.setZero();
  Dozen g;
  for (int i = 0; i < 10; ++i) {
    Dozen& row = rows_[at(i)];
    row[11] = 0.0;
    for (int j = 0; j <= 10; ++j) row[at(j)] = R(i, j);
    add(g, row[10], row);
  }
  for (int j = 0; j < 10; ++j) slopes_[j] = g[at(j)];
}

// With w the part of the column in the rows from size_ on, s = w^T rows and t = ||w||: the new row
// size_ is -+ s / t, so the slopes fall by s s_c / t^2 with s_c the entry of the right-hand side.
// That needs no square root, and pricing need not wait for one.
bool OneLink::enter(int j) noexcept {
  const std::size_t k = at(size_);
  Image image;
  look_at(rows_, columns_->column(j).data(), k, image);
  constexpr double share = ColumnQr::smallest_share * ColumnQr::smallest_share;
  if (k == 10 || !(image.square > share * (image.rest + image.square))) {
    refused_ = image.w;
    return false;
  }
  const double fall = image.s[10] / image.square;
  for (int i = 0; i < 10; ++i) slopes_[i] -= fall * image.s[at(i)];

  const double length = std::sqrt(image.square), target = image.w[k] > 0.0 ? -length : length;
  reflect(rows_, inverse_, image, k, length, target);
  const double gain = image.s[10] / target;
  for (int i = 0; i <= size_; ++i) target_[i] += gain * inverse_[k][at(i)];
  passive_[k] = j;
  if (++size_ == 10) slopes_.setZero();  // no row is left that a slope could come from
  return true;
}

void OneLink::dependence(Eigen::VectorXd& coefficients) noexcept {
  Dozen sum;
  for (int i = 0; i < size_; ++i) add(sum, refused_[at(i)], inverse_[at(i)]);
  for (int i = 0; i < size_; ++i) coefficients[i] = sum[at(i)];
}

// Rotations of neighbouring rows of Q^T [R c], and of columns of T^-1, that gather row `place` of
// T^-1 in its last column. Without that row and column it is the inverse of the triangle that is
// left.
void OneLink::leave(int place) noexcept {
  const int k = --size_;
  take_out(rows_, inverse_, at(place), at(k));
  const Dozen &row = rows_[at(k)], &column = inverse_[at(k)];
  const double entry = row[10];
  for (int i = 0; i < 10; ++i) slopes_[i] += entry * row[at(i)];
  for (int i = 0; i <= k; ++i) target_[i] -= entry * column[at(i)];
  inverse_[at(k)] = Dozen{};
  for (int i = place; i < k; ++i) {
    passive_[at(i)] = passive_[at(i + 1)];
    target_[i] = target_[i + 1];
  }
  target_[k] = 0.0;
}

// T^T T z = x by the inverse of T.
void OneLink::solve_normal(Eigen::VectorXd& x) noexcept {
  Dozen z;
  for (int c = 0; c < size_; ++c) {
    const Dozen& column = inverse_[at(c)];
    double y = 0.0;  // an entry of T^-T x
    for (int i = 0; i <= c; ++i) y += column[at(i)] * x[i];
    add(z, y, column);
  }
  for (int i = 0; i < size_; ++i) x[i] = z[at(i)];
}

// The normal equations of the correction, A^T A x = A^T r.
void OneLink::refine(const Eigen::VectorXd& slopes) noexcept {
  for (int i = 0; i < size_; ++i) {
    correction_[i] = columns_->column(passive_[static_cast<std::size_t>(i)]).dot(slopes);
  }
  solve_normal(correction_);
  target_.head(size_) += correction_.head(size_);
}

}  // namespace shapeid::fast
