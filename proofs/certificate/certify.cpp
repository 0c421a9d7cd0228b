#include "shapeid/proofs/certificate/certify.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "shapeid/models/inertia.hpp"
#include "shapeid/models/strict_json.hpp"
#include "shapeid/proofs/certificate/bound.hpp"
#include "shapeid/proofs/certificate/cone.hpp"
#include "shapeid/proofs/certificate/geometry.hpp"
#include "shapeid/proofs/certificate/optimum.hpp"

namespace shapeid::certificate {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// 0: kg, 1: kg m, 2: kg m^2.
Eigen::Index group_of(std::size_t parameter) {
  const std::size_t place = parameter % 10;
  return place == 0 ? 0 : (place < 4 ? 1 : 2);
}

/// A number for people to read, which may be larger than a double can be.
std::string words(const Rational& x) {
  const double nearest = x.get_d();
  if (std::isfinite(nearest)) return fmt::format("{}", nearest);
  return sgn(x) > 0 ? "larger than any double" : "below any double";
}

class Certifier {
 public:
  Certifier(const StatedProblem& stated, const Answer& answer, const Tolerance& tolerance)
      : stated_(stated), answer_(answer), tolerance_(tolerance), p_(stated) {}

  Certified run(const Evidence& evidence) {
    result_.proof.problem_digest = problem_digest(stated_);
    result_.proof.answer_digest = digest(answer_to_json(answer_));
    if (answer_.problem_digest != result_.proof.problem_digest) {
      reject("answers another problem: digest {}, this problem's is {}", answer_.problem_digest,
             result_.proof.problem_digest);
    }
    zero_objective_ = p_.data_term(p_.F);
    x_ = exact(answer_.others);
    find_masses();
    check_bounds();
    check_claims();
    prove_interval();
    for (std::size_t i = 0; i < Phi_.size(); i += 10) {
      const auto at = Phi_.begin() + static_cast<std::ptrdiff_t>(i);
      result_.proof.bodies.push_back(existence(Vector(at, at + 10)));
    }
    order_relaxations(evidence);
    check_columns();
    return result_;
  }

 private:
  template <class... Arguments>
  void reject(fmt::format_string<Arguments...> text, Arguments&&... arguments) {
    result_.reasons.push_back(fmt::format(text, std::forward<Arguments>(arguments)...));
  }

  /// Else the answer is of parameters alone.
  [[nodiscard]] bool masses_given() const { return answer_.masses.size() > 0 || p_.shapes() == 0; }

  /// The answer's masses; or, of parameters alone, the nearest that the shapes can make.
  void find_masses() {
    Proof& proof = result_.proof;
    if (masses_given()) {
      m_ = exact(answer_.masses);
      proof.made_of_shapes = std::ranges::all_of(m_, [](const Rational& m) { return sgn(m) >= 0; });
    } else {
      NearestBody nearest = nearest_body(stated_.masses, answer_.parameters);
      m_ = std::move(nearest.m);
      proof.made_of_shapes = sgn(nearest.square_distance) == 0;
      if (!proof.made_of_shapes) {
        proof.plane.resize(static_cast<Eigen::Index>(nearest.plane.size()));
        for (Eigen::Index i = 0; i < proof.plane.size(); ++i) {
          proof.plane[i] = nearest.plane[static_cast<std::size_t>(i)].get_d();
        }
      }
    }
    Phi_ = p_.U.times(m_);
    if (masses_given()) {
      for (std::size_t i = 0; i < Phi_.size(); ++i) {
        proof.made_of_shapes = proof.made_of_shapes && exact(claimed(i)) == Phi_[i];
      }
    }
  }

  void check_bounds() {
    const std::size_t before = result_.reasons.size();
    for (std::size_t j = 0; j < m_.size(); ++j) {
      if (sgn(m_[j]) < 0) reject("mass {} is negative: {} kg", j, words(m_[j]));
    }
    for (std::size_t k = 0; k < x_.size(); ++k) {
      if ((p_.lower[k] && x_[k] < *p_.lower[k]) || (p_.upper[k] && x_[k] > *p_.upper[k])) {
        reject("column {} is beyond its bounds: {}", k, words(x_[k]));
      }
    }
    if (p_.mass_bound && sum(m_) > *p_.mass_bound) {
      reject("the masses' sum in kg is {}, the problem declares no more than {}", words(sum(m_)),
             words(*p_.mass_bound));
    }
    result_.proof.feasible = result_.reasons.size() == before;
  }

