// shapeid track: follows a log that is being written, and answers window by window.
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <utility>

#include "shapeid/app/no_mass.hpp"
#include "shapeid/app/option_checks.hpp"
#include "shapeid/app/sought.hpp"
#include "shapeid/app/tell.hpp"
#include "shapeid/app/track_checkpoint.hpp"
#include "shapeid/app/track_lines.hpp"
#include "shapeid/app/track_run.hpp"
#include "shapeid/app/verbs.hpp"
#include "shapeid/models/error.hpp"
#include "shapeid/models/file_output.hpp"
#include "shapeid/models/online_numbers.hpp"
#include "shapeid/models/strict_json.hpp"
#include "shapeid/reference/identify.hpp"

namespace shapeid::app {
namespace {

struct TrackArguments {
  MotionInputs inputs;
  SoughtLinks sought;
  TrackSettings settings;
  FollowOptions follow;
  double cutoff = 20.0;
  std::string checkpoint;
  std::size_t checkpoint_every = 50;
  bool resume = false;
};

TrackSettings settings_for(const TrackArguments& options, const RobotInputs& robot,
                           const BodyModel& model) {
  TrackSettings settings = options.settings;
  EstimateSettings& estimates = settings.estimates;
  fast::IdentifierSettings& identifier = estimates.identifier;
  identifier.contacts = contact_treatment(options.inputs, robot.robot);
  identifier.weight = weight(robot);
  identifier.stride = identifier.window;
  identifier.expected_mass = expected_mass(options.sought, robot, model);
  identifier.warm = false;  // an answer must not depend on where a run was resumed
  estimates.natural_size = reference::natural_sizes(model, identifier.expected_mass);
  settings.stream.names = names_of_options();
  settings.stream.cutoff = options.cutoff;
  settings.stream.rate = options.inputs.rate;
  settings.stream.contacts_needed = identifier.contacts == ContactTreatment::project;
  if (settings.stream.contacts_needed) {
    settings.stream.derive_contacts = contact_rule(options.inputs, robot.robot);
    settings.contact_threshold = contact_threshold(options.inputs);
  }
  return settings;
}

/// Standard output before the checkpoint: it never says that a line is out which is not.
void flush() {
  if (std::fflush(stdout) != 0) {
    throw InputError("standard output cannot be written", "give it to a program or disk with room");
  }
}

/// Where the lines of a run begin: at the beginning, or behind the last line of a checkpoint.
class Source {
 public:
  Source(const TrackArguments& options, const std::optional<Checkpoint>& checkpoint)
      : path_(options.inputs.log), lines_(path_, options.follow) {
    next_ = lines_.next();
    if (checkpoint) {
      go_on(checkpoint->position);
    } else if (next_) {
      position_.header = next_->text;
      use(*next_);
      next_ = lines_.next();
    } else if (lines_.unfinished() > 0) {
      throw InputError({path_, 1}, fmt::format("{} bytes have no line's end", lines_.unfinished()),
                       "end every line with LF or CRLF");
    } else {
      throw InputError({path_}, "is empty", "begin with a row of column names");
    }
  }

  /// The next line that is not blank, with its number in the log; empty when no more will come.
  std::optional<Line> next() {
    while (next_) {
      Line line = *std::exchange(next_, std::nullopt);
      line.number += first_line_;
      line.next_byte += first_byte_;
      use(line);
      if (!line.text.empty()) return line;
      next_ = lines_.next();
    }
    next_ = lines_.next();
    return next_ ? next() : std::nullopt;
  }
  [[nodiscard]] const LogPosition& position() const { return position_; }
  [[nodiscard]] std::size_t unfinished() const { return lines_.unfinished(); }

 private:
  void use(const Line& line) {
    position_.row_byte = std::exchange(position_.next_byte, line.next_byte);
    position_.line = line.number;
    position_.row_digest = digest(line.text);
  }

  /// A file goes on behind the last line used. A stream may begin anew, with the header, and is
  /// then passed over up to there; or it simply goes on. Where the last line used stands again, it
  /// must be the same.
  void go_on(const LogPosition& stopped) {
    position_ = stopped;
    if (!lines_.is_stream()) {
      if (!next_ || next_->text != stopped.header) {
        throw InputError("the log's header is not the one that the checkpoint read",
                         "resume with the same log");
      }
      lines_.skip_to(stopped.line, stopped.row_byte, stopped.next_byte);
      next_ = lines_.next();
      pass_last_line();
    } else if (next_ && next_->text == stopped.header) {
      while (next_ && next_->number < stopped.line) next_ = lines_.next();
      pass_last_line();
    } else {
      first_line_ = stopped.line;
      first_byte_ = stopped.next_byte;
    }
  }

  void pass_last_line() {
    if (!next_) return;
    if (digest(next_->text) != position_.row_digest) {
      throw InputError({path_, position_.line}, "is not the line that the checkpoint read",
                       "resume with the same log");
    }
    next_ = lines_.next();
  }

