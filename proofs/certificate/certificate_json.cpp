#include "shapeid/proofs/certificate/certificate_json.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <set>
#include <utility>

#include "shapeid/models/error.hpp"
#include "shapeid/models/strict_json.hpp"

namespace shapeid::certificate {
namespace {

using nlohmann::json;

constexpr const char* certificate_format = "shapeid-certificate-2";
constexpr const char* manual = "docs/formats/certificate.md";

json finite(double x) { return std::isfinite(x) ? json(x) : json(); }

const char* name_of(Existence body) {
  switch (body) {
    case Existence::definite:
      return "definite";
    case Existence::semidefinite:
      return "semidefinite";
    case Existence::impossible:
      break;
  }
  return "impossible";
}

constexpr std::array<std::pair<const char*, Guess Evidence::*>, 3> guesses = {
    {{"limit", &Evidence::limit}, {"bodies", &Evidence::bodies}, {"masses", &Evidence::masses}}};

json evidence_json(const Evidence& evidence) {
  json object = json::object();
  for (const auto& [name, guess] : guesses) {
    object[name] = {{"parameters", vector_json((evidence.*guess).parameters)},
                    {"columns", vector_json((evidence.*guess).others)}};
  }
  return object;
}

json between_json(const Between& b) {
  return {{"lower", finite(b.lower)}, {"upper", finite(b.upper)}};
}

Eigen::VectorXd sized(const json& object, const std::string& key, Eigen::Index size,
                      const JsonSource& source) {
  Eigen::VectorXd v = numbers(member(object, key, source), key, source);
  if (v.size() != 0 && v.size() != size) {
    throw InputError(place_of_key(source, key), fmt::format("{} numbers", v.size()),
                     fmt::format("none, or {}", size));
  }
  return v;
}

Guess guess_from(const json& object, const StatedProblem& problem, const JsonSource& source) {
  check_keys(object, "", source, {"parameters", "columns"});
  Guess guess{sized(object, "parameters", problem.masses.U.rows(), source),
              sized(object, "columns", problem.others.values.cols(), source)};
  if (guess.parameters.size() > 0 && guess.others.size() != problem.others.values.cols()) {
    throw InputError({source.name}, "has parameters without columns", "one a column");
  }
  return guess;
}

}  // namespace

json proof_json(const Proof& p) {
  json bodies = json::array();
  for (const Existence body : p.bodies) bodies.push_back(name_of(body));
  json claim = {{"problem_digest", p.problem_digest},
                {"answer_digest", p.answer_digest},
                {"feasible", p.feasible},
                {"objective", finite(p.objective_above)},
                {"optimum", {{"lower", finite(p.lower)}, {"upper", finite(p.upper)}}},
                {"gap", finite(p.gap)},
                {"optimum_known", p.optimum_known},
                {"free_set_right", p.free_set_right},
                {"mass_bound", finite(p.mass_bound)},
                {"mass_bound_declared", p.mass_bound_declared},
                {"mass_distance", finite(p.mass_distance)},
                {"parameter_distance", json::array()},
                {"made_of_shapes", p.made_of_shapes},
                {"plane", vector_json(p.plane)},
                {"bodies", bodies},
                {"floor", p.floor ? finite(*p.floor) : json()},
                {"relaxations",
                 {{"masses", between_json(p.relaxations.masses)},
                  {"bodies", between_json(p.relaxations.bodies)},
                  {"divisions", between_json(p.relaxations.divisions)},
                  {"apart", p.relaxations.apart}}},
                {"columns",
                 {{"declared", p.columns.declared},
                  {"agree", p.columns.agree},
                  {"inside", p.columns.inside}}}};
  for (const double distance : p.parameter_distance) {
    claim["parameter_distance"].push_back(finite(distance));
  }
  return claim;
}

std::string certificate_to_json(const Proof& proof, const Evidence& evidence) {
  json claim = proof_json(proof);
  claim["evidence_digest"] = digest(evidence_json(evidence).dump());
  const json document = {
      {"format", certificate_format}, {"claim", claim}, {"evidence", evidence_json(evidence)}};
  return document.dump(1) + "\n";
}

Certificate certificate_from_json(const std::string& text, const std::string& name,
                                  const StatedProblem& problem) {
  const JsonSource source{name, manual};
  const json document = parse_document(text, source, certificate_format, {"claim", "evidence"});
  Certificate certificate;
  certificate.claim = member(document, "claim", source);
  std::set<std::string> keys = {"evidence_digest"};
  const json all_claims = proof_json(Proof{});
  for (const auto& item : all_claims.items()) keys.insert(item.key());
  check_keys(certificate.claim, "claim", source, keys);
  for (const std::string& key : keys) (void)member(certificate.claim, key, source);
  const json& evidence = member(document, "evidence", source);
  std::set<std::string> names;
  for (const auto& [guess, place] : guesses) names.insert(guess);
  check_keys(evidence, "evidence", source, names);
  for (const auto& [guess, place] : guesses) {
    certificate.evidence.*place = guess_from(member(evidence, guess, source), problem,
                                             {fmt::format("{}, evidence.{}", name, guess), manual});
  }
  return certificate;
}

std::vector<std::string> false_claims(const Certificate& certificate, const Proof& proof) {
  json proved = proof_json(proof);
  proved["evidence_digest"] = digest(evidence_json(certificate.evidence).dump());
  std::vector<std::string> reasons;
  for (const auto& [key, claimed] : certificate.claim.items()) {
    if (claimed == proved[key]) continue;
    reasons.push_back(fmt::format("the certificate claims {} {}, proved is {}", key, claimed.dump(),
                                  proved[key].dump()));
  }
  return reasons;
}

}  // namespace shapeid::certificate
