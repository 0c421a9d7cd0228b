#include "shapeid/tests/experiments/data/cheetah.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <iterator>

#include "shapeid/models/motion.hpp"
#include "shapeid/models/urdf.hpp"

namespace shapeid::experiments {
namespace {

const std::string mapping_file = SHAPEID_SOURCE_DIR "/docs/examples/mini_cheetah.mapping.yaml";

std::string path_of(const std::string& folder, const std::string& log) {
  return folder + "/" + log + ".csv.gz";
}

}  // namespace

std::optional<std::string> cheetah_folder() {
  const char* named = std::getenv("SHAPEID_DATA");
  const std::filesystem::path data =
      named != nullptr ? std::filesystem::path(named)
                       : std::filesystem::path(SHAPEID_SOURCE_DIR) / ".." / "shared" / "data";
  const auto folder = data / "mini_cheetah_umich";
  if (!std::filesystem::is_directory(folder)) return std::nullopt;
  return folder.string();
}

Cheetah read_cheetah(const std::string& folder) {
  UrdfOptions options;
  options.reject_impossible =
      false;  // the thighs' published inertias break the triangle inequality
  Cheetah cheetah{read_urdf(folder + "/mini_cheetah_from_mit_constants.urdf", options).robot,
                  folder};
  add_default_contacts(cheetah.robot, path_of(folder, "concrete_right_circle_val"),
                       read_mapping_yaml(mapping_file));
  return cheetah;
}

double reflected_inertia(int joint) {
  // MIT Cheetah-Software, MiniCheetah.h: rotor about its axis, kg m^2; gears of abduction and hip,
  // and of the knee.
  constexpr double rotor = 63e-6, gear = 6.0, knee_gear = 9.33;
  const double ratio = joint % 3 == 2 ? knee_gear : gear;
  return rotor * ratio * ratio;
}

std::vector<Sample> cheetah_samples(const Cheetah& cheetah, const std::string& log,
                                    std::size_t every, bool rotors) {
  MotionReader reader(path_of(cheetah.folder, log), cheetah.robot, {},
                      read_mapping_yaml(mapping_file), {});
  std::vector<Sample> samples;
  std::size_t count = 0;
  while (std::optional<Sample> sample = reader.next()) {
    constexpr double impact = 25.0;  // m/s^2
    if (count++ % every != 0 || sample->base_specific_force.norm() >= impact) continue;
    for (int j = 0; rotors && j < cheetah.robot.joint_count(); ++j) {
      sample->tau[j] -= reflected_inertia(j) * sample->ddq[j];
    }
    samples.push_back(*std::move(sample));
  }
  return samples;
}

std::vector<Sample> standing(const std::vector<Sample>& samples) {
  std::vector<Sample> kept;
  std::copy_if(samples.begin(), samples.end(), std::back_inserter(kept), [](const Sample& s) {
    return std::find(s.in_contact.begin(), s.in_contact.end(), true) != s.in_contact.end();
  });
  return kept;
}

}  // namespace shapeid::experiments
