// Claim C11. URDF in and out, strictly: every number is matched in full, every reference is
// resolved, every inertia is linted. urdfdom reads mass="nan" as zero and accepts two parents; this
// reader does not.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "shapeid/models/error.hpp"
#include "shapeid/models/robot.hpp"

namespace shapeid {

/// An inertia in a file that no body can have, or that is suspicious.
struct InertiaFinding {
  std::string link;   ///< name of the URDF link
  Place place;        ///< file and line
  std::string wrong;  ///< the broken inequality with its margin
  std::string
      likely_cause;  ///< diagonal swapped, about the wrong point, row-major slip, ...; may be empty
  bool fatal = true;  ///< false: suspicious only (a rod, an unusually small inertia)
};

struct UrdfOptions {
  Root root = Root::floating;
  /// Moving joints to be treated as fixed, each at a position (rad or m): fingers, wheels, all that
  /// no log speaks of. A name that is no joint of the file throws InputError.
  std::map<std::string, double> locked;
  /// A <mimic> joint is no coordinate of its own, and its coupling is not modelled: it is refused,
  /// or with this option locked where its master stands where that is `locked`, else at zero.
  bool lock_mimic = false;
  bool reject_impossible = true;  ///< throw InputError at the first fatal finding
  /// What that names as the way to read the file all the same; empty: there is none.
  std::string accepted_by = "reject_impossible = false";
};

struct UrdfFile {
  Robot robot;
  std::vector<InertiaFinding> findings;
  bool says_floating = false;  ///< a joint of type floating stands above the root
};

/// Reads a URDF. Throws InputError (file, line, what is wrong, what would be right).
[[nodiscard]] UrdfFile read_urdf(const std::string& path, const UrdfOptions& options = {});
/// The same from text; `name` stands for the file in messages.
[[nodiscard]] UrdfFile parse_urdf(const std::string& text, const std::string& name,
                                  const UrdfOptions& options = {});

/// New parameters for one lumped link, about its origin in its axes.
struct IdentifiedLink {
  int link = 0;
  InertialParameters inertia;
};

/// The text of the original URDF with the <inertial> of the given links replaced, all else byte for
/// byte as it was. The whole lumped inertia goes to the first member that has one in the file, the
/// other members lose theirs (a comment says so). Throws Defect rather than write an inertia that
/// the reader would refuse, or for a robot that was not read from this file.
[[nodiscard]] std::string write_urdf(const std::string& original_path, const Robot& robot,
                                     const std::vector<IdentifiedLink>& identified);

/// What <dynamics> says of a joint: N m s/rad and N m (N s/m and N of a slider).
struct JointFriction {
  double damping = 0.0, friction = 0.0;
};

/// The text of a URDF with the <dynamics> of the named joints replaced or added, all else byte for
/// byte as it was; `file` stands for it in messages. Throws Defect for a joint that is not there.
[[nodiscard]] std::string with_friction(const std::string& text, const std::string& file,
                                        const std::map<std::string, JointFriction>& friction);

}  // namespace shapeid
