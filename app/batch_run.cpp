#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <nlohmann/json.hpp>
#include <utility>

#include "shapeid/app/batch.hpp"
#include "shapeid/app/json_text.hpp"
#include "shapeid/app/limit.hpp"
#include "shapeid/app/merge_order.hpp"
#include "shapeid/app/noted_refusal.hpp"
#include "shapeid/app/number_source.hpp"
#include "shapeid/app/recordings.hpp"
#include "shapeid/app/tell.hpp"
#include "shapeid/diagnosis/in_parallel.hpp"
#include "shapeid/models/error.hpp"
#include "shapeid/reference/triangle.hpp"

namespace shapeid::app {
namespace {

using nlohmann::json;

/// A log, and its rows as a triangle [Y F], also behind the slower filter; none if it was refused.
struct CompressedLog {
  BatchLog log;
  Eigen::MatrixXd rows, slower;
};

// --- Messages between processes. Numbers keep every bit.

std::string packed(const Eigen::MatrixXd& M) {
  const std::int64_t rows = M.rows();
  const std::size_t size = static_cast<std::size_t>(M.size()) * sizeof(double);
  std::string bytes(sizeof rows + size, '\0');
  std::memcpy(bytes.data(), &rows, sizeof rows);
  if (size > 0) std::memcpy(bytes.data() + sizeof rows, M.data(), size);
  return bytes;
}

Eigen::MatrixXd unpacked(const std::string& bytes) {
  std::int64_t rows = 0;
  std::memcpy(&rows, bytes.data(), sizeof rows);
  const std::size_t size = bytes.size() - sizeof rows;
  const auto count = static_cast<Eigen::Index>(size / sizeof(double));
  Eigen::MatrixXd M(rows, rows > 0 ? count / rows : 0);
  if (size > 0) std::memcpy(M.data(), bytes.data() + sizeof rows, size);
  return M;
}

std::string packed(const BatchLog& log) {
  return json_text({{"refused", log.refused},
                    {"code", log.code},
                    {"rows", log.rows},
                    {"samples", log.samples},
                    {"gaps", log.gaps},
                    {"rate", log.rate},
                    {"contacts_derived", log.contacts_derived},
                    {"notes", log.notes}},
                   -1);
}

BatchLog unpacked_log(const std::string& path, const std::string& bytes) {
  const json report = json::parse(bytes);
  BatchLog log;
  log.path = path;
  log.refused = report.at("refused");
  log.code = report.at("code");
  log.rows = report.at("rows");
  log.samples = report.at("samples");
  log.gaps = report.at("gaps");
  log.rate = report.at("rate");
  log.contacts_derived = report.at("contacts_derived");
  log.notes = report.at("notes").get<std::vector<std::string>>();
  return log;
}

// --- One log

CompressedLog compressed(const std::string& path, const BatchOptions& options,
                         const RobotInputs& robot, const BodyModel& model) {
  CompressedLog result;
  result.log.path = path;
  std::optional<LogSamples> samples;
  try {
    samples.emplace(path, robot, options.inputs);
    const reference::CompressedRows rows = compress(
        robot.robot, model, [&] { return samples->next(); },
        settings_for(*samples, robot, options.inputs, options.settings));
    const MotionReport& report = samples->report();
    result.log.rows = report.rows;
    result.log.samples = rows.samples;
    result.log.gaps = report.gaps;
    result.log.rate = report.rate;
    result.log.contacts_derived = report.contacts_derived;
    refuse_without_samples(report);
    refuse_filtered_away(rows);
    result.rows = merged(rows.blocks);
    if (!rows.slower.empty()) result.slower = merged(rows.slower);
    if (!result.rows.allFinite()) {
      throw Refusal("not-finite", "the log's numbers are too large for the sums of their squares");
    }
  } catch (const InputError& e) {
    result.log.refused = e.what();
  } catch (const Refusal& e) {
    result.log.refused = e.what();
    result.log.code = e.code();
  }
  if (samples) result.log.notes = samples->report().notes;
  if (!result.log.refused.empty()) {
    result.rows.resize(0, 0);
    result.slower.resize(0, 0);
  }
  return result;
}

double residual(const CompressedLog& log, const Eigen::VectorXd& Phi) {
  if (log.rows.rows() == 0) return 0.0;
  const Eigen::Index n = Phi.size();
  const Eigen::VectorXd r = log.rows.leftCols(n) * Phi - log.rows.col(n);
  return r.norm() / std::sqrt(static_cast<double>(log.log.samples));
}

// --- All logs

/// A triangle of both; a log of short pieces has none behind the slower filter.
Eigen::MatrixXd together(const Eigen::MatrixXd& left, const Eigen::MatrixXd& right) {
  if (left.size() == 0) return right;
  if (right.size() == 0) return left;
  return reference::triangle(reference::stacked(left, right));
}

/// The logs, each with the process that reads it: contiguous shares, so that neighbours merge where
/// they are.
class Shares {
 public:
  Shares(const BatchOptions& options, const RobotInputs& robot, const BodyModel& model,
         Peers& peers)
      : peers_(peers), all_(options.logs.size()) {
    std::vector<std::size_t> mine;
    for (std::size_t k = 0; k < all_.size(); ++k) {
      all_[k].log.path = options.logs[k];
      if (is_mine(k)) mine.push_back(k);
    }
    diagnosis::in_parallel(mine.size(), options.threads, [&](std::size_t i) {
      all_[mine[i]] = compressed(options.logs[mine[i]], options, robot, model);
    });
  }

