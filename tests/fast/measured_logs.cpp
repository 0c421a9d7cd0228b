#include "shapeid/tests/fast/measured_logs.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <optional>

#include "shapeid/models/log.hpp"
#include "shapeid/models/motion.hpp"
#include "shapeid/models/urdf.hpp"
#include "shapeid/tests/support/files.hpp"

namespace shapeid::test {
namespace {

std::filesystem::path data(const std::string& file) { return data_folder() / file; }

}  // namespace

bool absent(const std::string& file) {
  if (std::filesystem::exists(data(file))) return false;
  fmt::print("skipped: {} is not there (set SHAPEID_DATA)\n", data(file).string());
  return true;
}

Log log_of(const std::string& urdf, Root root, const std::string& file, const std::string& mapping,
           std::size_t most) {
  UrdfOptions options;
  options.root = root;
  options.reject_impossible = false;
  Log log{read_urdf(data(urdf), options).robot, {}};
  const Mapping map =
      read_mapping_yaml(SHAPEID_SOURCE_DIR "/docs/examples/" + mapping + ".mapping.yaml");
  if (root == Root::floating) add_default_contacts(log.robot, data(file), map);
  MotionReader reader(data(file), log.robot, {}, map, {});
  while (log.samples.size() < most) {
    std::optional<Sample> sample = reader.next();
    if (!sample) break;
    log.samples.push_back(*sample);
  }
  return log;
}

}  // namespace shapeid::test
