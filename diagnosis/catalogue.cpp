#include <fmt/format.h>

#include <cmath>

#include "shapeid/diagnosis/effects.hpp"

namespace shapeid::diagnosis {
namespace {

std::string kind_name(SiteKind kind) {
  switch (kind) {
    case SiteKind::joint:
      return "a joint";
    case SiteKind::link:
      return "a link";
    case SiteKind::accelerometer:
      return "`base.accel`";
    case SiteKind::contact:
      return "a contact";
    case SiteKind::whole:
      break;
  }
  return "`all`";
}

std::string parameter_text(const Effect& e) {
  std::string text;
  for (const Parameter& p : e.parameters) {
    text += fmt::format(
        "{}{} ({}{}{})", text.empty() ? "" : ", ", p.name, p.unit, p.nonnegative ? ", >= 0" : "",
        std::isfinite(p.limit) ? fmt::format(", believed up to {:g}", p.limit) : "");
  }
  for (const ShapeNumber& s : e.shape) {
    text += fmt::format("; {} ({}, {:g} to {:g})", s.name, s.unit, s.lower, s.upper);
  }
  return text;
}

std::string entry(const Effect& e) {
  std::string confused;
  for (const std::string& other : e.confused_with) {
    confused += (confused.empty() ? "" : ", ") + other;
  }
  return fmt::format(
      "## {}\n\n{}. Site: {}.\n\n    {}\n\n* Parameters: {}\n* Confused with: {}\n* Separated "
      "by: {}\n* Contact projection: {}\n* Source: {}\n\n",
      e.id, e.title, kind_name(e.site), e.equation, parameter_text(e), confused, e.separate_by,
      e.under_contact, e.source);
}

}  // namespace

std::string catalogue_page() {
  std::string page =
      "# Effects\n\n"
      "What `shapeid diagnose` can find besides rigid links; printed by `shapeid diagnose "
      "--list`.\n"
      "An effect adds to the torque that the joints must provide, or changes what it is computed\n"
      "from. Ids and parameter names are stable: results, `effects.yaml` and tests use them. "
      "Numbers\n"
      "after a semicolon are searched for, within their range; the others enter linearly or by\n"
      "Gauss-Newton steps.\n\n";
  for (const Effect& e : all_effects()) page += entry(e);
  page.pop_back();
  return page;
}

}  // namespace shapeid::diagnosis