  /// Number 0 learns what became of every log.
  void gather_reports() {
    to_first([&](std::size_t k) { return packed(all_[k].log); },
             [&](std::size_t k, const std::string& bytes) {
               all_[k].log = unpacked_log(all_[k].log.path, bytes);
             });
  }

  /// Blocks of neighbours among the logs that are used, at most so many, at number 0; empty
  /// elsewhere. `of_log`: which of its rows.
  std::vector<reference::RowBlock> merge(std::size_t most, Eigen::MatrixXd CompressedLog::*of_log) {
    const std::vector<std::size_t> used = used_logs();
    std::vector<Eigen::MatrixXd> rows;
    for (const CompressedLog& log : all_) rows.push_back(log.*of_log);
    const std::size_t stride =
        merge_neighbours(used.size(), most, [&](std::size_t first, std::size_t second) {
          const std::size_t left = used[first], right = used[second];
          if (!is_mine(left)) {
            if (is_mine(right)) peers_.send(packed(rows[right]), owner(left));
            return;
          }
          if (!is_mine(right)) rows[right] = unpacked(peers_.receive(owner(right)));
          rows[left] = together(rows[left], rows[right]);
          rows[right].resize(0, 0);
        });
    std::vector<reference::RowBlock> blocks;
    for (std::size_t place = 0; place < used.size(); place += stride) {
      const std::size_t k = used[place];
      if (peers_.rank() != 0) {
        if (is_mine(k)) peers_.send(packed(rows[k]), 0);
        continue;
      }
      if (!is_mine(k)) rows[k] = unpacked(peers_.receive(owner(k)));
      if (rows[k].size() > 0) blocks.push_back({rows[k]});
    }
    return blocks;
  }

  /// Number 0 tells the others Phi (of the free links), and learns every log's residual there.
  void gather_residuals(Eigen::VectorXd Phi) {
    if (peers_.rank() == 0) {
      for (std::size_t p = 1; p < peers_.count(); ++p) peers_.send(packed(Eigen::MatrixXd(Phi)), p);
    } else {
      Phi = unpacked(peers_.receive(0)).reshaped();
    }
    to_first(
        [&](std::size_t k) {
          all_[k].log.residual = residual(all_[k], Phi);
          return packed(Eigen::MatrixXd::Constant(1, 1, all_[k].log.residual));
        },
        [&](std::size_t k, const std::string& bytes) {
          all_[k].log.residual = unpacked(bytes)(0, 0);
        });
  }

  [[nodiscard]] std::vector<BatchLog> logs() const {
    std::vector<BatchLog> logs;
    for (const CompressedLog& log : all_) logs.push_back(log.log);
    return logs;
  }

 private:
  [[nodiscard]] std::size_t owner(std::size_t k) const { return k * peers_.count() / all_.size(); }
  [[nodiscard]] bool is_mine(std::size_t k) const { return owner(k) == peers_.rank(); }

  /// Number 0 knows, and tells the others.
  std::vector<std::size_t> used_logs() {
    Eigen::MatrixXd is_used = Eigen::MatrixXd::Zero(1, std::ssize(all_));
    if (peers_.rank() == 0) {
      for (std::size_t k = 0; k < all_.size(); ++k) {
        if (all_[k].log.refused.empty()) is_used(0, static_cast<Eigen::Index>(k)) = 1.0;
      }
      for (std::size_t p = 1; p < peers_.count(); ++p) peers_.send(packed(is_used), p);
    } else {
      is_used = unpacked(peers_.receive(0));
    }
    std::vector<std::size_t> used;
    for (std::size_t k = 0; k < all_.size(); ++k) {
      if (is_used(0, static_cast<Eigen::Index>(k)) > 0.0) used.push_back(k);
    }
    return used;
  }

  /// `say` is called for every log where it was read, `hear` at number 0 for the others' logs.
  void to_first(const std::function<std::string(std::size_t)>& say,
                const std::function<void(std::size_t, const std::string&)>& hear) {
    for (std::size_t k = 0; k < all_.size(); ++k) {
      if (is_mine(k)) {
        const std::string bytes = say(k);
        if (peers_.rank() != 0) peers_.send(bytes, 0);
      } else if (peers_.rank() == 0) {
        hear(k, peers_.receive(owner(k)));
      }
    }
  }

