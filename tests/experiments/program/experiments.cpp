// experiments list; run NAME FORM OUT.json; page FORM RESULTS PAGE TEXT=...; record FILE.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>

#include "shapeid/models/file_output.hpp"
#include "shapeid/tests/experiments/page/page.hpp"
#include "shapeid/tests/experiments/page/plot.hpp"
#include "shapeid/tests/experiments/studies/experiment.hpp"
#include "shapeid/tests/experiments/studies/recorded.hpp"

namespace {

namespace fs = std::filesystem;
using namespace shapeid::experiments;
using Arguments = std::vector<std::string>;

const std::string templates = SHAPEID_SOURCE_DIR "/tests/experiments/page/text/";

Form form_of(const std::string& word) {
  if (word == "full") return Form::full;
  if (word == "quick") return Form::quick;
  throw std::invalid_argument(word + " is neither full nor quick");
}

std::string read(const fs::path& path) {
  std::ifstream in(path);
  if (!in) throw std::runtime_error("cannot read " + path.string());
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

void run(const std::string& name, const std::string& form, const std::string& file) {
  const auto all = experiments();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const Experiment& e) { return e.name == name; });
  if (found == all.end()) throw std::invalid_argument("no experiment is called " + name);
  const Findings findings = found->run(form_of(form));
  shapeid::write_file(file, findings_to_json(findings).dump(1) + "\n");
}

/// Draws every plot beside the page.
void draw(const Findings& findings, const fs::path& folder) {
  fs::create_directories(folder);
  for (const auto& [name, script] : findings.plots) {
    const fs::path file = folder / (name + ".gnuplot"), picture = folder / (name + ".svg");
    shapeid::write_file(
        file.string(),
        fmt::format("set terminal svg noenhanced size 900,{} background '#ffffff' font "
                    "'sans-serif,12'\nset output '{}'\n{}",
                    picture_height(script), picture.string(), script));
    const int status = std::system(fmt::format("gnuplot '{}'", file.string()).c_str());
    fs::remove(file);
    if (status != 0) throw std::runtime_error("gnuplot did not draw " + name);
  }
}

/// The parts of the page in their order; one whose numbers were not made is left out, with a word.
std::string write_page(const Findings& findings, const std::map<std::string, std::string>& texts,
                       const std::string& pictures, std::vector<std::string>& broken) {
  std::string text;
  std::istringstream parts(read(templates + "parts"));
  for (std::string part, needed; parts >> part >> needed;) {
    const auto there = findings.values.lower_bound(needed);
    if (there == findings.values.end() || there->first.rfind(needed, 0) != 0) {
      std::cerr << "left out: " << part << " (no numbers " << needed << "*)\n";
      continue;
    }
    const Page page = fill(read(templates + part + ".md.in"), findings, texts, pictures);
    text += (text.empty() ? "" : "\n") + page.text;
    broken.insert(broken.end(), page.broken.begin(), page.broken.end());
  }
  return text;
}

int page(const Arguments& arguments) {
  const Form form = form_of(arguments.at(0));
  const fs::path target = arguments.at(2);
  std::map<std::string, std::string> texts;
  for (std::size_t i = 3; i < arguments.size(); ++i) {
    const std::size_t equals = arguments[i].find('=');
    texts[arguments[i].substr(0, equals)] = arguments[i].substr(equals + 1);
  }
  Findings findings;
  for (const auto& entry : fs::directory_iterator(arguments.at(1))) {
    if (entry.path().extension() != ".json") continue;
    findings.merge(findings_from_json(nlohmann::json::parse(read(entry.path()))));
  }
  std::vector<std::string> broken;
  const std::string pictures = target.stem().string();
  const std::string text = write_page(findings, texts, pictures, broken);
  for (const std::string& statement : broken) std::cerr << "not borne out: " << statement << "\n";
  // A few seeds need not bear out what many do; the page in docs says nothing that is not so.
  if (form == Form::full && !broken.empty()) return 1;
  draw(findings, target.parent_path() / pictures);
  shapeid::write_file(target.string(), text);
  return 0;
}

int command(const std::string& verb, const Arguments& arguments) {
  if (verb == "list") {
    for (const Experiment& e : experiments()) std::cout << e.name << "\n";
  } else if (verb == "run") {
    run(arguments.at(0), arguments.at(1), arguments.at(2));
  } else if (verb == "page") {
    return page(arguments);
  } else if (verb == "record") {
    shapeid::write_file(arguments.at(0), nlohmann::json(small_values()).dump(1) + "\n");
  } else {
    throw std::invalid_argument("list, run, page or record");
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const Arguments words(argv + 1, argv + argc);
  try {
    if (words.empty()) throw std::invalid_argument("list, run, page or record");
    return command(words.front(), {words.begin() + 1, words.end()});
  } catch (const std::exception& error) {
    std::cerr << "experiments: " << error.what() << "\n";
    return 2;
  }
}
