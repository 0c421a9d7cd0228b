#include "shapeid/fast/triangle_products.hpp"

#include <cmath>
#include <cstddef>

#include "shapeid/fast/wide.hpp"

namespace shapeid::fast {
namespace {

/// Columns of R, one behind the other.
struct Columns {
  const double* first;
  std::ptrdiff_t stride;

  [[nodiscard]] const double* operator[](std::ptrdiff_t c) const noexcept {
    return first + c * stride;
  }
};

/// The first `rows` of ten columns, times u. Two sums each, so that one addition need not wait for
/// the other.
SHAPEID_WIDE void add_ten(Columns columns, std::ptrdiff_t rows, const double* u,
                          double* a) noexcept {
  std::ptrdiff_t i = 0;
  for (; i + 4 <= rows; i += 4) {
    Four even, odd = {}, here;
    load(a + i, even);
    for (std::ptrdiff_t c = 0; c < 10; c += 2) {
      load(columns[c] + i, here);
      even += u[c] * here;
      load(columns[c + 1] + i, here);
      odd += u[c + 1] * here;
    }
    store(even + odd, a + i);
  }
  for (; i < rows; ++i) {
    double even = a[i], odd = 0.0;
    for (std::ptrdiff_t c = 0; c < 10; c += 2) {
      even += u[c] * columns[c][i];
      odd += u[c + 1] * columns[c + 1][i];
    }
    a[i] = even + odd;
  }
}

/// Two columns at a time, so that what is loaded serves twice.
SHAPEID_WIDE void make_columns(Columns columns, std::ptrdiff_t links, const TenRows& E,
                               std::size_t rank, std::ptrdiff_t apart, double* a,
                               std::ptrdiff_t stride) noexcept {
  for (std::size_t k = 0; k < rank; k += 2) {
    const std::size_t other = k + 1 < rank ? k + 1 : k;
    double* const to = a + static_cast<std::ptrdiff_t>(k) * stride;
    double* const other_to = a + static_cast<std::ptrdiff_t>(other) * stride;
    for (std::ptrdiff_t b = 0; b < links; ++b) {
      Dozen sum, other_sum, here;
      for (std::size_t i = 0; i < 10; ++i) {
        load_ten(columns[static_cast<std::ptrdiff_t>(i)] + 10 * b, here);
        add(sum, E[k][i], here);
        add(other_sum, E[other][i], here);
      }
      store_ten(sum, to + apart * b);
      store_ten(other_sum, other_to + apart * b);
    }
  }
}

/// Of links: sums[j] = sum over the rows i that link reaches of what `term` makes of R_ij.
template <typename Term>
[[gnu::always_inline]] inline void sum_columns(Columns columns, std::ptrdiff_t links, double* sums,
                                               Term term) noexcept {
  for (std::ptrdiff_t l = 0; l < links; ++l) {
    const std::ptrdiff_t rows = 10 * (l + 1);
    for (std::ptrdiff_t j = 10 * l; j < 10 * (l + 1); ++j) {
      Four sum[2] = {}, here;
      std::ptrdiff_t i = 0;
      for (; i + 8 <= rows; i += 8) {
        for (std::ptrdiff_t k = 0; k < 2; ++k) {
          load(columns[j] + i + 4 * k, here);
          term.of_four(here, i + 4 * k);
          sum[k] += here;
        }
      }
      double rest = 0.0;
      for (; i < rows; ++i) rest += term.of_one(columns[j][i], i);
      sum[0] += sum[1];
      sums[j] = ((sum[0][0] + sum[0][2]) + (sum[0][1] + sum[0][3])) + rest;
    }
  }
}

struct Times {
  const double* r;
  [[gnu::always_inline]] void of_four(Four& x, std::ptrdiff_t i) const noexcept {
    Four y;
    load(r + i, y);
    x *= y;
  }
  [[gnu::always_inline]] double of_one(double x, std::ptrdiff_t i) const noexcept {
    return x * r[i];
  }
};

struct Size {
  [[gnu::always_inline]] static void of_four(Four& x, std::ptrdiff_t) noexcept { take_sign(x); }
  [[gnu::always_inline]] static double of_one(double x, std::ptrdiff_t) noexcept {
    return std::abs(x);
  }
};

SHAPEID_WIDE void sum_products(Columns columns, std::ptrdiff_t links, const double* r,
                               double* sums) noexcept {
  sum_columns(columns, links, sums, Times{r});
}

SHAPEID_WIDE void sum_sizes(Columns columns, std::ptrdiff_t links, double* sums) noexcept {
  sum_columns(columns, links, sums, Size{});
}

}  // namespace

void add_column(const Eigen::MatrixXd& R, int link, const double* u, double* a) noexcept {
  const Eigen::Index first = Eigen::Index{10} * link;
  add_ten({R.col(first).data(), R.outerStride()}, first + 10, u, a);
}

void link_columns(const Eigen::MatrixXd& R, int link, const TenRows& E, int rank,
                  Eigen::Index apart, double* a, Eigen::Index stride) noexcept {
  make_columns({R.col(Eigen::Index{10} * link).data(), R.outerStride()}, link + 1, E,
               static_cast<std::size_t>(rank), apart, a, stride);
}

void slopes_of(const Eigen::MatrixXd& R, const Eigen::VectorXd& r, Eigen::VectorXd& g) noexcept {
  sum_products({R.data(), R.outerStride()}, g.size() / 10, r.data(), g.data());
}

void column_sizes(const Eigen::MatrixXd& R, Eigen::VectorXd& lengths) noexcept {
  sum_sizes({R.data(), R.outerStride()}, lengths.size() / 10, lengths.data());
}

}  // namespace shapeid::fast