  [[nodiscard]] double claimed(std::size_t parameter) const {
    return answer_.parameters[static_cast<Eigen::Index>(parameter)];
  }

  void check_claims() {
    r_ = p_.residual(Phi_, x_);
    f_ = p_.data_term(r_) + p_.density_term(m_);
    const SparseRows sizes(stated_.masses.U.cwiseAbs());
    Vector weights;
    for (const Rational& mass : m_) weights.emplace_back(abs(mass));
    const Vector terms = sizes.times(weights);
    const Rational rounding = exact(tolerance_.rounding);
    for (std::size_t i = 0; i < Phi_.size(); ++i) {
      if (abs(exact(claimed(i)) - Phi_[i]) <= rounding * terms[i]) continue;
      reject("parameter {}, {} of free link {}, is said to be {}, {} {}", i,
             parameter_names[i % 10], i / 10, claimed(i),
             masses_given() ? "the masses make it" : "the nearest body of the shapes has",
             words(Phi_[i]));
    }
    // Parameters alone have no density term: which masses they are of is the checker's choice.
    if (!masses_given()) return;
    // A residual that is off by rounding times |W^(1/2) F| changes its square by no more than this.
    const Rational root = root_above(zero_objective_) * rounding;
    const Rational allowed = 2 * root_above(f_) * root + root * root;
    if (abs(exact(answer_.objective) - f_) > allowed) {
      reject("the objective is said to be {}, the answer's is {}", answer_.objective, words(f_));
    }
  }

  void prove_interval() {
    Proof& proof = result_.proof;
    proof.objective_above = rounded_up(f_);
    if (!result_.proof.feasible) {
      proof.lower = 0.0;  // a sum of squares
      proof.upper = proof.gap = proof.mass_distance = infinity;
      proof.mass_bound = p_.mass_bound ? rounded_up(*p_.mass_bound) : infinity;
      proof.mass_bound_declared = p_.mass_bound.has_value();
      proof.parameter_distance.setConstant(infinity);
      return;
    }
    const MassBound bound = mass_bound(stated_, p_, f_);
    proof.mass_bound = bound.M ? rounded_up(*bound.M) : infinity;
    proof.mass_bound_declared = bound.declared;
    const auto optimum = prove_optimum(stated_, start());
    Rational gap;
    if (optimum) {
      proof.optimum_known = true;
      proof.free_set_right = masses_given() && optimum->same;
      proof.lower = rounded_down(optimum->value);
      proof.upper = rounded_up(optimum->value);
      shapes_ = {optimum->value, optimum->value};
      gap = f_ - optimum->value;
    } else {
      const auto lower = lower_bound(p_, p_.residual(Phi_, settled_columns(p_, Phi_, x_)), bound.M);
      const Rational floor = lower ? std::max<Rational>(0, *lower) : Rational(0);
      proof.lower = rounded_down(floor);
      proof.upper = rounded_up(f_);
      shapes_ = {floor, f_};
      gap = f_ - floor;
    }
    proof.gap = rounded_up(gap);
    measure_distances(optimum, gap);
    const Rational accepted = exact(tolerance_.gap) * zero_objective_;
    if (gap > accepted) {
      const std::string above = std::isfinite(proof.gap)
                                    ? fmt::format("{}{:.3g}", optimum ? "" : "up to ", proof.gap)
                                    : "farther than any double says";
      reject("the objective is {} above the optimum, up to {:.3g} is accepted", above,
             rounded_down(accepted));
    }
  }

  void order_relaxations(const Evidence& evidence) {
    const Relaxations proved = relaxations(stated_, evidence, shapes_);
    Ordered& of = result_.proof.relaxations;
    of.masses = between(proved.masses);
    of.bodies = between(proved.bodies);
    of.divisions = between(proved.divisions);
    of.apart = {apart(proved.masses, proved.bodies), apart(proved.bodies, proved.divisions),
                apart(proved.divisions, proved.shapes)};
    if (sgn(proved.divisions.lower) > 0) result_.proof.floor = of.divisions.lower;
  }

  void check_columns() {
    const Geometry found = check_geometry(stated_, exact(tolerance_.rounding));
    result_.proof.columns = {found.declared, found.agree, found.inside};
    if (!found.first_disagreement.empty()) {
      reject("the problem contradicts itself: {}", found.first_disagreement);
    }
  }

  static Between between(const Interval& interval) {
    return {rounded_down(interval.lower), interval.upper ? rounded_up(*interval.upper) : infinity};
  }

