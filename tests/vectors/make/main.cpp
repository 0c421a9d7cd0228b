// make_vectors FOLDER: writes the vectors. No file of tests/vectors/*.json is edited by hand.
#include <fmt/format.h>

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "shapeid/models/file_output.hpp"
#include "shapeid/models/strict_json.hpp"
#include "shapeid/tests/vectors/make/cases.hpp"

int main(int argc, char** argv) {
  using namespace shapeid;
  if (argc != 2) {
    fmt::print(stderr, "usage: make_vectors FOLDER\n");
    return 2;
  }
  const std::string folder = argv[1];
  using Maker = std::function<nlohmann::json(test::Draw&)>;
  const std::vector<std::pair<std::string, Maker>> kinds = {
      {"convert", vectors::convert_cases},
      {"moments", vectors::moments_cases},
      {"regressor", vectors::regressor_cases},
      {"projection", vectors::projection_cases},
      {"masses", vectors::masses_cases},
      {"division", vectors::division_cases},
      {"certify", vectors::certify_cases},
      {"existence", vectors::existence_cases},
      {"robot", vectors::robot_cases},
      {"run", vectors::run_cases},
      {"load", vectors::load_cases}};
  nlohmann::json index = {{"format", "shapeid-vectors-1"},
                          {"made_by", "tests/vectors/make"},
                          {"flags", vectors::flags()},
                          {"files", nlohmann::json::object()}};
  std::uint64_t seed = 20240611;
  for (const auto& [kind, make] : kinds) {
    test::Draw draw(++seed);
    nlohmann::json cases = make(draw);
    for (std::size_t i = 0; i < cases.size(); ++i) {
      cases[i]["id"] = fmt::format("{}-{:03}", kind, i);
    }
    const nlohmann::json file = {
        {"format", "shapeid-vectors-1"}, {"kind", kind}, {"seed", seed}, {"cases", cases}};
    const std::string text = file.dump(0) + "\n";
    write_file(fmt::format("{}/{}.json", folder, kind), text);
    index["files"][kind] = digest(text);
  }
  write_file(folder + "/index.json", index.dump(1) + "\n");
  return 0;
}
