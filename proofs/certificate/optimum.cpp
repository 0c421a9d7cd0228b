#include "shapeid/proofs/certificate/optimum.hpp"

#include <algorithm>
#include <numeric>

#include "shapeid/proofs/certificate/exact_solve.hpp"

namespace shapeid::certificate {
namespace {

using Indices = std::vector<std::size_t>;

/// Sets of shapes that are tried: the start's, and what exact slopes suggest after it.
constexpr int most_sets = 6;

/// Parameters of the free links, with a density term: a dense system of integers is solved for
/// them, at a cost that grows with their cube, a second for a hundred links without a row. Beyond,
/// no optimum is sought.
constexpr std::size_t most_parameters = 1000;

struct DyadicProblem {
  explicit DyadicProblem(const StatedProblem& p)
      : Y(p.masses.Y),
        U(p.masses.U),
        C(p.others.values),
        F(p.masses.F),
        W(p.masses.W),
        V(p.masses.V),
        lambda(Eigen::MatrixXd::Constant(1, 1, p.masses.lambda)) {
    if (C.columns == 0) C = Dyadic(Y.rows, 0);
    YtW = transposed(scaled_rows(W, Y));
  }
  Dyadic Y, U, C, F, W, V, lambda, YtW;
};

/// A candidate: masses and other unknowns over one denominator.
struct Point {
  Fractions m, x;
};

Dyadic times(const Dyadic& factor, Dyadic A) {
  for (Integer& entry : A.entries) entry *= factor.entries[0];
  A.exponent += factor.exponent;
  return A;
}

Dyadic identity(std::size_t n) {
  Dyadic I(n, n);
  for (std::size_t i = 0; i < n; ++i) I.at(i, i) = 1;
  return I;
}

bool zero_lambda(const DyadicProblem& p) { return p.lambda.entries[0] == 0; }

/// x of the columns in `free` are zero here; the others stay as the start has them.
Dyadic held_values(const Eigen::VectorXd& x, const Indices& free) {
  Eigen::VectorXd held = x;
  for (const std::size_t k : free) held[static_cast<Eigen::Index>(k)] = 0.0;
  return Dyadic(Eigen::MatrixXd(held));
}

/// Puts the entries of `part` from place `first` on at the chosen places of `whole`, which has the
/// exponent and denominator of the part.
void put(Dyadic& whole, const Indices& places, const Dyadic& part, std::size_t first) {
  for (std::size_t k = 0; k < places.size(); ++k) {
    whole.entries[places[k]] = part.entries[first + k];
  }
}

Fractions scattered(std::size_t size, const Indices& places, const Fractions& part,
                    std::size_t first) {
  Fractions whole{Dyadic(size, 1), part.denominator};
  whole.numerators.exponent = part.numerators.exponent;
  put(whole.numerators, places, part.numerators, first);
  return whole;
}

/// lambda > 0: with S = sum of V u u^T over the free shapes and Phi = -S g / lambda, the slopes
/// g = Y^T W r and the free x satisfy
///   (lambda + Y^T W Y S) g - lambda Y^T W C x = lambda Y^T W c0
///          - C^T W Y S g   + lambda C^T W C x = -lambda C^T W c0,  c0 = C x_held - F:
/// ten unknowns a link, however many shapes there are. Then m = -V u^T g / lambda.
std::optional<Point> even_point(const DyadicProblem& p, const Indices& shapes,
                                const Indices& free_columns, const Eigen::VectorXd& x) {
  const Dyadic u = chosen_columns(p.U, shapes);
  const Dyadic uV =
      transposed(scaled_rows(transposed(chosen_columns(transposed(p.V), shapes)), transposed(u)));
  const Dyadic S = uV * transposed(u);
  const Indices columns =
      free_columns.empty() ? free_columns : independent_columns(chosen_columns(p.C, free_columns));
  Indices free;
  for (const std::size_t k : columns) free.push_back(free_columns[k]);
  const Dyadic C = chosen_columns(p.C, free);
  const Dyadic CtW = transposed(scaled_rows(p.W, C));
  const Dyadic held = held_values(x, free);
  const Dyadic c0 = p.C * held + -p.F;

  const Dyadic top = beside(times(p.lambda, identity(p.Y.columns)) + (p.YtW * p.Y) * S,
                            times(p.lambda, -(p.YtW * C)));
  const Dyadic bottom = beside(-((CtW * p.Y) * S), times(p.lambda, CtW * C));
  const Dyadic right = times(p.lambda, below(p.YtW * c0, -(CtW * c0)));
  const auto solution = solve(below(top, bottom), right);
  if (!solution) return std::nullopt;

  Fractions g{Dyadic(p.Y.columns, 1), solution->denominator};
  g.numerators.exponent = solution->numerators.exponent;
  Indices first(p.Y.columns);
  std::iota(first.begin(), first.end(), std::size_t{0});
  put(g.numerators, first, solution->numerators, 0);

  // Over the denominator d lambda (its mantissa): m = -V u^T g / lambda, x = x lambda / lambda.
  const Integer& mantissa = p.lambda.entries[0];
  Fractions part{-(transposed(uV) * g.numerators), g.denominator * mantissa};
  part.numerators.exponent -= p.lambda.exponent;
  Fractions free_x{solution->numerators, part.denominator};
  for (Integer& entry : free_x.numerators.entries) entry *= mantissa;
  return Point{scattered(p.U.columns, shapes, part, 0),
               scattered(p.C.columns, free, free_x, p.Y.columns) + over(part.denominator, held)};
}

/// lambda = 0: least squares over independent ones of the free columns; the others stay where the
/// start has them, which costs nothing.
std::optional<Point> least_squares_point(const DyadicProblem& p, Indices shapes,
                                         const Indices& free_columns, const Start& start) {
  // Heavy shapes first, so that what has to move is not near its bound.
  std::stable_sort(shapes.begin(), shapes.end(), [&](std::size_t i, std::size_t j) {
    return start.m[static_cast<Eigen::Index>(i)] > start.m[static_cast<Eigen::Index>(j)];
  });
  const Dyadic A = beside(p.Y * chosen_columns(p.U, shapes), chosen_columns(p.C, free_columns));
  const Indices chosen = independent_columns(A);
  Indices free_shapes, free;
  for (const std::size_t k : chosen) {
    if (k < shapes.size()) {
      free_shapes.push_back(shapes[k]);
    } else {
      free.push_back(free_columns[k - shapes.size()]);
    }
  }
  const Dyadic B = chosen_columns(A, chosen);
  const Dyadic BtW = transposed(scaled_rows(p.W, B));
  const Dyadic held_m = held_values(start.m, free_shapes), held_x = held_values(start.x, free);
  const Dyadic rest = p.F + -(p.Y * (p.U * held_m)) + -(p.C * held_x);
  const auto v = solve(BtW * B, BtW * rest);
  if (!v) return std::nullopt;
  return Point{scattered(p.U.columns, free_shapes, *v, 0) + over(v->denominator, held_m),
               scattered(p.C.columns, free, *v, free_shapes.size()) + over(v->denominator, held_x)};
}

bool columns_are_optimal(const StatedProblem& stated, const Fractions& x, const Dyadic& c) {
  for (std::size_t k = 0; k < c.entries.size(); ++k) {
    const double lower = stated.others.lower[static_cast<Eigen::Index>(k)];
    const double upper = stated.others.upper[static_cast<Eigen::Index>(k)];
    const Rational value = x.at(k);
    const bool ends_below = std::isfinite(lower), ends_above = std::isfinite(upper);
    if ((ends_below && value < exact(lower)) || (ends_above && value > exact(upper))) return false;
    const bool can_fall = !(ends_below && value == exact(lower));
    const bool can_rise = !(ends_above && value == exact(upper));
    const int slope = sgn(c.entries[k]);
    if ((slope > 0 && can_fall) || (slope < 0 && can_rise)) return false;
  }
  return true;
}

/// What the definition says of a candidate: optimal, with which value, and which shapes its slopes
/// would rather have free.
struct Judgement {
  bool optimal = true;
  Rational value;
  Fractions Phi;
  Indices wanted;  ///< shapes with a_j < 0
};

Judgement judge(const StatedProblem& stated, const DyadicProblem& p, const Point& point) {
  Judgement j;
  j.Phi = p.U * point.m;
  const Fractions r = p.Y * j.Phi + p.C * point.x + over(point.m.denominator, -p.F);
  const Dyadic Wr = scaled_rows(p.W, r.numerators);
  const Dyadic a = transposed(p.U) * (transposed(p.Y) * Wr);  // half the slope of the data term
  // Half the slope of the objective, times V: a V + lambda m.
  const Dyadic s = scaled_rows(p.V, a) + times(p.lambda, point.m.numerators);
  for (std::size_t i = 0; i < a.entries.size(); ++i) {
    if (sgn(a.entries[i]) < 0) j.wanted.push_back(i);
    const int mass = sgn(point.m.numerators.entries[i]);
    const int slope = sgn(s.entries[i]);
    if (mass < 0 || slope < 0 || (mass > 0 && slope > 0)) j.optimal = false;
  }
  if (!columns_are_optimal(stated, point.x, transposed(p.C) * Wr)) j.optimal = false;
  if (!j.optimal) return j;
  if (stated.masses.mass_bound > 0.0) {
    Dyadic ones(1, p.U.columns);
    for (Integer& one : ones.entries) one = 1;
    if ((ones * point.m).at(0) > exact(stated.masses.mass_bound)) j.optimal = false;
  }
  // lambda sum m^2 / V = -sum m a, because m (a V + lambda m) = 0 for every shape.
  const Dyadic square = transposed(r.numerators) * Wr;
  const Dyadic density = zero_lambda(p) ? Dyadic(1, 1) : -(transposed(point.m.numerators) * a);
  j.value = Fractions{square + density, point.m.denominator * point.m.denominator}.at(0);
  return j;
}

Indices shapes_with_mass(const Eigen::VectorXd& m) {
  Indices shapes;
  for (Eigen::Index j = 0; j < m.size(); ++j) {
    if (m[j] > 0.0) shapes.push_back(static_cast<std::size_t>(j));
  }
  return shapes;
}

Indices columns_between_bounds(const OtherColumns& others, const Eigen::VectorXd& x) {
  Indices columns;
  for (Eigen::Index k = 0; k < x.size(); ++k) {
    if (others.lower[k] < x[k] && x[k] < others.upper[k]) {
      columns.push_back(static_cast<std::size_t>(k));
    }
  }
  return columns;
}

}  // namespace

std::optional<Optimum> prove_optimum(const StatedProblem& stated, const Start& start) {
  const DyadicProblem p(stated);
  if (!zero_lambda(p) && p.Y.columns > most_parameters) return std::nullopt;
  const Indices columns = columns_between_bounds(stated.others, start.x);
  Indices shapes = shapes_with_mass(start.m);
  for (int set = 0; set < most_sets; ++set) {
    const auto point = zero_lambda(p) ? least_squares_point(p, shapes, columns, start)
                                      : even_point(p, shapes, columns, start.x);
    if (!point) return std::nullopt;
    Judgement judged = judge(stated, p, *point);
    if (judged.optimal) {
      return Optimum{point->m, point->x, judged.Phi, judged.value, set == 0};
    }
    if (zero_lambda(p) || judged.wanted == shapes) return std::nullopt;
    shapes = judged.wanted;
  }
  return std::nullopt;
}

}  // namespace shapeid::certificate
