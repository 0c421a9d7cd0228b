// shapeid certify from the outside: files in, verdict out.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "shapeid/tests/app/command.hpp"

namespace shapeid::test {
namespace {

/// One link: ten rows that read off the parameters of a plate and a rod.
nlohmann::json problem() {
  nlohmann::json p = {{"format", "shapeid-problem-1"},
                      {"free_links", 1},
                      {"F", {3.0, 1.0, 0.0, 0.0, 0.5, 0.0, 0.0, 1.0, 0.0, 1.5}},
                      {"V", {0.5, 0.25}},
                      {"lambda", 0.0},
                      {"mass_bound", 8.0}};
  const std::vector<double> plate = {1.0, 0.0, 0.0, 0.0, 0.25, 0.0, 0.0, 0.25, 0.0, 0.5};
  const std::vector<double> rod = {1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.5, 0.0, 0.5};
  for (std::size_t i = 0; i < 10; ++i) {
    p["Y"].push_back(std::vector<double>(10, 0.0));
    p["Y"][i][i] = 1.0;
    p["U"].push_back({plate[i], rod[i]});
    p["W"].push_back(1.0);
  }
  return p;
}

/// Two of the plate and one of the rod explain the rows exactly.
nlohmann::json answer(const std::string& problem_digest) {
  return {{"format", "shapeid-answer-1"},
          {"problem_digest", problem_digest},
          {"masses", {2.0, 1.0}},
          {"parameters", {3.0, 1.0, 0.0, 0.0, 0.5, 0.0, 0.0, 1.0, 0.0, 1.5}},
          {"objective", 0.0}};
}

/// A first try with any digest is told the right one.
std::string digest_of_problem() {
  scratch_file("problem.json", problem().dump());
  scratch_file("unnamed.json", answer("").dump());
  const CommandRun run = shapeid("certify problem.json unnamed.json --json");
  EXPECT_EQ(run.status, 1);
  return nlohmann::json::parse(run.out)["proof"]["problem_digest"];
}

CommandRun certify(const nlohmann::json& given, const std::string& options = "") {
  scratch_file("problem.json", problem().dump());
  scratch_file("answer.json", given.dump());
  return shapeid("certify problem.json answer.json " + options);
}

/// Where nothing is proved, or no double holds a number, words say so.
TEST(CertifyVerb, NothingIsInfinite) {
  nlohmann::json far = answer(digest_of_problem());
  for (const double mass : {-1.0, 1e308}) {
    far["masses"] = {mass, 1e308};
    const CommandRun run = certify(far);
    EXPECT_EQ(run.status, 1) << run.err;
    EXPECT_EQ(run.out.find("inf"), std::string::npos) << run.out;
    EXPECT_EQ(run.err.find("inf"), std::string::npos) << run.err;
    EXPECT_NE(run.out.find("gap: none proved"), std::string::npos) << run.out;
  }
  EXPECT_NE(certify(far).out.find("objective of the answer: larger than any double"),
            std::string::npos);
}

TEST(CertifyVerb, AcceptsMassesAndParametersAlone) {
  nlohmann::json good = answer(digest_of_problem());
  const CommandRun run = certify(good, "--out certificate.json");
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.out.find("accepted"), 0U) << run.out;
  EXPECT_EQ(certify(good, "--certificate certificate.json").status, 0);
  good.erase("masses");
  const CommandRun alone = certify(good, "--json");
  EXPECT_EQ(alone.status, 0) << alone.err;
  const auto document = nlohmann::json::parse(alone.out);
  EXPECT_TRUE(document["accepted"].get<bool>());
  EXPECT_TRUE(document["proof"]["made_of_shapes"].get<bool>());
  // A plate and a rod in one plane: a body without volume.
  EXPECT_EQ(document["proof"]["bodies"], nlohmann::json({"semidefinite"}));
}

TEST(CertifyVerb, TheExampleIsAccepted) {
  const std::string examples = SHAPEID_SOURCE_DIR "/docs/examples/";
  const CommandRun run =
      shapeid("certify " + examples + "problem.json " + examples + "answer.json --json");
  EXPECT_EQ(run.status, 0) << run.err;
  const auto columns = nlohmann::json::parse(run.out)["proof"]["columns"];
  EXPECT_EQ(columns, nlohmann::json({{"declared", 2}, {"agree", 2}, {"inside", 2}}));
}

TEST(CertifyVerb, SaysWhyItRejects) {
  nlohmann::json wrong = answer(digest_of_problem());
  wrong["masses"] = {2.0, 0.5};
  wrong["parameters"] = {2.5, 0.5, 0.0, 0.0, 0.5, 0.0, 0.0, 0.75, 0.0, 1.25};
  wrong["objective"] = 0.625;
  const CommandRun run = certify(wrong);
  EXPECT_EQ(run.status, 1);
  EXPECT_NE(run.err.find("above the optimum"), std::string::npos) << run.err;
  EXPECT_EQ(run.out.find("rejected"), 0U) << run.out;
  EXPECT_EQ(certify(wrong, "--gap 1").status, 0);
}

TEST(CertifyVerb, BadFilesAreOneLineAndStatusTwo) {
  const nlohmann::json good = answer(digest_of_problem());
  std::vector<std::string> texts = {"", "{", "[]", "{\"format\":\"shapeid-answer-1\"}",
                                    R"({"format":"shapeid-answer-1","format":"x"})"};
  const auto broken = [&](const std::string& key, const nlohmann::json& value) {
    nlohmann::json bad = good;
    bad[key] = value;
    texts.push_back(bad.dump());
  };
  for (const char* key : {"problem_digest", "parameters", "objective"}) {
    nlohmann::json bad = good;
    bad.erase(key);
    texts.push_back(bad.dump());
  }
  broken("masses", {1.0});
  broken("masses", {1.0, nullptr});
  broken("masses", "NaN");
  broken("parameters", {1.0});
  broken("columns", {1.0});
  broken("more", 1);
  broken("problem_digest", 7);
  std::string huge = good.dump();
  huge.replace(huge.find("\"objective\":0.0"), 15, "\"objective\":1e999");
  texts.push_back(huge);
  std::string nan = good.dump();
  nan.replace(nan.find("\"objective\":0.0"), 15, "\"objective\":NaN");
  texts.push_back(nan);
  scratch_file("problem.json", problem().dump());
  for (const std::string& text : texts) {
    scratch_file("answer.json", text);
    const CommandRun run = shapeid("certify problem.json answer.json");
    EXPECT_EQ(run.status, 2) << text;
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    EXPECT_NE(run.err.find("answer.json"), std::string::npos) << run.err;
    EXPECT_TRUE(run.out.empty()) << run.out;
  }
  EXPECT_EQ(shapeid("certify missing.json answer.json").status, 2);
}

}  // namespace
}  // namespace shapeid::test
