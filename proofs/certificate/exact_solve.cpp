#include "shapeid/proofs/certificate/exact_solve.hpp"

#include <utility>

#include "shapeid/proofs/certificate/modular.hpp"

namespace shapeid::certificate {
namespace {

using Element = PrimeField::Element;

/// A few primes: a matrix that is singular modulo all of them is taken for singular.
constexpr Element first_start = Element{1} << 60U;
constexpr int tries = 3;

/// Rows without their common factors: shorter integers, the same solution.
std::pair<Dyadic, Dyadic> without_contents(Dyadic A, Dyadic b) {
  Dyadic Ab = beside(std::move(A), std::move(b));
  Dyadic left(Ab.rows, Ab.columns - 1), right(Ab.rows, 1);
  for (std::size_t i = 0; i < Ab.rows; ++i) {
    Integer content = 0;
    for (std::size_t j = 0; j < Ab.columns; ++j) content = gcd(content, Ab.at(i, j));
    if (content == 0) content = 1;
    for (std::size_t j = 0; j + 1 < Ab.columns; ++j) left.at(i, j) = Ab.at(i, j) / content;
    right.at(i, 0) = Ab.at(i, Ab.columns - 1) / content;
  }
  return {left, right};
}

/// x modulo p^k, digit by digit.
class Lifting {
 public:
  Lifting(const Dyadic& A, const Dyadic& b, const PrimeField& field, std::vector<Element> inverse)
      : A_(&A), residual_(b.entries), field_(field), inverse_(std::move(inverse)) {
    x_.resize(A.rows);
  }

  void lift(std::size_t digits) {
    const std::size_t n = A_->rows;
    std::vector<std::vector<Element>> steps(digits, std::vector<Element>(n));
    std::vector<Element> rest(n);
    for (std::vector<Element>& digit : steps) {
      for (std::size_t i = 0; i < n; ++i) rest[i] = field_.of(residual_[i]);
      for (std::size_t i = 0; i < n; ++i) digit[i] = field_.dot(&inverse_[i * n], rest.data(), n);
      for (std::size_t i = 0; i < n; ++i) {
        Integer& r = residual_[i];
        for (std::size_t j = 0; j < n; ++j) {
          mpz_submul_ui(r.get_mpz_t(), A_->at(i, j).get_mpz_t(), digit[j]);
        }
        mpz_divexact_ui(r.get_mpz_t(), r.get_mpz_t(), field_.p());
      }
    }
    Integer power;
    for (std::size_t i = 0; i < n; ++i) x_[i] += modulus_ * composed(steps, i, 0, digits, power);
    modulus_ *= power;
  }

  [[nodiscard]] const std::vector<Integer>& x() const { return x_; }
  [[nodiscard]] const Integer& modulus() const { return modulus_; }

 private:
  /// Digits [begin, end) of entry i as one number; `power` becomes p^(end - begin).
  [[nodiscard]] Integer composed(const std::vector<std::vector<Element>>& steps, std::size_t i,
                                 std::size_t begin, std::size_t end, Integer& power) const {
    if (end - begin == 1) {
      power = static_cast<unsigned long>(field_.p());
      return Integer(static_cast<unsigned long>(steps[begin][i]));
    }
    const std::size_t middle = begin + (end - begin) / 2;
    Integer low_power, high_power;
    const Integer low = composed(steps, i, begin, middle, low_power);
    const Integer high = composed(steps, i, middle, end, high_power);
    power = low_power * high_power;
    return low + low_power * high;
  }

