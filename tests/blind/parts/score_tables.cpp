#include "shapeid/tests/blind/parts/score.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

namespace shapeid::blind {
namespace {

/// Of a foreign effect: something is said of it, and no wrong name.
bool is_described(Outcome o) {
  return o == Outcome::unexplained || o == Outcome::described || o == Outcome::ambiguous;
}

struct Count {
  int of[outcomes] = {};
  int all = 0;
  void add(Outcome o) {
    ++of[static_cast<int>(o)];
    ++all;
  }
  [[nodiscard]] int operator()(Outcome o) const { return of[static_cast<int>(o)]; }
  [[nodiscard]] int good() const { return (*this)(Outcome::right) + (*this)(Outcome::ambiguous); }
  [[nodiscard]] int bad() const { return (*this)(Outcome::wrong) + (*this)(Outcome::wrong_place); }
  [[nodiscard]] int described() const {
    int sum = 0;
    for (int o = 0; o < outcomes; ++o) {
      if (is_described(static_cast<Outcome>(o))) sum += of[o];
    }
    return sum;
  }
};

std::string row(const std::string& name, const Count& c) {
  std::string text = fmt::format("| {} |", name);
  for (const int n : c.of) text += n > 0 ? fmt::format(" {} |", n) : " |";
  return text + fmt::format(" {} |\n", c.all);
}

std::string header(const std::string& first) {
  std::string top = fmt::format("| {} |", first), line = "|---|";
  for (int o = 0; o < outcomes; ++o) {
    top += fmt::format(" {} |", name_of(static_cast<Outcome>(o)));
    line += "---|";
  }
  return top + " trials |\n" + line + "---|\n";
}

std::string share(const std::string& what, int hits, int count, const std::string& goal) {
  if (count == 0) return fmt::format("| {} | - | - | {} |\n", what, goal);
  const Bounds b = wilson(hits, count);
  return fmt::format("| {} | {} of {} | {:.1f} to {:.1f} % | {} |\n", what, hits, count,
                     100.0 * b.lower, 100.0 * b.upper, goal);
}

double least_ratio(const Trial& t) {
  double least = std::numeric_limits<double>::infinity();
  for (const Item& item : t.items) least = std::min(least, item.ratio);
  return least;
}

std::string kind_of(const Trial& t) {
  if (t.items.empty()) return "clean";
  return t.items.size() > 1 ? "two effects" : t.items.front().kind;
}

template <typename Key>
std::string table(const std::vector<Scored>& all, const std::string& first, const Key& key) {
  std::map<std::string, Count> rows;
  for (const Scored& s : all) {
    const std::string k = key(s.trial);
    if (!k.empty()) rows[k].add(s.judgement.outcome);
  }
  std::string text = header(first);
  for (const auto& [name, count] : rows) text += row(name, count);
  return text + "\n";
}

/// Of sorted values, the one that so large a share lies below.
double quantile(const std::vector<double>& sorted, double share) {
  return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
}

/// Reference logs come with a third of the trials that need none: what the diagnosis makes of
/// these.
std::string reference_rows(const std::vector<Scored>& all) {
  int unneeded = 0, without_load = 0, false_load = 0, others = 0, false_since = 0;
  int changes = 0, false_time = 0;
  for (const Scored& s : all) {
    const bool answered =
        s.judgement.outcome != Outcome::refused && s.judgement.outcome != Outcome::crashed;
    if (s.trial.acts != Acts::as_usual) {
      if (!answered || s.trial.items.empty()) continue;
      ++changes;
      if (s.judgement.false_time) ++false_time;
      continue;
    }
    if (!needs_reference(s.trial)) {
      ++without_load;
      if (s.trial.reference) ++unneeded;
      if (s.trial.reference && s.judgement.false_load) ++false_load;
    }
    if (!s.trial.reference || !answered || without_loads(s.trial.items).empty()) continue;
    ++others;
    if (s.judgement.false_since) ++false_since;
  }
  const std::string of_changes =
      share("an effect that came since the reference log or went said to act otherwise", false_time,
            changes, "none");
  return share("trials without a static load that had a reference log", unneeded, without_load,
               "a third") +
         share("of these a load named where there is none, be it as one of several names",
               false_load, unneeded, "<= 1 %") +
         share("an effect said to have come since a reference log that has it too", false_since,
               others, "none") +
         (changes > 0 ? of_changes : "");
}

/// How much is hidden behind "ambiguous": a diagnosis that lists the whole catalogue is never
/// wrong, and says nothing.
std::string set_row(const std::string& name, const std::vector<Scored>& all,
                    bool (*wanted)(const Trial&)) {
  std::vector<double> sizes;
  for (const Scored& s : all) {
    if (s.judgement.outcome != Outcome::ambiguous || !wanted(s.trial)) continue;
    sizes.push_back(static_cast<double>(s.judgement.set_size));
  }
  if (sizes.empty()) return fmt::format("| {} | 0 | - | - |\n", name);
  std::sort(sizes.begin(), sizes.end());
  return fmt::format("| {} | {} | {:g} | {:g} |\n", name, sizes.size(), quantile(sizes, 0.5),
                     sizes.back());
}

std::string set_table(const std::vector<Scored>& all) {
  return "Names besides the one that is said, in the largest set of each ambiguous answer:\n\n"
         "| | ambiguous | median | largest |\n|---|---|---|---|\n" +
         set_row("effects of the catalogue", all, [](const Trial& t) { return !is_foreign(t); }) +
         set_row("of these at twice the detectable size and above", all,
                 [](const Trial& t) { return !is_foreign(t) && least_ratio(t) >= 2.0; }) +
         set_row("foreign effects", all, [](const Trial& t) { return is_foreign(t); }) + "\n";
}

using ByUnit = std::array<double, 3> Judgement::Distance::*;

std::string inertia_row(const std::vector<Scored>& all, const std::string& name, std::size_t unit,
                        ByUnit part) {
  std::vector<double> given, found;
  int closer = 0;
  for (const Scored& s : all) {
    const double before = (s.judgement.given.*part)[unit], after = (s.judgement.found.*part)[unit];
    if (is_foreign(s.trial) || !(before > 0.0)) continue;
    given.push_back(before);
    found.push_back(after);
    if (after < before) ++closer;
  }
  if (given.empty()) return fmt::format("| {} | - | - | - | - | - | - |\n", name);
  std::sort(given.begin(), given.end());
  std::sort(found.begin(), found.end());
  return fmt::format("| {} | {:.3g} | {:.3g} | {:.3g} | {:.3g} | {:.3g} | {} of {} |\n", name,
                     quantile(given, 0.5), quantile(found, 0.5), quantile(given, 0.9),
                     quantile(found, 0.9), found.back(), closer, given.size());
}

/// How far inertias are from the truth before and after, each unit by itself.
std::string inertia_table(const std::vector<Scored>& all) {
  std::string text =
      "Distance of the inertias from the truth, root of the sum of squares over the links:\n\n"
      "| | given, median | found, median | given, 90 % below | found, 90 % below | found, largest "
      "| "
      "closer in |\n|---|---|---|---|---|---|---|\n";
  const std::array<const char*, 3> names = {"mass (kg)", "first moments (kg m)",
                                            "tensors (kg m^2)"};
  for (std::size_t unit = 0; unit < names.size(); ++unit) {
    const std::string name = names[unit];
    text += inertia_row(all, name, unit, &Judgement::Distance::all_by_unit);
    text += inertia_row(all, name + ", what is called determined", unit,
                        &Judgement::Distance::determined_by_unit);
  }
  return text + "\n";
}

std::string numbers(const std::vector<Scored>& all) {
  std::vector<double> ratio;
  std::vector<double> over_told;
  int closer = 0, compared = 0, determined_closer = 0, determined = 0, within_errors = 0,
      within_unnoticed = 0, told_closer = 0;
  constexpr double errors = 3.0;  // of some ten numbers each should be within them
  for (const Scored& s : all) {
    const Judgement& j = s.judgement;
    if (j.error_ratio > 0.0) ratio.push_back(j.error_ratio);
    if (is_foreign(s.trial)) continue;
    if (j.given.all > 0.0) ++compared;
    if (j.found.all < j.given.all) ++closer;
    if (j.told > 0.0) over_told.push_back(j.found.all / j.told);
    if (j.told > 0.0 && j.told < j.given.all) ++told_closer;
    if (!(j.given.determined > 0.0)) continue;
    ++determined;
    if (j.standard_errors <= errors) ++within_errors;
    if (j.errors_if_unnoticed <= errors) ++within_unnoticed;
    if (j.found.determined < j.given.determined) ++determined_closer;
  }
  std::sort(ratio.begin(), ratio.end());
  const auto within = static_cast<int>(
      std::count_if(ratio.begin(), ratio.end(), [](double r) { return r <= 1.1; }));
  std::string text = "| | seen | 95 % bounds | wanted |\n|---|---|---|---|\n";
  text += share("held-out error within 10 % of the model told the truth", within,
                static_cast<int>(ratio.size()), "all");
  text +=
      share("inertial parameters closer to the truth after than before", closer, compared, "all");
  text +=
      share("of these what the diagnosis calls determined", determined_closer, determined, "all");
  text += share(
      "closer to the truth by a model that is told the effects and how far given inertias are off "
      "as a rule",
      told_closer, static_cast<int>(over_told.size()), "");
  text += share("every number called determined within three standard errors of the truth",
                within_errors, determined, "");
  text += share("the same with errors that allow for an effect that was not noticed",
                within_unnoticed, determined, "");
  if (!ratio.empty()) {
    text += fmt::format(
        "\nHeld-out error over that of the model told the truth: median {:.3f}, "
        "largest {:.3f}.\n",
        ratio[ratio.size() / 2], ratio.back());
  }
  if (!over_told.empty()) {
    std::sort(over_told.begin(), over_told.end());
    text += fmt::format(
        "Distance of the inertias from the truth over that of the model told as much as said "
        "above: "
        "median {:.2f}, nine of ten below {:.2f}.\n",
        quantile(over_told, 0.5), quantile(over_told, 0.9));
  }
  return text + "\n" + inertia_table(all);
}

}  // namespace

Bounds wilson(int hits, int count) {
  if (count == 0) return {};
  constexpr double z = 1.959964;
  const double n = count, p = hits / n;
  const double middle = (p + z * z / (2.0 * n)) / (1.0 + z * z / n);
  const double half = z / (1.0 + z * z / n) * std::sqrt(p * (1.0 - p) / n + z * z / (4.0 * n * n));
  return {std::max(0.0, middle - half), std::min(1.0, middle + half)};
}

std::string tables(const std::vector<Scored>& all) {
  Count clean, at_twice, known, foreign, foreign_at_twice, any;
  int beside = 0, own_place = 0, own_place_at_twice = 0;
  for (const Scored& s : all) {
    const Outcome o = s.judgement.outcome;
    any.add(o);
    if (s.trial.items.empty()) {
      clean.add(o);
    } else if (is_foreign(s.trial)) {
      foreign.add(o);
      const bool large = least_ratio(s.trial) >= 2.0;
      if (large) foreign_at_twice.add(o);
      if (is_described(o) && s.judgement.at_its_place) {
        ++own_place;
        if (large) ++own_place_at_twice;
      }
    } else {
      known.add(o);
      if (least_ratio(s.trial) >= 2.0) at_twice.add(o);
      if (s.judgement.beside) ++beside;
    }
  }
  std::string text = "| | seen | 95 % bounds | wanted |\n|---|---|---|---|\n";
  text += share("right or honestly ambiguous, at twice the detectable size and above",
                at_twice.good(), at_twice.all, ">= 95 %");
  text += share("confidently wrong, any size", known.bad(), known.all, "<= 1 %");
  text += share("of these beside all that was there", beside, std::max(known.bad(), 0), "");
  text += share("a name on clean logs", clean.bad(), clean.all, "<= 1 %");
  text += share("something unexplained on clean logs", clean(Outcome::unexplained), clean.all,
                "<= 1 %");
  text += share("foreign effects unexplained or rightly described, at twice the detectable size",
                foreign_at_twice.described(), foreign_at_twice.all, ">= 90 %");
  text += share("of these with a name or something unexplained at the effect's own joint",
                own_place_at_twice, foreign_at_twice.described(), "");
  text += share("foreign effects unexplained or rightly described, any size", foreign.described(),
                foreign.all, "");
  text += share("of these with a name or something unexplained at the effect's own joint",
                own_place, foreign.described(), "");
  text += share("foreign effects given a wrong name, at twice the detectable size",
                foreign_at_twice.bad(), foreign_at_twice.all, "");
  text += share("the same, any size", foreign.bad(), foreign.all, "");
  text += share("the diagnosis crashed", any(Outcome::crashed), any.all, "none");
  text.append(reference_rows(all)).append("\n");
  text.append(set_table(all)).append(numbers(all));
  text += "By size (the smaller one of two), effects of the catalogue:\n\n";
  text += table(all, "times detectable", [](const Trial& t) {
    return t.items.empty() || is_foreign(t) ? "" : fmt::format("{:g}", least_ratio(t));
  });
  text += "By effect, at twice the detectable size and above:\n\n";
  text += table(all, "effect", [](const Trial& t) {
    // The smallest of no sizes is infinite, but nothing is not at twice a size.
    return t.items.empty() || is_foreign(t) || least_ratio(t) < 2.0 ? "" : kind_of(t);
  });
  text += "Effects that are not in the catalogue, all sizes:\n\n";
  text += table(all, "effect", [](const Trial& t) { return is_foreign(t) ? kind_of(t) : ""; });
  text += "By robot:\n\n";
  text += table(all, "robot", [](const Trial& t) {
    const std::string robot = t.machine.starts_with(drawn_prefix)       ? "drawn arm"
                              : t.machine.starts_with(quadruped_prefix) ? "drawn quadruped"
                                                                        : t.machine;
    return robot + (t.items.empty() ? ", clean" : is_foreign(t) ? ", foreign" : ", catalogue");
  });
  return text;
}

}  // namespace shapeid::blind