  static bool apart(const Interval& below, const Interval& above) {
    return below.upper && *below.upper < above.lower;
  }

  /// Where a search for the exact optimum starts: the answer. Of parameters alone their slopes say
  /// which shapes would have mass, if there is a density term to make them unique.
  [[nodiscard]] Start start() const {
    Eigen::VectorXd m = answer_.masses;
    if (m.size() == 0) {
      m.resize(static_cast<Eigen::Index>(m_.size()));
      const Vector a = slopes(p_, p_.residual(exact(answer_.parameters), x_)).a;
      for (std::size_t j = 0; j < m_.size(); ++j) {
        const double slope_says = sgn(a[j]) < 0 ? 1.0 : 0.0;
        m[static_cast<Eigen::Index>(j)] = sgn(p_.lambda) > 0 ? slope_says : rounded_down(m_[j]);
      }
    }
    return {m, answer_.others};
  }

  /// From the optimum where it is known; else f is strongly convex in W^(1/2) Y U m and in
  /// (lambda / V)^(1/2) m: lambda sum (m - m*)^2 / V <= gap.
  void measure_distances(const std::optional<Optimum>& optimum, const Rational& gap) {
    Proof& proof = result_.proof;
    proof.mass_distance = 0.0;
    proof.parameter_distance.setZero();
    const bool unique = sgn(p_.lambda) > 0;
    if (!unique && sgn(gap) > 0) {
      proof.mass_distance = infinity;
      proof.parameter_distance.setConstant(infinity);
      return;
    }
    const auto misstated = [&](std::size_t i) -> Rational {  // parameters, against the masses'
      return abs(exact(claimed(i)) - Phi_[i]);
    };
    if (!unique) {
      for (std::size_t i = 0; i < Phi_.size(); ++i) widen(group_of(i), rounded_up(misstated(i)));
      return;
    }
    if (!optimum) {
      const Rational by_volume = gap / p_.lambda;
      if (!p_.V.empty()) {
        const Rational largest = *std::max_element(p_.V.begin(), p_.V.end());
        proof.mass_distance = rounded_up(root_above(by_volume * largest));
      }
      // Cauchy: (sum_j U_ij d_j)^2 <= (sum_j U_ij^2 V_j) (sum_j d_j^2 / V_j).
      const Vector squares = p_.U.squared().times(p_.V);
      for (std::size_t i = 0; i < squares.size(); ++i) {
        widen(group_of(i), rounded_up(root_above(by_volume * squares[i]) + misstated(i)));
      }
      return;
    }
    for (std::size_t j = 0; j < m_.size(); ++j) {
      const double apart = rounded_up(abs(m_[j] - optimum->m.at(j)));
      proof.mass_distance = std::max(proof.mass_distance, apart);
    }
    for (std::size_t i = 0; i < Phi_.size(); ++i) {
      widen(group_of(i), rounded_up(abs(exact(claimed(i)) - optimum->Phi.at(i))));
    }
  }

  void widen(Eigen::Index group, double distance) {
    double& widest = result_.proof.parameter_distance[group];
    widest = std::max(widest, distance);
  }

  const StatedProblem& stated_;
  const Answer& answer_;
  Tolerance tolerance_;
  ExactProblem p_;
  Vector m_, x_, Phi_, r_;
  Rational f_, zero_objective_;
  Interval shapes_;  ///< of the optimum
  Certified result_;
};

}  // namespace

Violation why_unfit(const StatedProblem& p, const Answer& answer) {
  if (answer.masses.size() != 0 && answer.masses.size() != p.masses.shapes()) {
    return fmt::format("{} masses for {} shapes", answer.masses.size(), p.masses.shapes());
  }
  if (answer.parameters.size() != p.masses.U.rows()) {
    return fmt::format("{} parameters, the problem has {}", answer.parameters.size(),
                       p.masses.U.rows());
  }
  if (answer.others.size() != p.others.values.cols()) {
    return fmt::format("{} columns, the problem has {}", answer.others.size(),
                       p.others.values.cols());
  }
  const bool finite = answer.masses.allFinite() && answer.parameters.allFinite() &&
                      answer.others.allFinite() && std::isfinite(answer.objective);
  if (!finite) return "a number of the answer is not finite";
  return std::nullopt;
}

Certified certify(const StatedProblem& problem, const Answer& answer, const Tolerance& tolerance,
                  const Evidence& evidence) {
  return Certifier(problem, answer, tolerance).run(evidence);
}

}  // namespace shapeid::certificate
