#include "shapeid/app/track_checkpoint.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <filesystem>
#include <system_error>

#include "shapeid/app/json_text.hpp"
#include "shapeid/app/track_archive.hpp"
#include "shapeid/models/error.hpp"
#include "shapeid/models/file_output.hpp"
#include "shapeid/models/strict_json.hpp"
#include "shapeid/models/text.hpp"
#include "shapeid/models/version.hpp"

namespace shapeid::app {
namespace {

using nlohmann::json;

constexpr const char* format = "shapeid-checkpoint-10";
constexpr const char* any_format = "shapeid-checkpoint-";
constexpr const char* what_is_right = "give a checkpoint that --checkpoint wrote";

/// Bytes: five times what Estimates keeps at most; beyond it something else was named.
constexpr std::size_t largest_checkpoint = std::size_t{1} << 30U;

json rows_of(const Eigen::MatrixXd& M) { return matrix_json(M); }

/// The tree as far as the equations know it.
json robot_json(const Robot& robot) {
  json links = json::array();
  for (const Link& link : robot.links) {
    links.push_back({{"name", link.name},
                     {"parent", link.parent},
                     {"joint", link.joint.name},
                     {"kind", static_cast<int>(link.joint.kind)},
                     {"axis", vector_json(link.joint.axis)},
                     {"placement", rows_of(link.joint.placement.matrix())},
                     {"rotor", link.joint.rotor_inertia}});
  }
  json contacts = json::array();
  for (const Contact& contact : robot.contacts) {
    contacts.push_back({contact.name, contact.link, static_cast<int>(contact.kind),
                        rows_of(contact.frame.matrix())});
  }
  return {{"floats", robot.root == Root::floating}, {"links", links}, {"contacts", contacts}};
}

InputError not_whole(const std::string& path, const json::exception& e) {
  return {Place{path}, fmt::format("is no whole checkpoint ({})", e.what()), what_is_right};
}

bool is_checkpoint(const std::string& path) {
  std::error_code unknown;
  if (!std::filesystem::is_regular_file(path, unknown)) return false;
  const std::string text = read_small_file(path, largest_checkpoint);
  try {
    const json document = parse_json(text, {path, "docs/formats/track.md"});
    const auto says = document.find("format");
    return says != document.end() && says->is_string() &&
           says->get_ref<const std::string&>().starts_with(any_format);
  } catch (const InputError&) {
    return false;
  }
}

/// Names of columns are any bytes, and JSON has characters: those beyond ASCII stand for the bytes
/// of their numbers.
std::string text_of(const std::string& bytes) {
  std::string text;
  for (const char c : bytes) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80) {
      text += c;
    } else {
      text += static_cast<char>(0xC0 | (byte >> 6));
      text += static_cast<char>(0x80 | (byte & 0x3F));
    }
  }
  return text;
}

std::string bytes_of(const std::string& text) {
  std::string bytes;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto lead = static_cast<unsigned char>(text[i]);
    const bool is_pair = lead >= 0xC0 && i + 1 < text.size();
    const int byte =
        is_pair ? (lead << 6 | (static_cast<unsigned char>(text[i + 1]) & 0x3F)) : lead;
    bytes += static_cast<char>(byte & 0xFF);
    if (is_pair) ++i;
  }
  return bytes;
}

/// Tells a damaged file from a whole one. Whoever means to deceive can compute it as well.
std::string damage_digest(json document) {
  document.erase("digest");
  return digest(document.dump());
}

}  // namespace

std::string setup_digest(const RobotInputs& robot, const BodyModel& model,
                         const TrackSettings& settings) {
  const EstimateSettings& e = settings.estimates;
  const fast::IdentifierSettings& i = e.identifier;
  json mapping = json::array();
  if (robot.mapping) {
    for (const auto& [ours, rule] : robot.mapping->columns) {
      mapping.push_back({ours, rule.from, rule.scale, rule.offset, rule.sign, rule.hold});
    }
    mapping.push_back(robot.mapping->keep_rows);
    mapping.push_back(robot.mapping->torque_factor);
  }
  json setup = {{"robot", robot_json(robot.robot)},
                {"imu", rows_of(robot.notes.imu.matrix())},
                {"mapping", mapping},
                {"known", vector_json(model.known)},
                {"free", model.free_links},
                {"U", rows_of(shape_columns(model))},
                {"V", vector_json(shape_volumes(model))},
                {"weight", vector_json(i.weight)},
                {"natural_size", vector_json(e.natural_size)},
                {"options",
                 {static_cast<int>(i.contacts), i.window, i.stride, i.alpha, i.expected_mass,
                  i.lambda.value_or(-1.0), e.recent, e.wander, settings.stream.cutoff,
                  settings.stream.rate, settings.stream.derive_contacts != nullptr}}};
  if (settings.stream.derive_contacts) {
    // What contacts are derived from: share of the weight that a foot must carry, given inertias.
    setup["derived_contacts"] = {settings.contact_threshold,
                                 vector_json(stacked_parameters(robot.robot))};
  }
  return digest(json_text(setup, -1));
}

void write_checkpoint(const std::string& path, TrackRun& run, const LogPosition& position,
                      const std::string& setup) {
  const json log = {{"header", text_of(position.header)},
                    {"next_byte", position.next_byte},
                    {"line", position.line},
                    {"row_byte", position.row_byte},
                    {"row_digest", position.row_digest}};
  json document = {{"format", format}, {"software", fmt::format("shapeid {}", version)},
                   {"setup", setup},   {"lines", run.lines()},
                   {"log", log},       {"state", StateWriter::encode(run)}};
  document["digest"] = damage_digest(document);
  write_file(path, document.dump() + "\n");
}

void check_replaceable(const std::string& path) {
  std::error_code unknown;  // what cannot be looked at cannot be written either, which is said then
  if (!std::filesystem::exists(path, unknown) || is_checkpoint(path)) return;
  throw InputError({path}, "is no checkpoint, and would be written over by --checkpoint",
                   "a new file, or a checkpoint of an earlier run");
}

Checkpoint read_checkpoint(const std::string& path) {
  const JsonSource source{path, "docs/formats/track.md"};
  Checkpoint checkpoint{path, parse_json(read_small_file(path, largest_checkpoint), source), {}};
  try {
    if (checkpoint.document.at("format") != format) {
      throw InputError({path}, fmt::format("is not of format {}", format),
                       "give a checkpoint that this version wrote");
    }
    if (checkpoint.document.at("digest") != damage_digest(checkpoint.document)) {
      throw InputError({path}, "is damaged: its digest differs", what_is_right);
    }
    const json& log = checkpoint.document.at("log");
    checkpoint.position = {bytes_of(log.at("header").get<std::string>()),
                           StateReader::whole<std::uint64_t>(log.at("next_byte")),
                           StateReader::whole<int>(log.at("line")),
                           StateReader::whole<std::uint64_t>(log.at("row_byte")),
                           log.at("row_digest").get<std::string>()};
    return checkpoint;
  } catch (const json::exception& e) {
    throw not_whole(path, e);
  }
}

void restore(const Checkpoint& checkpoint, TrackRun& run, const std::string& setup) {
  try {
    if (checkpoint.document.at("setup") != setup) {
      throw InputError({checkpoint.path},
                       "was written with another robot, other shapes or other options",
                       "resume with the same, or start without --resume");
    }
    StateReader::decode(checkpoint.document.at("state"), run);
  } catch (const json::exception& e) {
    throw not_whole(checkpoint.path, e);
  }
}

}  // namespace shapeid::app
