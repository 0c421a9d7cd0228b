#include "shapeid/tests/blind/parts/score.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

namespace shapeid::blind {
namespace {

using nlohmann::json;

std::string id_of(const Machine& m, const Item& item) {
  return fmt::format("{}@{}", item.kind, place_name(m, kind(item.kind).place, item.amount.site));
}

struct Said {
  std::string id, effect;
  std::vector<std::string> set;  ///< other names for it
  bool doubted = false;          ///< a law without a name is said to do as well
};

std::vector<Said> said_in(const json& result) {
  std::vector<Said> list;
  for (const json& f : result.at("findings")) {
    Said s;
    s.effect = f.at("effect").get<std::string>();
    s.id = fmt::format("{}@{}", s.effect, f.at("site").get<std::string>());
    if (f.contains("ambiguous_with")) s.set = f.at("ambiguous_with");
    s.doubted = f.contains("or_without_name");
    list.push_back(s);
  }
  return list;
}

bool in_set(const Said& s, const std::string& id) {
  return std::find(s.set.begin(), s.set.end(), id) != s.set.end();
}

Outcome judge_foreign(const Machine& m, const Item& item, const std::vector<Said>& said,
                      bool structure) {
  const Kind& k = kind(item.kind);
  const std::string site = place_name(m, k.place, item.amount.site);
  bool doubted = false;
  for (const Said& s : said) {
    const bool described =
        std::any_of(k.described_by.begin(), k.described_by.end(), [&](const std::string& effect) {
          const std::string id = fmt::format("{}@{}", effect, site);
          return s.id == id || in_set(s, id);
        });
    if (!described && !s.doubted) return Outcome::wrong;
    doubted = doubted || !described;
  }
  if (doubted) return Outcome::ambiguous;
  if (!said.empty()) return Outcome::described;
  return structure ? Outcome::unexplained : Outcome::abstained;
}

Outcome judge_known(const Machine& m, const Trial& trial, const std::vector<Said>& said,
                    bool structure, bool& beside) {
  std::size_t named = 0, within = 0;
  std::vector<bool> used(said.size(), false);
  for (const Item& item : trial.items) {
    const std::string id = id_of(m, item);
    std::size_t at = said.size();
    for (std::size_t i = 0; i < said.size() && at == said.size(); ++i) {
      if (said[i].id == id) at = i;
    }
    if (at < said.size()) {
      ++named;
      used[at] = true;
      continue;
    }
    for (std::size_t i = 0; i < said.size() && at == said.size(); ++i) {
      if (!used[i] && in_set(said[i], id)) at = i;
    }
    if (at < said.size()) {
      ++within;
      used[at] = true;
    }
  }
  bool wrong = false, misplaced = false;
  for (std::size_t i = 0; i < said.size(); ++i) {
    // Of one cause several names may be said, each with the cause among what it cannot be told
    // from.
    const bool within_set =
        std::any_of(trial.items.begin(), trial.items.end(),
                    [&](const Item& item) { return in_set(said[i], id_of(m, item)); });
    if (used[i] || within_set) continue;
    const bool same = std::any_of(trial.items.begin(), trial.items.end(),
                                  [&](const Item& item) { return item.kind == said[i].effect; });
    (same ? misplaced : wrong) = true;
  }
  const bool all = named + within == trial.items.size();
  beside = all && !trial.items.empty();
  if (wrong) return Outcome::wrong;
  if (misplaced) return Outcome::wrong_place;
  if (all) return within > 0 ? Outcome::ambiguous : Outcome::right;
  if (named + within > 0) return Outcome::partly;
  return structure ? Outcome::unexplained : Outcome::abstained;
}

Judgement::Distance distance(const Machine& m, const json& links, const std::string& which) {
  constexpr double length = 0.1;
  Judgement::Distance square;
  for (const json& entry : links) {
    const int link = *m.robot.find_link(entry.at("name"));
    const Vector10 truth = m.robot.links[static_cast<std::size_t>(link)].inertia.values;
    for (std::size_t p = 0; p < 10; ++p) {
      const std::size_t unit = p == 0 ? 0 : p < 4 ? 1 : 2;
      const double error =
          entry.at(which).at(p).get<double>() - truth[static_cast<Eigen::Index>(p)];
      const double relative = error / (truth[0] * std::pow(length, unit));
      square.all += relative * relative;
      square.all_by_unit[unit] += error * error;
      if (!entry.at("determined").at(p).get<bool>()) continue;
      square.determined += relative * relative;
      square.determined_by_unit[unit] += error * error;
    }
  }
  const auto root = [](std::array<double, 3> x) {
    for (double& entry : x) entry = std::sqrt(entry);
    return x;
  };
  return {std::sqrt(square.all), std::sqrt(square.determined), root(square.all_by_unit),
          root(square.determined_by_unit)};
}

/// The largest error of a number that is called determined, in units of the error that `which`
/// says.
double most_errors(const Machine& m, const json& links, const std::string& which) {
  double most = 0.0;
  for (const json& entry : links) {
    const int link = *m.robot.find_link(entry.at("name"));
    const Vector10 truth = m.robot.links[static_cast<std::size_t>(link)].inertia.values;
    for (std::size_t p = 0; p < 10; ++p) {
      if (!entry.at("determined").at(p).get<bool>()) continue;
      const double error =
          entry.at("parameters").at(p).get<double>() - truth[static_cast<Eigen::Index>(p)];
      most = std::max(most, std::abs(error) / entry.at(which).at(p).get<double>());
    }
  }
  return most;
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

bool is_foreign(const Trial& t) { return !t.items.empty() && kind(t.items.front().kind).foreign; }

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
  int closer = 0, compared = 0, determined_closer = 0, determined = 0, within_errors = 0,
      within_unnoticed = 0;
  constexpr double errors = 3.0;  // of some ten numbers each should be within them
  for (const Scored& s : all) {
    const Judgement& j = s.judgement;
    if (j.error_ratio > 0.0) ratio.push_back(j.error_ratio);
    if (is_foreign(s.trial)) continue;
    if (j.given.all > 0.0) ++compared;
    if (j.found.all < j.given.all) ++closer;
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
  return text + "\n" + inertia_table(all);
}

}  // namespace

std::string name_of(Outcome outcome) {
  switch (outcome) {
    case Outcome::right:
      return "right";
    case Outcome::ambiguous:
      return "ambiguous";
    case Outcome::partly:
      return "partly";
    case Outcome::described:
      return "described";
    case Outcome::unexplained:
      return "unexplained";
    case Outcome::abstained:
      return "abstained";
    case Outcome::refused:
      return "refused";
    case Outcome::wrong_place:
      return "wrong place";
    case Outcome::wrong:
      break;
  }
  return "wrong";
}

Judgement judge(const Trial& trial, const json& result) {
  Judgement j;
  if (result.is_null()) {
    j.outcome = Outcome::refused;
    return j;
  }
  const Machine m = machine(trial.machine);
  const std::vector<Said> said = said_in(result);
  for (const Said& s : said) {
    j.said += (j.said.empty() ? "" : ", ") + s.id;
    if (!s.set.empty()) j.said += fmt::format(" (or {} others)", s.set.size());
    if (s.doubted) j.said += " (or no name)";
    j.set_size = std::max(j.set_size, s.set.size());
  }
  const bool structure = !result.at("unexplained").empty();
  j.outcome = is_foreign(trial) ? judge_foreign(m, trial.items.front(), said, structure)
                                : judge_known(m, trial, said, structure, j.beside);
  if (trial.items.empty() && said.empty()) {
    j.outcome = structure ? Outcome::unexplained : Outcome::right;
  }
  const json& links = result.at("links");
  j.given = distance(m, links, "given");
  j.found = distance(m, links, "parameters");
  j.standard_errors = most_errors(m, links, "standard_error");
  j.errors_if_unnoticed = most_errors(m, links, "error_if_unnoticed");
  return j;
}

Bounds wilson(int hits, int count) {
  if (count == 0) return {};
  constexpr double z = 1.959964;
  const double n = count, p = hits / n;
  const double middle = (p + z * z / (2.0 * n)) / (1.0 + z * z / n);
  const double half = z / (1.0 + z * z / n) * std::sqrt(p * (1.0 - p) / n + z * z / (4.0 * n * n));
  return {std::max(0.0, middle - half), std::min(1.0, middle + half)};
}

std::string tables(const std::vector<Scored>& all) {
  Count clean, at_twice, known, foreign, foreign_at_twice;
  int beside = 0;
  for (const Scored& s : all) {
    const Outcome o = s.judgement.outcome;
    if (s.trial.items.empty()) {
      clean.add(o);
    } else if (is_foreign(s.trial)) {
      foreign.add(o);
      if (least_ratio(s.trial) >= 2.0) foreign_at_twice.add(o);
    } else {
      known.add(o);
      if (least_ratio(s.trial) >= 2.0) at_twice.add(o);
      if (s.judgement.beside && (o == Outcome::wrong || o == Outcome::wrong_place)) ++beside;
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
  const auto described = [](const Count& c) {
    return c(Outcome::unexplained) + c(Outcome::described) + c(Outcome::ambiguous);
  };
  text += share("foreign effects unexplained or rightly described, at twice the detectable size",
                described(foreign_at_twice), foreign_at_twice.all, ">= 90 %");
  text += share("the same, any size", described(foreign), foreign.all, "");
  text += share("foreign effects given a wrong name, at twice the detectable size",
                foreign_at_twice.bad(), foreign_at_twice.all, "");
  text += share("the same, any size", foreign.bad(), foreign.all, "");
  text.append("\n").append(numbers(all));
  text += "By size (the smaller one of two), effects of the catalogue:\n\n";
  text += table(all, "times detectable", [](const Trial& t) {
    return t.items.empty() || is_foreign(t) ? "" : fmt::format("{:g}", least_ratio(t));
  });
  text += "By effect, at twice the detectable size and above:\n\n";
  text += table(all, "effect", [](const Trial& t) {
    return is_foreign(t) || least_ratio(t) < 2.0 ? "" : kind_of(t);
  });
  text += "Effects that are not in the catalogue, all sizes:\n\n";
  text += table(all, "effect", [](const Trial& t) { return is_foreign(t) ? kind_of(t) : ""; });
  text += "By robot:\n\n";
  text += table(all, "robot", [](const Trial& t) {
    return t.machine + (t.items.empty() ? ", clean" : is_foreign(t) ? ", foreign" : ", catalogue");
  });
  return text;
}

}  // namespace shapeid::blind
