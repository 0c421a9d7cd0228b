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
  std::string id, effect, site;
  std::vector<std::string> set;  ///< other names for it
  bool doubted = false;          ///< a law without a name is said to do as well
  bool since = false;            ///< it is said to have come since the reference log, no doubt
};

std::vector<Said> said_in(const json& result) {
  std::vector<Said> list;
  for (const json& f : result.at("findings")) {
    Said s;
    s.effect = f.at("effect").get<std::string>();
    s.site = f.at("site").get<std::string>();
    s.id = fmt::format("{}@{}", s.effect, s.site);
    if (f.contains("ambiguous_with")) s.set = f.at("ambiguous_with");
    s.doubted = f.contains("or_without_name");
    s.since = f.value("since_reference", false) && !f.value("may_act_in_both", false);
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

/// Which of the names stand for which of the items.
class Matching {
 public:
  Matching(const std::vector<std::string>& ids, const std::vector<Said>& said)
      : ids_(ids), said_(said), holder_(said.size(), nobody), exact_(said.size(), false) {
    // All exact names first: what an item is called by must not be taken before by another item
    // that is only in that name's set.
    std::vector<std::size_t> others;
    for (std::size_t item = 0; item < ids.size(); ++item) {
      if (!name_exactly(item)) others.push_back(item);
    }
    named_ = ids.size() - others.size();
    for (const std::size_t item : others) {
      std::vector<bool> asked = exact_;
      if (find_set(item, asked)) ++within_;
    }
  }

  [[nodiscard]] std::size_t named() const { return named_; }
  [[nodiscard]] std::size_t within() const { return within_; }
  [[nodiscard]] bool used(std::size_t name) const { return holder_[name] != nobody; }

 private:
  bool name_exactly(std::size_t item) {
    for (std::size_t i = 0; i < said_.size(); ++i) {
      if (used(i) || said_[i].id != ids_[item]) continue;
      holder_[i] = item;
      exact_[i] = true;
      return true;
    }
    return false;
  }

  /// By Kuhn's augmenting paths: whoever holds a name gives it up if there is another for it, so
  /// that as many items as can be have one, in whichever order they ask.
  bool find_set(std::size_t item, std::vector<bool>& asked) {
    for (std::size_t i = 0; i < said_.size(); ++i) {
      if (asked[i] || !in_set(said_[i], ids_[item])) continue;
      asked[i] = true;
      if (used(i) && !find_set(holder_[i], asked)) continue;
      holder_[i] = item;
      return true;
    }
    return false;
  }

  static constexpr std::size_t nobody = std::numeric_limits<std::size_t>::max();
  const std::vector<std::string>& ids_;
  const std::vector<Said>& said_;
  std::vector<std::size_t> holder_;  ///< the item that each name stands for
  std::vector<bool> exact_;
  std::size_t named_ = 0, within_ = 0;
};

std::vector<std::string> ids_of(const Machine& m, const Trial& trial) {
  std::vector<std::string> ids;
  for (const Item& item : trial.items) ids.push_back(id_of(m, item));
  return ids;
}

Outcome judge_known(const Machine& m, const Trial& trial, const std::vector<Said>& said,
                    bool structure, bool& beside) {
  const std::vector<std::string> ids = ids_of(m, trial);
  const Matching matching(ids, said);
  bool wrong = false, misplaced = false, excused = false;
  for (std::size_t i = 0; i < said.size(); ++i) {
    if (matching.used(i)) continue;
    // Of one cause several names may be said, each with the cause among what it cannot be told
    // from. That is honest, but not right: the reader is told of more than there is.
    if (std::any_of(ids.begin(), ids.end(),
                    [&](const std::string& id) { return in_set(said[i], id); })) {
      excused = true;
      continue;
    }
    const bool same = std::any_of(trial.items.begin(), trial.items.end(),
                                  [&](const Item& item) { return item.kind == said[i].effect; });
    (same ? misplaced : wrong) = true;
  }
  const std::size_t found = matching.named() + matching.within();
  const bool all = found == ids.size();
  beside = all && !ids.empty() && (wrong || misplaced);
  if (wrong) return Outcome::wrong;
  if (misplaced) return Outcome::wrong_place;
  if (all) return matching.within() > 0 || excused ? Outcome::ambiguous : Outcome::right;
  if (found > 0) return Outcome::partly;
  return structure ? Outcome::unexplained : Outcome::abstained;
}

bool is_load(const std::string& effect) {
  return std::any_of(kinds().begin(), kinds().end(),
                     [&](const Kind& k) { return k.load && k.id == effect; });
}

/// Whether something is said of the place where a foreign effect is.
bool is_at_its_place(const Machine& m, const Item& item, const std::vector<Said>& said,
                     const json& unexplained) {
  if (kind(item.kind).place != Place::joint) return !said.empty() || !unexplained.empty();
  const std::string joint = place_name(m, Place::joint, item.amount.site);
  return std::any_of(said.begin(), said.end(), [&](const Said& s) { return s.site == joint; }) ||
         std::any_of(unexplained.begin(), unexplained.end(),
                     [&](const json& entry) { return entry.at("joint") == joint; });
}

/// What a reference log tempts a diagnosis to say.
void judge_reference(const Machine& m, const Trial& trial, const std::vector<Said>& said,
                     Judgement& j) {
  const std::vector<std::string> ids = ids_of(m, trial);
  for (const Said& s : said) {
    const bool there = std::find(ids.begin(), ids.end(), s.id) != ids.end();
    if (is_load(s.effect)) {
      // A load on the wrong link is another fault, and one that needs no reference.
      const bool carried = std::any_of(trial.items.begin(), trial.items.end(),
                                       [&](const Item& item) { return item.kind == s.effect; });
      j.false_load = j.false_load || !carried;
    } else {
      j.false_since = j.false_since || (there && s.since);
    }
  }
}

/// An error of one of a link's numbers, over the link's mass and a decimetre.
double relative_error(double error, std::size_t unit, double mass) {
  constexpr double length = 0.1;
  return error / (mass * std::pow(length, unit));
}

/// Of the p-th of ten numbers: 0 kg, 1 kg m, 2 kg m^2.
std::size_t unit_of(std::size_t p) { return p == 0 ? 0 : p < 4 ? 1 : 2; }

Judgement::Distance distance(const Machine& m, const json& links, const std::string& which) {
  Judgement::Distance square;
  for (const json& entry : links) {
    const int link = *m.robot.find_link(entry.at("name"));
    const Vector10 truth = m.robot.links[static_cast<std::size_t>(link)].inertia.values;
    for (std::size_t p = 0; p < 10; ++p) {
      const std::size_t unit = unit_of(p);
      const double error =
          entry.at(which).at(p).get<double>() - truth[static_cast<Eigen::Index>(p)];
      const double relative = relative_error(error, unit, truth[0]);
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

/// Reference logs come with a third of the trials that need none: what the diagnosis makes of
/// these.
std::string reference_rows(const std::vector<Scored>& all) {
  int unneeded = 0, without_load = 0, false_load = 0, others = 0, false_since = 0;
  for (const Scored& s : all) {
    const bool answered =
        s.judgement.outcome != Outcome::refused && s.judgement.outcome != Outcome::crashed;
    if (!needs_reference(s.trial)) {
      ++without_load;
      if (s.trial.reference) ++unneeded;
      if (s.trial.reference && s.judgement.false_load) ++false_load;
    }
    if (!s.trial.reference || !answered || without_loads(s.trial.items).empty()) continue;
    ++others;
    if (s.judgement.false_since) ++false_since;
  }
  return share("trials without a static load that had a reference log", unneeded, without_load,
               "a third") +
         share("of these a load named where there is none, be it as one of several names",
               false_load, unneeded, "<= 1 %") +
         share("an effect said to have come since a reference log that has it too", false_since,
               others, "none");
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

double distance_from_truth(const Machine& m, const std::vector<InertialParameters>& inertias) {
  double sum = 0.0;
  for (std::size_t i = 0; i < inertias.size(); ++i) {
    const auto link = static_cast<std::size_t>(m.free_links[i]);
    const Vector10 truth = m.robot.links[link].inertia.values;
    for (std::size_t p = 0; p < 10; ++p) {
      const auto at = static_cast<Eigen::Index>(p);
      const double error = inertias[i].values[at] - truth[at];
      sum += std::pow(relative_error(error, unit_of(p), truth[0]), 2);
    }
  }
  return std::sqrt(sum);
}

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
    case Outcome::crashed:
      return "crashed";
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
  if (is_foreign(trial)) {
    j.at_its_place = is_at_its_place(m, trial.items.front(), said, result.at("unexplained"));
  }
  judge_reference(m, trial, said, j);
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
