// URDF: what is read is a robot, and is written back as it was.
#include <cstdint>
#include <string>
#include <vector>

#include "shapeid/fuzz/support/check.hpp"
#include "shapeid/fuzz/support/memory_file.hpp"
#include "shapeid/models/urdf.hpp"

using namespace shapeid;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  UrdfOptions options;
  options.root = size % 2 == 0 ? Root::floating : Root::fixed;
  options.lock_mimic = true;
  const auto read = fuzz::accepted([&] { return parse_urdf(text, "r.urdf", options); });
  if (!read) return 0;
  const Robot& robot = read->robot;
  fuzz::check(!why_malformed(robot), "a robot that was read is well-formed");
  for (const Link& link : robot.links) {
    fuzz::check(link.inertia.values.allFinite(), "inertias are finite");
  }

  const fuzz::MemoryFile file(text);
  fuzz::check(write_urdf(file.path(), robot, {}) == text, "nothing identified, nothing changed");
  std::vector<IdentifiedLink> same;
  for (int i = 0; i < robot.link_count(); ++i) {
    const InertialParameters& body = robot.links[static_cast<std::size_t>(i)].inertia;
    if (!why_impossible(body)) same.push_back({i, body});
  }
  const std::string written = write_urdf(file.path(), robot, same);
  const Robot again = parse_urdf(written, "w.urdf", options).robot;
  fuzz::check(again.link_count() == robot.link_count(), "what is written is the same tree");
  for (std::size_t i = 0; i < robot.links.size(); ++i) {
    fuzz::check(again.links[i].name == robot.links[i].name &&
                    again.links[i].parent == robot.links[i].parent,
                "what is written is the same tree");
  }
  return 0;
}
