// shapeid certify: anyone's answer to a problem, accepted or rejected with what is proved of it.
#include <fmt/format.h>

#include <memory>

#include "shapeid/app/certificate_text.hpp"
#include "shapeid/app/json_text.hpp"
#include "shapeid/app/option_checks.hpp"
#include "shapeid/app/verbs.hpp"
#include "shapeid/models/error.hpp"
#include "shapeid/models/file_output.hpp"
#include "shapeid/models/text.hpp"
#include "shapeid/proofs/certificate/certificate_json.hpp"

namespace shapeid::app {
namespace {

/// Bytes: a thousand rows and ten thousand shapes fit. As JSON a file takes up to twenty times its
/// size.
constexpr std::size_t largest_file = std::size_t{1} << 26U;

struct CertifyArguments {
  std::string problem, answer, certificate, out;
  certificate::Tolerance tolerance;
  bool json = false;
};

void certify(const CertifyArguments& options) {
  using namespace certificate;
  if (!options.out.empty()) OutputPlace(options.out).check_writable();
  const StatedProblem problem =
      stated_problem_from_json(read_small_file(options.problem, largest_file), options.problem);
  const Answer answer =
      answer_from_json(read_small_file(options.answer, largest_file), options.answer);
  if (const Violation why = why_unfit(problem, answer)) {
    throw InputError({options.answer}, *why, "an answer to " + options.problem);
  }
  std::optional<Certificate> given;
  if (!options.certificate.empty()) {
    given = certificate_from_json(read_small_file(options.certificate, largest_file),
                                  options.certificate, problem);
  }
  const Evidence evidence = given ? given->evidence : Evidence{};
  Certified certified = shapeid::certificate::certify(problem, answer, options.tolerance, evidence);
  if (given) {
    for (std::string& reason : false_claims(*given, certified.proof)) {
      certified.reasons.push_back(std::move(reason));
    }
  }
  if (!options.out.empty()) {
    write_file(options.out, certificate_to_json(certified.proof, evidence));
  }
  if (options.json) {
    const nlohmann::json document = {{"accepted", certified.reasons.empty()},
                                     {"reasons", certified.reasons},
                                     {"proof", proof_json(certified.proof)}};
    fmt::print("{}\n", json_text(document, 2));
  } else {
    fmt::print("{}", certified_text(certified));
  }
  if (!certified.reasons.empty()) throw Refusal("rejected", certified.reasons.front());
}

}  // namespace

void add_certify(CLI::App& app) {
  const auto options = std::make_shared<CertifyArguments>();
  CLI::App* verb = app.add_subcommand(
      "certify", "accept or reject anyone's answer to a mass problem, with a proven bound");
  verb->add_option("problem", options->problem, "problem.json")->required();
  verb->add_option("answer", options->answer, "answer.json: masses, or parameters alone")
      ->required();
  verb->add_option("--certificate", options->certificate,
                   "certificate.json: every claim in it must be what is proved");
  verb->add_option("--gap", options->tolerance.gap,
                   "accepted excess of the objective, relative to the objective of no mass")
      ->check(number_from(0.0, 1.0))
      ->capture_default_str();
  verb->add_option("--out", options->out, "file for a certificate of what is proved");
  verb->add_flag("--json", options->json, "print the proof as JSON");
  verb->callback([options] { certify(*options); });
}

}  // namespace shapeid::app
