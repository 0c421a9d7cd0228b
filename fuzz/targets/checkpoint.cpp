// Checkpoints of `track`: as any text, and as a good one with numbers changed and its digest made
// good. What is promised: refused in one line, or read; a run that goes on from a forged one may be
// wrong.
#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "shapeid/app/track_checkpoint.hpp"
#include "shapeid/fuzz/support/bytes.hpp"
#include "shapeid/fuzz/support/check.hpp"
#include "shapeid/fuzz/support/memory_file.hpp"
#include "shapeid/fuzz/support/robots.hpp"
#include "shapeid/models/shapes_yaml.hpp"
#include "shapeid/models/strict_json.hpp"
#include "shapeid/reference/identify.hpp"

using namespace shapeid;
using nlohmann::json;

namespace {

constexpr const char* header =
    "time,base.gyro.x,base.gyro.y,base.gyro.z,base.accel.x,base.accel.y,base.accel.z,q.knee,"
    "tau.knee,contact.leg";
constexpr const char* setup = "setup";

/// A hopper that is followed with short windows, so that its state is small.
class Followed {
 public:
  Followed()
      : inputs_{fuzz::hopper(), {}, {}, {}, {}, {}},
        model_(trunk_of(inputs_.robot)),
        table_("log.csv", header, 1) {
    fast::IdentifierSettings& identifier = settings_.estimates.identifier;
    identifier.window = identifier.stride = 2;
    identifier.expected_mass = 3.0;
    identifier.warm = false;
    settings_.estimates.natural_size = reference::natural_sizes(model_, identifier.expected_mass);
    settings_.estimates.recent = 0.02;
  }
  [[nodiscard]] app::TrackRun new_run() const { return {table_, inputs_, model_, settings_}; }
  /// So many rows of some motion.
  void feed(app::TrackRun& run, int rows) {
    for (int i = 0; i < rows; ++i) {
      const double t = 0.002 * i;
      const std::string row =
          fmt::format("{},{},{},{},{},0.4,9.8,{},{},1", t, 0.3 * std::sin(9 * t), std::sin(8 * t),
                      0.2 * std::cos(7 * t), std::cos(6 * t), std::sin(5 * t), std::cos(11 * t));
      static_cast<void>(run.push(table_.row(row, i + 2)));
    }
  }

 private:
  static BodyModel trunk_of(const Robot& robot) {
    return load_region(robot, 0, {-0.2, -0.1, -0.05}, {0.2, 0.1, 0.05});
  }
  app::RobotInputs inputs_;
  BodyModel model_;
  LogTable table_;
  app::TrackSettings settings_;
};

json good_checkpoint(Followed& followed) {
  const auto path =
      std::filesystem::temp_directory_path() / fmt::format("shapeid-checkpoint-{}", ::getpid());
  app::TrackRun run = followed.new_run();
  followed.feed(run, 300);
  app::write_checkpoint(path.string(), run, {header, 12345, 301, 12300, digest("row")}, setup);
  std::ifstream in(path);
  json document = json::parse(in);
  std::filesystem::remove(path);
  return document;
}

void collect_leaves(json& value, std::vector<json*>& leaves) {
  leaves.push_back(&value);
  if (!value.is_structured()) return;
  for (json& inner : value) collect_leaves(inner, leaves);
}

json any_value(fuzz::Bytes& bytes, const json& present) {
  switch (bytes.count(0, 9)) {
    case 0:
      return nullptr;
    case 1:
      return -1;
    case 2:
      return bytes.byte();
    case 3:
      return 1e300;
    case 4:
      return std::uint64_t{1} << bytes.count(31, 63);
    case 5:
      return "nan";
    case 6:
      return json::array({present, present});
    case 7:
      return json::object();
    case 8:
      return bytes.unit();
    default:
      return json::array();
  }
}

/// The good one, with a value changed here and there.
std::string forged(fuzz::Bytes& bytes, const json& good) {
  json document = good;
  for (int edits = bytes.count(1, 4); edits > 0; --edits) {
    std::vector<json*> leaves;
    collect_leaves(document, leaves);
    const std::size_t place = 256U * bytes.byte() + bytes.byte();
    json& leaf = *leaves[place % leaves.size()];
    leaf = any_value(bytes, json(leaf));
    if (!document.is_object()) return document.dump();
  }
  if (document.contains("log") && document.contains("state")) {
    document["digest"] = digest(document["log"].dump() + document["state"].dump());
  }
  return document.dump();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static Followed followed;
  static const json good = good_checkpoint(followed);
  fuzz::Bytes bytes(data, size);
  const bool as_text = bytes.flag();
  const std::string text = as_text && size > 0
                               ? std::string(reinterpret_cast<const char*>(data) + 1, size - 1)
                               : forged(bytes, good);
  const fuzz::MemoryFile file(text);
  fuzz::taken([&] {
    const app::Checkpoint checkpoint = app::read_checkpoint(file.path());
    app::TrackRun run = followed.new_run();
    app::restore(checkpoint, run, setup);
  });
  return 0;
}