  std::string path_;
  LineFollower lines_;
  std::optional<Line> next_;
  LogPosition position_;
  int first_line_ = 0;  ///< lines of the log before the stream begins
  std::uint64_t first_byte_ = 0;
};

void track(TrackArguments& options) {
  std::optional<Checkpoint> checkpoint;
  std::error_code unknown;  // what cannot be looked at is said when it is written
  if (options.resume && std::filesystem::exists(options.checkpoint, unknown)) {
    checkpoint = read_checkpoint(options.checkpoint);
  } else if (!options.checkpoint.empty()) {
    check_replaceable(options.checkpoint);
  }
  if (!options.checkpoint.empty()) OutputPlace(options.checkpoint).check_writable();
  Source source(options, checkpoint);
  LogTable table(options.inputs.log, source.position().header, 1);
  RobotInputs robot = read_robot(options.inputs, table);
  const BodyModel model = sought_bodies(options.sought, robot);
  warn_of_unused_masses(model.free_links, robot);
  const TrackSettings settings = settings_for(options, robot, model);
  const std::string setup = setup_digest(robot, model, settings);
  TrackRun run(table, robot, model, settings);
  if (checkpoint) restore(*checkpoint, run, setup);
  say_warnings(robot);  // not beside a refusal, which is one line

  std::size_t saved = run.lines();
  while (const std::optional<Line> line = source.next()) {
    for (const nlohmann::json& answer : run.push(table.row(line->text, line->number))) {
      fmt::print("{}\n", answer.dump());
    }
    flush();
    if (!options.checkpoint.empty() && run.lines() >= saved + options.checkpoint_every) {
      write_checkpoint(options.checkpoint, run, source.position(), setup);
      saved = run.lines();
    }
  }
  if (!options.checkpoint.empty()) {
    write_checkpoint(options.checkpoint, run, source.position(), setup);
  }
  if (source.unfinished() > 0) {
    tell(fmt::format("{}: the last {} bytes are no whole line, and were left\n", options.inputs.log,
                     source.unfinished()));
  }
  // With a checkpoint more may come, and be gone on with.
  if (run.lines() == 0 && options.checkpoint.empty()) {
    throw Refusal("too-short", fmt::format("{}: {}", options.inputs.log, run.why_no_line()));
  }
  if (run.why_no_answer() && options.checkpoint.empty()) {
    throw Refusal("no-data", fmt::format("{}: none of {} lines has an answer; the last says: {}",
                                         options.inputs.log, run.lines(), *run.why_no_answer()));
  }
  // With one, too: what was printed is none, and the state is kept.
  if (const std::optional<double> mass = run.mass_out_of_scale()) {
    throw Refusal(
        "torque-scale",
        fmt::format("{}: it asks for {:.2g} kg where {:.3g} are expected: its torque is "
                    "not in N m, or far more is to be expected",
                    options.inputs.log, *mass, settings.estimates.identifier.expected_mass));
  }
  if (run.never_found_mass()) {
    throw Refusal("no-mass",
                  fmt::format("{}: no answer foretold anything of the rows, which ask for masses "
                              "below zero: {}",
                              options.inputs.log, causes_of_no_mass));
  }
}

}  // namespace

void add_track(CLI::App& app) {
  const auto options = std::make_shared<TrackArguments>();
  CLI::App* verb =
      app.add_subcommand("track", "a JSON line per window of a log that is being written");
  options->inputs.add_robot_to(*verb);
  verb->add_option("log", options->inputs.log, "log, CSV; - reads standard input")->required();
  options->sought.add_to(*verb);
  verb->add_option("--cutoff", options->cutoff, "Hz, of the causal filter over every channel")
      ->check(above_zero())
      ->capture_default_str();
  verb->add_option("--rate", options->inputs.rate, "Hz, of the regular grid (default: the log's)")
      ->check(rate_of_a_log());
  fast::IdentifierSettings& identifier = options->settings.estimates.identifier;
  verb->add_option("--window", identifier.window, "samples a window")
      ->check(count_from(1, longest_window))
      ->capture_default_str();
  verb->add_option("--alpha", identifier.alpha, "filter (17)")
      ->check(share_above_zero())
      ->capture_default_str();
  verb->add_option("--recent", options->settings.estimates.recent, "s, of the longer window")
      ->check(number_from(0.001, 3600.0, "s"))
      ->capture_default_str();
  verb->add_option("--wander", options->settings.estimates.wander,
                   "share of its size by which a parameter may wander in a second")
      ->check(zero_or_above())
      ->capture_default_str();
  auto* follow =
      verb->add_flag("--follow", options->follow.follow, "at the end of the file wait for more");
  verb->add_option("--patience", options->follow.patience,
                   "s without a new byte after which following ends, of a stream too; 0 never")
      ->check(zero_or_above())
      ->needs(follow)
      ->capture_default_str();
  auto* checkpoint = verb->add_option("--checkpoint", options->checkpoint,
                                      "file that always holds a state to go on from");
  verb->add_option("--checkpoint-every", options->checkpoint_every, "lines between checkpoints")
      ->check(count_from(1))
      ->capture_default_str()
      ->needs(checkpoint);
  verb->add_flag("--resume", options->resume, "go on from the checkpoint, if there is one")
      ->needs(checkpoint);
  verb->callback([options] { track(*options); });
}

}  // namespace shapeid::app