  Peers& peers_;
  std::vector<CompressedLog> all_;
};

/// The first reasons, so that what would be right is still on the screen.
std::string reasons_text(const std::vector<std::string>& reasons) {
  constexpr std::size_t most = 3;
  const std::size_t said = std::min(reasons.size(), most);
  const auto end = reasons.begin() + static_cast<std::ptrdiff_t>(said);
  std::string text = fmt::format("{}", fmt::join(reasons.begin(), end, "; "));
  if (reasons.size() > said) text += fmt::format("; and {} more", reasons.size() - said);
  return text;
}

void judge_refused(const std::vector<BatchLog>& logs, bool skip) {
  std::vector<std::string> reasons;
  std::string code;  // of the first, if good data cannot answer and none are bad
  bool any_bad = false;
  for (const BatchLog& log : logs) {
    if (log.refused.empty()) continue;
    if (code.empty()) code = log.code;
    any_bad = any_bad || log.code.empty();
    // Most reasons name their log themselves.
    const bool names_it = log.refused.starts_with(log.path);
    reasons.push_back(names_it ? log.refused : fmt::format("{}: {}", log.path, log.refused));
  }
  if (reasons.empty()) return;
  const bool all = reasons.size() == logs.size();
  if (all || !skip) {
    const std::string said =
        fmt::format("{}: {}",
                    all ? "every log is refused"
                        : fmt::format("{} of {} logs are refused", reasons.size(), logs.size()),
                    reasons_text(reasons));
    const std::string right = all ? "give logs and options that `inspect` finds nothing wrong with"
                                  : "leave them out, or give --skip-refused";
    if (any_bad) throw InputError(said, right);
    throw Refusal(code, fmt::format("{}; {}", said, right));
  }
  for (const BatchLog& log : logs) {
    if (!log.refused.empty()) {
      tell(fmt::format("log {} is refused: {}\n", log.path, log.refused));
    }
  }
}

void check_all_contacts_alike(const std::vector<BatchLog>& logs, ContactTreatment contacts) {
  const BatchLog* first = nullptr;
  for (const BatchLog& log : logs) {
    if (!log.refused.empty()) continue;
    if (first == nullptr) first = &log;
    check_contacts_alike({first->path, first->contacts_derived}, {log.path, log.contacts_derived},
                         contacts);
  }
}

/// What the logs' preparation did, as if they were one.
MotionReport motion_of(const std::vector<BatchLog>& logs) {
  MotionReport motion;
  double seconds = 0.0;
  for (const BatchLog& log : logs) {
    if (!log.refused.empty()) continue;
    motion.rows += log.rows;
    motion.samples += log.samples;
    motion.gaps += log.gaps;
    motion.contacts_derived = motion.contacts_derived || log.contacts_derived;
    seconds += static_cast<double>(log.samples) / log.rate;
    for (const std::string& note : log.notes) motion.notes.push_back(log.path + ": " + note);
  }
  motion.rate = static_cast<double>(motion.samples) / seconds;
  return motion;
}

/// Also of logs that are refused.
std::vector<std::string> notes_of(const std::vector<BatchLog>& logs, const RobotInputs& robot) {
  std::vector<std::string> notes = robot.all_notes();
  for (const BatchLog& log : logs) {
    for (const std::string& note : log.notes) notes.push_back(log.path + ": " + note);
  }
  return notes;
}

Result solved(const std::vector<BatchLog>& logs, reference::CompressedRows rows,
              const BatchOptions& options, const RobotInputs& robot, const BodyModel& model) {
  judge_refused(logs, options.skip_refused);
  check_all_contacts_alike(logs, contact_treatment(options.inputs, robot.robot));
  if (rows.blocks.size() < 2) {
    throw Refusal("too-short", "a single log has no spread to judge it by; identify it by itself");
  }
  Result result;
  result.robot_file = options.inputs.robot;
  result.robot_yaml_file = robot.robot_yaml;
  const auto used = std::count_if(logs.begin(), logs.end(),
                                  [](const BatchLog& log) { return log.refused.empty(); });
  result.log_file = fmt::format("{} logs", used);
  result.sought = model;
  result.motion = motion_of(logs);
  reference::IdentifySettings settings = options.settings;
  settings.floor = floor_of_divisions;
  rows.samples = result.motion.samples;
  result.found = identify(model, rows, settings);
  result.slower_cutoff = slower_cutoff(options.inputs);
  check_some_mass(result, options.settings.expected_mass);
  result.notes = robot.notes_with(result.motion);
  note_numbers_that_hang(result);
  choose_written_links(result, robot.robot, options.least_mass);
  return result;
}

}  // namespace

std::optional<BatchResult> run_batch(const BatchOptions& options, const RobotInputs& robot,
                                     const BodyModel& model, Peers& peers) {
  Shares shares(options, robot, model, peers);
  shares.gather_reports();
  reference::CompressedRows rows;
  rows.blocks = shares.merge(options.most_blocks, &CompressedLog::rows);
  rows.slower = shares.merge(options.most_blocks, &CompressedLog::slower);
  if (peers.rank() != 0) {
    shares.gather_residuals({});
    return std::nullopt;
  }
  BatchResult batch;
  const std::vector<BatchLog> logs = shares.logs();
  batch.result = with_notes([&] { return notes_of(logs, robot); },
                            [&] { return solved(logs, std::move(rows), options, robot, model); });
  shares.gather_residuals(batch.result.found.run.solution.Phi);
  batch.logs = shares.logs();
  return batch;
}

}  // namespace shapeid::app
