#include "shapeid/app/certificate_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "shapeid/models/text.hpp"

namespace shapeid::app {
namespace {

using certificate::Existence;
using certificate::Proof;

/// Bytes of a reason.
constexpr std::size_t longest_reason = 400;

std::string bodies_text(const Proof& p) {
  const auto count = [&](Existence wanted) {
    return std::count(p.bodies.begin(), p.bodies.end(), wanted);
  };
  return fmt::format(
      "bodies of the free links: {} exist with volume, {} on the edge, {} cannot exist\n",
      count(Existence::definite), count(Existence::semidefinite), count(Existence::impossible));
}

/// With masses >= 0 bodies that cannot exist are the columns' doing.
std::string no_bodies_text(const Proof& p) {
  const bool exist =
      std::find(p.bodies.begin(), p.bodies.end(), Existence::impossible) == p.bodies.end();
  if (exist || !p.feasible) return "";
  return "some column of U, as written, is no body's; it counts beside bodies and regions\n";
}

std::string where_from(const Proof& p) {
  if (p.optimum_known) {
    return p.free_set_right ? "solved exactly on the answer's own free set"
                            : "solved exactly on a free set that the slopes named";
  }
  return "by duality";
}

/// What is proved of a number whose bound may be infinite: then there is none.
std::string at_most(double bound, const char* unit) {
  return std::isfinite(bound) ? fmt::format("{:.3g}{}", bound, unit) : std::string("not bounded");
}

std::string optimum_text(const Proof& p) {
  if (!std::isfinite(p.upper))
    return fmt::format("{:.17g} or more, nothing else is proved", p.lower);
  return fmt::format("in [{:.17g}, {:.17g}], {}", p.lower, p.upper, where_from(p));
}

std::string distance_text(const Proof& p) {
  const std::string masses =
      std::isfinite(p.mass_distance)
          ? fmt::format("no mass is farther than {:.3g} kg from an optimum's", p.mass_distance)
          : "how far masses are from an optimum's is not bounded";
  const Eigen::Vector3d& of = p.parameter_distance;
  if (of.array().isInf().all()) return masses + ", nor is it of parameters";
  return fmt::format("{}; parameters: {}, {}, {}", masses, at_most(of[0], " kg"),
                     at_most(of[1], " kg m"), at_most(of[2], " kg m^2"));
}

std::string mass_bound_text(const Proof& p) {
  if (!std::isfinite(p.mass_bound)) return "none declared, none proved";
  return fmt::format("{:.6g} kg, {}", p.mass_bound,
                     p.mass_bound_declared ? "declared by the problem" : "proved from the rows");
}

std::string columns_text(const Proof& p) {
  const certificate::Columns& c = p.columns;
  if (c.declared == 0) {
    return "no shapes are stated: that the columns are shapes in the regions is taken on trust\n";
  }
  return fmt::format(
      "{} of {} columns are what their shapes make; {} shapes are shown to lie in the regions\n",
      c.agree, c.declared, c.inside);
}

/// Larger sets have smaller optima; what the numbers add is how far they are apart.
std::string relaxations_text(const Proof& p) {
  const certificate::Ordered& of = p.relaxations;
  if (!std::isfinite(of.bodies.upper)) return "";
  const auto line = [](const char* set, double lower, double upper, const char* next) {
    return fmt::format("  {:<36}[{:.17g}, {:.17g}]{}\n", set, lower, upper, next);
  };
  const auto relation = [&](std::size_t k) {
    return of.apart[k] ? "  less than the next, proved by the numbers"
                       : "  at most the next: it asks less";
  };
  return "least data terms, in the proved order of their sets:\n" +
         line("parameters with no negative mass", of.masses.lower, of.masses.upper, relation(0)) +
         line("bodies that can exist", of.bodies.lower, of.bodies.upper, relation(1)) +
         line("mass anywhere in the regions", of.divisions.lower, of.divisions.upper, relation(2)) +
         line("the shapes, with the density term", p.lower, p.upper, "");
}

}  // namespace

std::string certified_text(const certificate::Certified& certified) {
  const Proof& p = certified.proof;
  std::string text = fmt::format(
      "{}\n"
      "objective of the answer: {}\n"
      "optimum: {}\n"
      "gap: {}; {}\n"
      "mass bound: {}\n",
      certified.reasons.empty() ? "accepted" : "rejected",
      std::isfinite(p.objective_above) ? fmt::format("at most {:.17g}", p.objective_above)
                                       : "larger than any double",
      optimum_text(p), std::isfinite(p.gap) ? fmt::format("at most {:.3g}", p.gap) : "none proved",
      distance_text(p), mass_bound_text(p));
  text += bodies_text(p);
  text += columns_text(p);
  text += no_bodies_text(p);
  if (!p.made_of_shapes) {
    text += p.plane.size() > 0
                ? "the parameters as written are not made of the shapes: a plane separates them\n"
                : "the parameters as written are not exactly the masses', or a mass is negative\n";
  }
  if (p.floor) {
    text += fmt::format("floor of infinitely many divisions: {:.17g}; the answer is {} above it\n",
                        *p.floor, at_most(p.objective_above - *p.floor, ""));
  }
  text += relaxations_text(p);
  // A reason may quote the answer.
  for (const std::string& reason : certified.reasons) {
    text += "reason: " + one_line(reason, longest_reason) + "\n";
  }
  return text;
}

}  // namespace shapeid::app
