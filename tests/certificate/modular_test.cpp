// Arithmetic modulo primes against counting: spans of small fields are listed, primes are divided.
#include "shapeid/proofs/certificate/modular.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <set>

namespace shapeid::certificate {
namespace {

using Element = PrimeField::Element;
using Elements = std::vector<Element>;

bool is_prime(Element n) {
  for (Element d = 2; d * d <= n; ++d) {
    if (n % d == 0) return false;
  }
  return n > 1;
}

TEST(Modular, TheNextPrimeIsTheNext) {
  for (Element start = 1; start < 300; ++start) {
    Element next = start + 1;
    while (!is_prime(next)) ++next;
    EXPECT_EQ(next_prime(start), next);
  }
}

// Products near 2^124, whose sums 128 bits hardly hold.
RC_GTEST_PROP(Modular, ProductsAndInversesOfLargePrimes, ()) {
  const PrimeField field(next_prime((Element{1} << 61U) - 1 - *rc::gen::inRange<Element>(0, 9999)));
  const auto n = *rc::gen::inRange<std::size_t>(0, 70);
  const auto element = [&] {
    return *rc::gen::element(Element{0}, field.p() - 1, field.p() - 2,
                             *rc::gen::inRange<Element>(0, field.p()));
  };
  Elements a, b;
  Integer sum = 0;
  for (std::size_t i = 0; i < n; ++i) {
    a.push_back(element());
    b.push_back(element());
    sum += Integer(static_cast<unsigned long>(a[i])) * static_cast<unsigned long>(b[i]);
    RC_ASSERT(field.minus(a[i], b[i]) == field.of(Integer(static_cast<unsigned long>(a[i])) -
                                                  static_cast<unsigned long>(b[i])));
    if (a[i] != 0) RC_ASSERT(field.times(a[i], field.inverse(a[i])) == 1U);
  }
  RC_ASSERT(field.dot(a.data(), b.data(), n) == field.of(sum));
}

// The largest products of the largest prime that fits: (-1)(-1) = 1 each time.
TEST(Modular, SumsOfTheLargestProductsDoNotRunOver) {
  Element p = next_prime((Element{1} << 62U) - 1000);
  ASSERT_LT(p, Element{1} << 62U);
  const PrimeField field(p);
  const Elements most(100, p - 1);
  for (std::size_t n = 0; n <= most.size(); ++n) {
    EXPECT_EQ(field.dot(most.data(), most.data(), n), n);
  }
}

Elements drawn_matrix(std::size_t rows, std::size_t columns, Element p) {
  Elements A(rows * columns);
  for (Element& entry : A) entry = *rc::gen::inRange<Element>(0, p);
  return A;
}

// Singular every third time in fields this small.
RC_GTEST_PROP(Modular, AnInverseIsOne, ()) {
  const PrimeField field(*rc::gen::element<Element>(2, 3, 7, next_prime(Element{1} << 60U)));
  const auto n = *rc::gen::inRange<std::size_t>(1, 6);
  const Elements A = drawn_matrix(n, n, field.p());
  const auto B = inverse(A, n, field);
  RC_ASSERT(B.has_value() == (pivot_columns(A, n, n, field).size() == n));
  if (!B) return;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < n; ++k) {
      Element sum = 0;
      for (std::size_t j = 0; j < n; ++j) {
        sum = (sum + field.times(A[i * n + j], (*B)[j * n + k])) % field.p();
      }
      RC_ASSERT(sum == (i == k ? 1U : 0U));
    }
  }
}

// A column is a pivot if it is none of the sums of those before it.
RC_GTEST_PROP(Modular, PivotColumnsLieInNoSpanOfThoseBefore, ()) {
  const PrimeField field(*rc::gen::element<Element>(2, 3, 5));
  const auto rows = *rc::gen::inRange<std::size_t>(1, 5);
  const auto columns = *rc::gen::inRange<std::size_t>(1, 7);
  const Elements A = drawn_matrix(rows, columns, field.p());
  std::set<Elements> span = {Elements(rows, 0)};
  std::vector<std::size_t> expected;
  for (std::size_t j = 0; j < columns; ++j) {
    Elements column(rows);
    for (std::size_t i = 0; i < rows; ++i) column[i] = A[i * columns + j];
    if (span.contains(column)) continue;
    expected.push_back(j);
    std::set<Elements> wider;
    for (const Elements& sum : span) {
      for (Element factor = 0; factor < field.p(); ++factor) {
        Elements other = sum;
        for (std::size_t i = 0; i < rows; ++i) {
          other[i] = (other[i] + factor * column[i]) % field.p();
        }
        wider.insert(std::move(other));
      }
    }
    span = std::move(wider);
  }
  RC_ASSERT(pivot_columns(A, rows, columns, field) == expected);
}

}  // namespace
}  // namespace shapeid::certificate
