// What a diagnosis said against what was there.
#pragma once

#include <array>
#include <nlohmann/json.hpp>

#include <string>
#include <vector>

#include "shapeid/tests/blind/parts/trial.hpp"

namespace shapeid::blind {

enum class Outcome {
  right,      ///< every item by name and place, nothing else (clean: nothing at all)
  ambiguous,  ///< likewise, some item within the set of names that are said to be inseparable, or
              ///< more names, each with an item in its set; a foreign effect by a name beside which
              ///< a law without a name is said to do as well
  partly,     ///< of two items one, nothing wrong
  described,  ///< a foreign effect by the part of it that the catalogue has
  unexplained,  ///< no name, structure reported
  abstained,    ///< nothing said though something was there
  refused,      ///< the log was refused
  crashed,      ///< the diagnosis ended without an answer: a defect, or memory that ran out
  wrong_place,  ///< the right effect somewhere else
  wrong         ///< something named that is not there
};
inline constexpr int outcomes = 10;

[[nodiscard]] std::string name_of(Outcome outcome);

struct Judgement {
  Outcome outcome = Outcome::abstained;
  bool beside = false;        ///< of the wrong: all that was there is named as well
  bool at_its_place = false;  ///< a foreign effect: a name or something unexplained is said of its
                              ///< own joint, or of any if it has none
  bool false_load = false;    ///< a load is named where there is none of the kind (static, from a
                              ///< moment on), be it as one of a set
  bool false_since = false;   ///< what is there is said to have come since the reference log, which
                              ///< has it too
  /// Of what came or went: it is named, and said to act in other logs than it does.
  bool false_time = false;
  std::string said;          ///< the findings' names
  std::size_t set_size = 0;  ///< other names in the largest set of inseparable ones
  double error_ratio = 0.0;  ///< held-out error over that of the model told the truth; 0: not known
  /// Distance from the true inertias, of all numbers and of those that the diagnosis calls
  /// determined: relative to the links' masses and a decimetre, and in kg, kg m and kg m^2 apart.
  struct Distance {
    double all = 0.0, determined = 0.0;
    std::array<double, 3> all_by_unit = {}, determined_by_unit = {};
  };
  Distance given, found;
  double told = 0.0;  ///< as `all`, of ToldTruth::inertias; 0: not known
  /// How far the number that is furthest from the truth is, of those called determined: in its
  /// standard errors, and in the errors that allow for an effect that was not noticed.
  double standard_errors = 0.0, errors_if_unnoticed = 0.0;
};

/// `result` is the document of `shapeid diagnose --json`; null if it refused the log.
[[nodiscard]] Judgement judge(const Trial& trial, const nlohmann::json& result);

/// Its effect is none of the catalogue.
[[nodiscard]] bool is_foreign(const Trial& t);

/// Judgement::Distance::all of the inertias of the machine's free links.
[[nodiscard]] double distance_from_truth(const Machine& m,
                                         const std::vector<InertialParameters>& inertias);

/// 95 % bounds of a share of which `hits` of `count` were seen (Wilson 1927).
struct Bounds {
  double lower = 0.0, upper = 1.0;
};
[[nodiscard]] Bounds wilson(int hits, int count);

struct Scored {
  Trial trial;
  Judgement judgement;
};

/// The tables, in Markdown.
[[nodiscard]] std::string tables(const std::vector<Scored>& all);

}  // namespace shapeid::blind