  const Dyadic* A_;
  std::vector<Integer> residual_;
  PrimeField field_;
  std::vector<Element> inverse_;
  std::vector<Integer> x_;
  Integer modulus_ = 1;
};

/// The smallest d > 0 for which d x is, modulo the modulus, no larger than `most` (Wang 1981).
Integer denominator_of(const Integer& x, const Integer& modulus, const Integer& most) {
  Integer r0 = modulus, r1 = x, d0 = 0, d1 = 1, quotient;
  while (r1 > most) {
    mpz_fdiv_qr(quotient.get_mpz_t(), r0.get_mpz_t(), r0.get_mpz_t(), r1.get_mpz_t());
    std::swap(r0, r1);
    mpz_submul(d0.get_mpz_t(), quotient.get_mpz_t(), d1.get_mpz_t());
    std::swap(d0, d1);
  }
  return abs(d1);
}

Integer nearest_residue(const Integer& x, const Integer& modulus) {
  Integer r;
  mpz_fdiv_r(r.get_mpz_t(), x.get_mpz_t(), modulus.get_mpz_t());
  if (2 * r > modulus) r -= modulus;
  return r;
}

/// The fractions over one denominator that the residues stand for; empty if the modulus is still
/// too small for them.
std::optional<Fractions> reconstructed(const std::vector<Integer>& x, const Integer& modulus) {
  const Integer most = sqrt(modulus / 2);
  Fractions f{Dyadic(x.size(), 1), 1};
  for (const Integer& entry : x) {
    const Integer left = nearest_residue(entry * f.denominator, modulus);
    if (abs(left) <= most) continue;
    Integer residue;
    mpz_fdiv_r(residue.get_mpz_t(), left.get_mpz_t(), modulus.get_mpz_t());
    f.denominator *= denominator_of(residue, modulus, most);
    if (f.denominator > most) return std::nullopt;
  }
  for (std::size_t i = 0; i < x.size(); ++i) {
    f.numerators.entries[i] = nearest_residue(x[i] * f.denominator, modulus);
  }
  return f;
}

bool solves(const Dyadic& A, const Fractions& x, const Dyadic& b) {
  for (std::size_t i = 0; i < A.rows; ++i) {
    Integer left = -b.entries[i] * x.denominator;
    for (std::size_t j = 0; j < A.columns; ++j) left += A.at(i, j) * x.numerators.entries[j];
    if (left != 0) return false;
  }
  return true;
}

/// Cramer's rule and Hadamard's inequality: digits after which a solution must have been found.
std::size_t most_digits(const Dyadic& A, const Dyadic& b) {
  std::size_t bits = 0;
  for (std::size_t i = 0; i < A.rows; ++i) {
    std::size_t longest = mpz_sizeinbase(b.entries[i].get_mpz_t(), 2);
    for (std::size_t j = 0; j < A.columns; ++j) {
      longest = std::max(longest, mpz_sizeinbase(A.at(i, j).get_mpz_t(), 2));
    }
    bits += longest + 5;  // the root of a sum of up to 2^10 squares
  }
  return 2 * bits / 60 + 3;
}

}  // namespace

std::optional<Fractions> solve(const Dyadic& given_A, const Dyadic& given_b) {
  if (given_A.rows == 0) return Fractions{Dyadic(0, 1), 1};
  const auto [A, b] = without_contents(given_A, given_b);
  Element p = first_start;
  for (int attempt = 0; attempt < tries; ++attempt) {
    p = next_prime(p);
    const PrimeField field(p);
    auto start = inverse(reduced(A, field), A.rows, field);
    if (!start) continue;
    Lifting lifting(A, b, field, std::move(*start));
    const std::size_t most = most_digits(A, b);
    for (std::size_t digits = 0; digits < 2 * most;) {
      const std::size_t more = 4 + digits / 2;
      lifting.lift(more);
      digits += more;
      auto x = reconstructed(lifting.x(), lifting.modulus());
      if (x && solves(A, *x, b)) return x;
    }
  }
  return std::nullopt;
}

std::vector<std::size_t> independent_columns(const Dyadic& A) {
  const PrimeField field(next_prime(first_start));
  return pivot_columns(reduced(A, field), A.rows, A.columns, field);
}

}  // namespace shapeid::certificate
