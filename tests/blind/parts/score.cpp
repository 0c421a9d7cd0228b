#include "shapeid/tests/blind/parts/score.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

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
  std::vector<Acts> acts;        ///< as it is said to, or may as well
};

/// What is said to be gone for sure is no name of anything in a trial where nothing went.
std::vector<Said> said_in(const json& result, bool something_went) {
  std::vector<Said> list;
  for (const json& f : result.at("findings")) {
    Said s;
    s.effect = f.at("effect").get<std::string>();
    s.site = f.at("site").get<std::string>();
    s.id = fmt::format("{}@{}", s.effect, s.site);
    if (f.contains("ambiguous_with")) s.set = f.at("ambiguous_with");
    s.doubted = f.contains("or_without_name");
    const bool since = f.value("since_reference", false);
    const bool gone = f.value("gone_since_reference", false);
    const bool in_both = f.value("may_act_in_both", false);
    const bool may_since = f.value("may_have_come_since", false);
    s.since = since && !in_both;
    if (since || may_since) s.acts.push_back(Acts::in_log);
    if (gone || f.value("may_have_gone_since", false)) s.acts.push_back(Acts::in_reference);
    if (gone && !in_both && !may_since && !something_went) s.id += " (gone)";
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
    if (trial.acts != Acts::as_usual && there && std::ranges::count(s.acts, trial.acts) == 0) {
      j.false_time = true;
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

bool is_foreign(const Trial& t) { return !t.items.empty() && kind(t.items.front().kind).foreign; }

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
  const std::vector<Said> said = said_in(result, trial.acts == Acts::in_reference);
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

}  // namespace shapeid::blind
