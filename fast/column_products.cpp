#include "shapeid/fast/column_products.hpp"

#include <cstddef>

#include "shapeid/fast/wide.hpp"

namespace shapeid::fast {
namespace {

/// Four numbers whose sum is u . x.
[[gnu::always_inline]] inline void four_sums(const double* u, const Dozen& x, Four& sums) noexcept {
  Dozen ten;
  load_ten(u, ten);
  sums = ten.part[0] * x.part[0] + ten.part[1] * x.part[1] + ten.part[2] * x.part[2];
}

/// `U`: ten numbers a shape. The shapes are of one link. The digits do not depend on what stands
/// beside a shape.
SHAPEID_WIDE void multiply(const double* U, const int* shapes, std::size_t n, const double* ten,
                           double* products) noexcept {
  Dozen x;
  load_ten(ten, x);
  std::size_t k = 0;
  for (; k + 4 <= n; k += 4) {
    Four block[4];
    for (std::size_t i = 0; i < 4; ++i) {
      four_sums(U + std::ptrdiff_t{10} * shapes[k + i], x, block[i]);
    }
    transpose(block);
    store((block[0] + block[2]) + (block[1] + block[3]), products + k);
  }
  for (; k < n; ++k) {
    Four sums;
    four_sums(U + std::ptrdiff_t{10} * shapes[k], x, sums);
    products[k] = (sums[0] + sums[2]) + (sums[1] + sums[3]);
  }
}

}  // namespace

void column_products(const ShapeColumns& columns, const std::vector<int>& shapes,
                     const Eigen::VectorXd& x, Eigen::VectorXd& products) noexcept {
  const std::size_t n = shapes.size();
  for (std::size_t first = 0; first < n;) {
    const int link = columns.link(shapes[first]);
    std::size_t end = first + 1;
    while (end < n && columns.link(shapes[end]) == link) ++end;
    multiply(columns.data(), shapes.data() + first, end - first,
             x.data() + std::ptrdiff_t{10} * link, products.data() + first);
    first = end;
  }
}

}  // namespace shapeid::fast
