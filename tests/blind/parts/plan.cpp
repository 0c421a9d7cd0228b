#include "shapeid/tests/blind/parts/plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>

#include "shapeid/diagnosis/effects.hpp"
#include "shapeid/models/error.hpp"
#include "shapeid/models/file_output.hpp"
#include "shapeid/tests/blind/parts/draws.hpp"
#include "shapeid/tests/blind/parts/yardstick.hpp"

namespace shapeid::blind {
namespace {

namespace fs = std::filesystem;

constexpr std::array<double, 5> ratios = {0.5, 1.0, 2.0, 4.0, 8.0};
constexpr std::uint64_t motions_of_each = 5;  // of each robot; clean ones are simulated once

/// A load that comes at a moment comes by itself.
bool can_change(const Kind& k) {
  const diagnosis::Effect* effect = diagnosis::find_effect(k.id);
  return effect != nullptr && !effect->built_in && !k.flags && k.id != "payload_from";
}

/// By numbers of its own, as has_spare_reference().
bool has_gone(std::uint64_t noise_seed) { return Random(noise_seed * 7919 + 2).uniform() < 0.5; }

/// Without anything in it a robot should walk; of those that are drawn not every one can.
struct CleanFall : std::runtime_error {
  CleanFall() : std::runtime_error("a clean robot fell: choose another seed") {}
};

class Generator {
 public:
  Generator(const PlanOptions& options, const std::string& folder)
      : options_(options), folder_(folder), scratch_(folder + "/scratch") {
    fs::create_directories(scratch_);
  }
  ~Generator() { fs::remove_all(scratch_); }
  Generator(const Generator&) = delete;
  Generator& operator=(const Generator&) = delete;

  Trial make(int number) {
    // Numbers of one trial do not depend on how many were drawn before.
    Random random(options_.seed * 1000003 + static_cast<std::uint64_t>(number));
    const Machine m = machine(name_of_machine(number));
    // No other trial has the robot, whose simulations would only be kept.
    if (options_.drawn_arms || options_.drawn_quadrupeds) clean_.clear();
    Trial trial;
    trial.machine = m.name;
    trial.motion_seed = 100 * options_.seed + 1 + draw(random, motions_of_each);
    trial.noise_seed = options_.seed * 10007 + static_cast<std::uint64_t>(number);
    trial.inertia_seed = trial.noise_seed + 5;
    logs_.clear();
    const std::string own = fmt::format("{}/trial{:04}", folder_, number);
    fs::create_directories(own);
    bool walked = false;
    try {
      put_items(m, number, random, trial);
      trial.reference =
          options_.changes || needs_reference(trial) || has_spare_reference(trial.noise_seed);
      if (options_.changes) {
        trial.acts = has_gone(trial.noise_seed) ? Acts::in_reference : Acts::in_log;
      }
      walked = write_trial(m, trial, own);
    } catch (const CleanFall&) {
      if (!options_.drawn_quadrupeds) throw;
    }
    if (!walked) {
      trial.error = "the robot fell";
      trial.reference = false;
    }
    write_file(own + "/sealed.json", to_json(trial).dump(2) + "\n");
    return trial;
  }

 private:
  [[nodiscard]] std::string name_of_machine(int number) const {
    const int every = options_.quadruped_every;
    constexpr std::uint64_t apart = 10000;
    const std::uint64_t own = apart * options_.seed + static_cast<std::uint64_t>(number);
    if (every > 0 && number % every == every - 1) {
      return options_.drawn_quadrupeds ? fmt::format("{}{}", quadruped_prefix, own) : "quadruped";
    }
    return options_.drawn_arms ? fmt::format("{}{}", drawn_prefix, own) : "arm";
  }

  /// A motion with nothing in it.
  const Readings& clean(const Machine& m, std::uint64_t seed) {
    const auto key = std::pair(m.name, seed);
    const auto known = clean_.find(key);
    if (known != clean_.end()) return known->second;
    Readings readings = simulate_clean(m, seed);
    if (readings.empty()) throw CleanFall();
    return clean_.emplace(key, std::move(readings)).first->second;
  }

  /// The log of the trial's motion with this noise.
  const diagnosis::Recording& clean_log(const Machine& m, const Trial& trial,
                                        std::uint64_t noise_seed) {
    const auto known = logs_.find(noise_seed);
    if (known != logs_.end()) return known->second;
    write_logs(m, without_items(noise_seed), clean(m, trial.motion_seed), scratch_);
    return logs_.emplace(noise_seed, read_log(m, scratch_ + "/log.csv")).first->second;
  }

  /// The trial's truth before any noise. Empty if the robot falls.
  Readings readings_of(const Machine& m, const Trial& trial) {
    if (trial.items.empty()) return clean(m, trial.motion_seed);
    if (is_dynamic(trial)) return simulate_trial(m, trial);
    Readings readings = clean(m, trial.motion_seed);
    change_signals(m, trial.items, readings);
    return readings;
  }

  /// What the diagnosis may see. False if the robot falls: then nothing of it is written.
  bool write_trial(const Machine& m, const Trial& trial, const std::string& own) {
    Trial later = trial;
    later.items = items_in_log(trial);
    const Readings readings = readings_of(m, later);
    if (readings.empty()) return false;
    if (trial.reference && !write_reference(m, trial, readings, own)) return false;
    write_logs(m, trial, readings, own);
    return true;
  }

