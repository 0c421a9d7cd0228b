#include "shapeid/tests/bench/report/results.hpp"

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>
#include <stdexcept>

namespace shapeid::bench {
namespace {

double median_of(std::vector<double> values) {
  if (values.empty()) throw std::runtime_error("a benchmark without repetitions");
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

/// Files of one folder may come from several builds: all are named.
void add_context(std::string& known, const std::string& value) {
  if (known.find(value) != std::string::npos) return;
  known += (known.empty() ? "" : " and ") + value;
}

/// The file's text with null where Google Benchmark writes NaN, which is no JSON: in coefficients
/// of variation of counters that are zero, which nobody reads here.
std::string readable(std::istream& file) {
  std::ostringstream text;
  text << file.rdbuf();
  return std::regex_replace(text.str(), std::regex(": -?NaN"), ": null");
}

double seconds_a_unit(const std::string& unit) {
  if (unit == "ns") return 1e-9;
  if (unit == "us") return 1e-6;
  if (unit == "ms") return 1e-3;
  if (unit == "s") return 1.0;
  throw std::runtime_error("unknown unit of time: " + unit);
}

/// Times measured by a program itself stand in real_time; of the others the processor's time is
/// less disturbed by neighbours.
void read_one(const nlohmann::json& run, Results& results) {
  static const std::string manual = "/manual_time", fixed = "/iterations:";
  std::string name = run.at("run_name");
  const std::size_t at = name.find(manual);
  const bool timed_itself = at != std::string::npos;
  if (timed_itself) name.erase(at, manual.size());
  name = name.substr(0, name.find(fixed));

  auto place = std::find_if(results.all.begin(), results.all.end(),
                            [&name](const Result& r) { return r.name == name; });
  if (place == results.all.end()) {
    results.all.push_back({name, {}, {}});
    place = std::prev(results.all.end());
  }
  place->seconds.push_back(run.at(timed_itself ? "real_time" : "cpu_time").get<double>() *
                           seconds_a_unit(run.at("time_unit")));
  static const std::vector<std::string> not_counters = {"family_index", "per_family_instance_index",
                                                        "repetitions",  "repetition_index",
                                                        "threads",      "iterations",
                                                        "real_time",    "cpu_time"};
  for (const auto& [key, value] : run.items()) {
    if (value.is_number() && std::ranges::find(not_counters, key) == not_counters.end())
      place->counters[key] = value.get<double>();
  }
}

}  // namespace

double Result::median() const { return median_of(seconds); }

double Result::counter(const std::string& which) const {
  const auto found = counters.find(which);
  return found == counters.end() ? 0.0 : found->second;
}

bool Result::correct() const { return counter("failures") == 0.0 && counter("wrong") == 0.0; }

const Result* Results::find(const std::string& name) const {
  const auto found =
      std::find_if(all.begin(), all.end(), [&name](const Result& r) { return r.name == name; });
  return found == all.end() ? nullptr : &*found;
}

std::vector<const Result*> Results::between(const std::string& prefix,
                                            const std::string& suffix) const {
  std::vector<const Result*> found;
  for (const Result& r : all) {
    if (r.name.starts_with(prefix) && r.name.ends_with(suffix)) found.push_back(&r);
  }
  return found;
}

void read_results(const std::string& path, Results& results) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error(path + ": cannot be read");
  const nlohmann::json document = nlohmann::json::parse(readable(file));
  for (const auto& [key, value] : document.at("context").items()) {
    if (value.is_string()) add_context(results.context[key], value.get<std::string>());
  }
  for (const auto& run : document.at("benchmarks")) {
    if (run.at("run_type") == "iteration") read_one(run, results);
  }
}

Ratio ratio(const Result& a, const Result& b) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < std::min(a.seconds.size(), b.seconds.size()); ++i)
    ratios.push_back(a.seconds[i] / b.seconds[i]);
  const auto [low, high] = std::minmax_element(ratios.begin(), ratios.end());
  return {median_of(ratios), *low, *high};
}

}  // namespace shapeid::bench
