#include "shapeid/app/bundled.hpp"

#include <filesystem>
#include <system_error>

#include "shapeid/models/error.hpp"

namespace shapeid::app {

std::string bundled(const std::string& name) {
  std::error_code unknown;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", unknown);
  const auto installed = program.parent_path().parent_path() / "share/shapeid/robots" / name;
  if (!unknown && std::filesystem::exists(installed)) return installed.string();
  const auto in_tree = std::filesystem::path(SHAPEID_SOURCE_DIR) / "models/robots" / name;
  if (std::filesystem::exists(in_tree)) return in_tree.string();
  throw InputError({in_tree.string()}, "the bundled robot is missing",
                   "reinstall shapeid, or give --robot");
}

}  // namespace shapeid::app