  /// The same robot earlier, with other noise. False if it falls so. `readings`: of the log.
  bool write_reference(const Machine& m, const Trial& trial, const Readings& readings,
                       const std::string& own) {
    Trial earlier = trial;
    earlier.items = items_in_reference(trial);
    earlier.noise_seed = reference_seed(trial);
    const bool is_same = earlier.items.size() == items_in_log(trial).size();
    const Readings before = is_same ? readings : readings_of(m, earlier);
    if (before.empty()) return false;
    write_logs(m, earlier, before, scratch_);
    fs::rename(scratch_ + "/log.csv", own + "/reference.csv");
    return true;
  }

  static std::uint64_t reference_seed(const Trial& trial) { return trial.noise_seed + 3; }

  static Trial without_items(std::uint64_t seed) {
    Trial trial;
    trial.noise_seed = seed;
    return trial;
  }

  void put_items(const Machine& m, int number, Random& random, Trial& trial) {
    const int place = number % 10;
    int count = 1;
    bool foreign = !options_.changes && (place == 7 || place == 9);
    if (place == 0 || place == 5) count = 0;
    if (place == 4) count = 2;
    if (!options_.only.empty()) {
      count = options_.only == "clean" ? 0 : 1;
      foreign = options_.only == "foreign" || (count > 0 && kind(options_.only).foreign);
    }
    const bool one_kind = !options_.only.empty() && options_.only != "foreign";
    std::vector<const Kind*> possible;
    for (const Kind& k : kinds()) {
      const bool wanted = one_kind ? k.id == options_.only : k.foreign == foreign;
      if (options_.changes && !can_change(k)) continue;
      if (wanted && !sites(m, k).empty()) possible.push_back(&k);
    }
    constexpr int most_draws = 50;
    for (int attempt = 0; attempt < most_draws && std::ssize(trial.items) < count; ++attempt) {
      if (possible.empty()) return;
      const Kind& k = *possible[draw(random, possible.size())];
      const bool fits = trial.items.empty() || fit_together(kind(trial.items.front().kind), k);
      const double drawn = ratios[draw(random, ratios.size())];
      const double ratio = options_.ratio > 0.0 ? options_.ratio : drawn;
      if (!fits) continue;
      if (const auto item = sized(m, k, ratio, random, trial)) trial.items.push_back(*item);
    }
  }

  /// Empty if no robot could have so much of it there, or it cannot be seen at all.
  std::optional<Item> sized(const Machine& m, const Kind& k, double ratio, Random& random,
                            const Trial& trial) {
    const std::vector<int> places = sites(m, k);
    Item item{k.id, {places[draw(random, places.size())], k.nominal, {0, 0, 0}}, ratio};
    for (double& d : item.amount.direction) d = random.normal();
    item.amount.direction.normalize();
    // Nothing of soft ground reaches the equation of motion; a flag is no number in it.
    if (k.id == "soft_ground" || k.flags) {
      item.ratio = 0.0;
      // Times from half to twice the usual one.
      if (k.flags && !k.foreign) item.amount.size *= std::exp2(2.0 * random.uniform() - 1.0);
      return item;
    }
    item.amount.size = ratio * detectable(m, k, item, trial);
    if (!(item.amount.size < k.largest)) return std::nullopt;
    return item;
  }

  /// The item's smallest detectable size. What is not in proportion to its size, as what saturates,
  /// is looked at again at the size that was found; infinity if that does not settle.
  [[nodiscard]] double detectable(const Machine& m, const Kind& k, Item item, const Trial& trial) {
    constexpr int most_looks = 20;
    constexpr double close = 0.02;
    const Readings& readings = clean(m, trial.motion_seed);
    const diagnosis::Recording& log = clean_log(m, trial, trial.noise_seed);
    // A load that was never absent is told from its link by a log without it alone.
    const diagnosis::Recording* reference =
        k.id == "payload" ? &clean_log(m, trial, reference_seed(trial)) : nullptr;
    for (int look = 0; look < most_looks; ++look) {
      Eigen::MatrixXd change;
      try {
        change = unit_change(m, item, readings, log, scratch_, trial.noise_seed);
      } catch (const InputError&) {
        return std::numeric_limits<double>::infinity();  // so much of it that logs are refused
      }
      const double size = detectable_size(m, log, change, reference);
      if (!k.foreign || std::abs(size - item.amount.size) < close * size) return size;
      if (std::isinf(size)) return size;
      // What grows with its square would go to and fro.
      item.amount.size = std::sqrt(item.amount.size * size);
    }
    return std::numeric_limits<double>::infinity();
  }

  PlanOptions options_;
  std::string folder_, scratch_;
  std::map<std::pair<std::string, std::uint64_t>, Readings> clean_;
  std::map<std::uint64_t, diagnosis::Recording> logs_;  ///< of one trial's motion, by their noise
};

}  // namespace

bool has_spare_reference(std::uint64_t noise_seed) {
  // Numbers of its own: what is in the trial, its noise and its inertias are drawn by others.
  return Random(noise_seed * 7919 + 1).uniform() < 1.0 / 3.0;
}

void generate(const PlanOptions& options, const std::string& folder,
              const std::function<void(int, const Trial&)>& on_trial) {
  Generator generator(options, folder);
  for (int number = options.first; number < options.first + options.trials; ++number) {
    const Trial trial = generator.make(number);
    if (on_trial) on_trial(number, trial);
  }
}

}  // namespace shapeid::blind
