#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <queue>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "shapeid/models/note_list.hpp"
#include "shapeid/models/urdf_tree.hpp"

namespace shapeid::urdf {
namespace {

/// Rows and columns of the regressor grow with the links, and so do 80 MB a sample.
constexpr int most_links = 1000;

class Lumper {
 public:
  Lumper(const Document& document, const Tree& tree, const UrdfOptions& options)
      : document_(document), tree_(tree), options_(options), place_(document.links.size()) {}

  Robot lump() {
    refuse_unknown_locks();
    robot_.name = document_.name;
    robot_.root = options_.root;
    open_link(tree_.root, -1, {});
    while (!ready_.empty()) {
      const int j = ready_.top();
      ready_.pop();
      const DocumentJoint& written = joint(j);
      const int above = tree_.parent[static_cast<std::size_t>(j)];
      const Place parent = place_[static_cast<std::size_t>(above)];
      if (robot_.link_count() == most_links) {
        throw InputError({document_.file, written.line, {}},
                         fmt::format("more than {} links that move", most_links),
                         "write joints that do not move as fixed");
      }
      Joint moving = written.joint;
      moving.placement = parent.pose * moving.placement;
      open_link(tree_.child[static_cast<std::size_t>(j)], parent.link, moving);
    }
    return finish();
  }

 private:
  /// Where a link of the document went: its lumped link, and its frame in that link's frame.
  struct Place {
    int link = -1;
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  };

  const DocumentJoint& joint(int j) const { return document_.joints[static_cast<std::size_t>(j)]; }

  void refuse_unknown_locks() const {
    for (const auto& [name, position] : options_.locked) {
      const bool known = std::any_of(
          document_.joints.begin(), document_.joints.end(), [&wanted = name](const auto& j) {
            return j.joint.name == wanted && j.type != DocumentJointType::fixed;
          });
      if (!known) {
        throw InputError(
            fmt::format("joint {} cannot be locked at {:g}: {} has no such moving joint", name,
                        position, document_.file),
            "name a joint of the URDF");
      }
    }
  }

  /// The position at which a joint stands still; empty if it moves.
  std::optional<double> standstill(const DocumentJoint& j) {
    if (j.type == DocumentJointType::fixed) return 0.0;
    if (const auto found = options_.locked.find(j.joint.name); found != options_.locked.end()) {
      check_position(j, found->second);
      notes_.add(fmt::format("joints locked at {:g}", found->second), j.joint.name);
      return found->second;
    }
    if (!j.mimic) return std::nullopt;
    if (!options_.lock_mimic) {
      throw InputError(
          {document_.file, j.line, {}},
          fmt::format("joint {} mimics {}, a coupling that is not modelled", j.joint.name,
                      j.mimic->joint),
          "make it fixed in the URDF, or remove <mimic> if this joint moves on its own");
    }
    const double position = position_of_mimic(j);
    check_position(j, position);
    notes_.add(fmt::format("mimic joints locked at {:g}", position), j.joint.name);
    return position;
  }

  /// Where it is when its master stands where that is locked, or else at zero; masters may be
  /// mimics.
  double position_of_mimic(const DocumentJoint& j) {
    if (joints_.empty()) {
      for (const DocumentJoint& other : document_.joints) joints_.emplace(other.joint.name, &other);
    }
    double position = 0.0, factor = 1.0;
    std::set<const DocumentJoint*> passed;
    for (const DocumentJoint* at = &j; at->mimic;) {
      position += factor * at->mimic->offset;
      factor *= at->mimic->multiplier;
      const std::string& master = at->mimic->joint;
      const auto locked = options_.locked.find(master);
      if (locked != options_.locked.end()) return position + factor * locked->second;
      const auto found = joints_.find(master);
      if (found == joints_.end()) {
        throw InputError(
            {document_.file, at->line, {}},
            fmt::format("joint {} mimics {}, which is no joint", at->joint.name, master),
            "name a joint of the URDF");
      }
      passed.insert(at);
      at = found->second;
      if (passed.contains(at)) {
        throw InputError(
            {document_.file, at->line, {}},
            fmt::format("joint {} mimics itself, by others or directly", at->joint.name),
            "let one joint of the circle move on its own");
      }
    }
    return position;
  }

  void check_position(const DocumentJoint& j, double position) const {
    constexpr double furthest = 1e6;  // rad or m
    if (std::abs(position) <= furthest) return;
    throw InputError({document_.file, j.line, {}},
                     fmt::format("joint {} would be locked at {:g}", j.joint.name, position),
                     "a position that it can reach, rad or m");
  }

  static Eigen::Isometry3d placement_at(const DocumentJoint& j, double position) {
    if (j.type == DocumentJointType::fixed) return j.joint.placement;
    if (j.type == DocumentJointType::prismatic) {
      return j.joint.placement * Eigen::Translation3d(position * j.joint.axis);
    }
    return j.joint.placement * Eigen::AngleAxisd(position, j.joint.axis);
  }

  /// A new lumped link that begins with `first` and takes in all that is tied to it.
  void open_link(int first, int parent, const Joint& moving) {
    Link link;
    link.name = document_.links[static_cast<std::size_t>(first)].name;
    link.parent = parent;
    link.joint = moving;
    robot_.links.push_back(std::move(link));

    std::queue<int> pending;
    place_[static_cast<std::size_t>(first)].link = robot_.link_count() - 1;
    pending.push(first);
    while (!pending.empty()) {
      const int i = pending.front();
      pending.pop();
      const Place here = place_[static_cast<std::size_t>(i)];
      add_member(document_.links[static_cast<std::size_t>(i)], here.pose);
      for (const int j : tree_.outward[static_cast<std::size_t>(i)]) {
        const std::optional<double> position = standstill(joint(j));
        if (!position) {
          ready_.push(j);
          continue;
        }
        const int child = tree_.child[static_cast<std::size_t>(j)];
        place_[static_cast<std::size_t>(child)] = {here.link,
                                                   here.pose * placement_at(joint(j), *position)};
        pending.push(child);
      }
    }
  }

  void add_member(const DocumentLink& written, const Eigen::Isometry3d& pose) {
    Link& link = robot_.links.back();
    Member member;
    member.name = written.name;
    member.pose = pose;
    member.line = written.line;
    if (written.inertial) {
      member.has_inertial = true;
      member.inertia = moved(written.inertial->parameters(), pose);
      link.inertia = link.inertia + member.inertia;
    }
    for (CollisionBody body : written.collision) {
      body.pose = pose * body.pose;
      link.collision.push_back(std::move(body));
    }
    link.members.push_back(std::move(member));
  }

  Robot finish() {
    robot_.notes = document_.notes;
    for (const std::string& line : notes_.lines()) robot_.notes.push_back(line);
    NoteList massless;
    for (int i = 0; i < robot_.link_count(); ++i) {
      const Link& link = robot_.links[static_cast<std::size_t>(i)];
      if (link.members.size() > 1) {
        std::string names;
        for (std::size_t k = 1; k < link.members.size(); ++k) {
          names += (k == 1 ? "" : ", ") + link.members[k].name;
        }
        robot_.notes.push_back(
            fmt::format("{} also carries what is fixed to it: {}", link.name, names));
      }
      const bool moves = i > 0 || robot_.root == Root::floating;
      if (moves && link.inertia.mass() == 0.0) massless.add("moves but has no mass", link.name);
    }
    for (const std::string& line : massless.lines()) robot_.notes.push_back(line);
    if (const auto world = dropped_world()) robot_.notes.push_back(*world);
    SHAPEID_CONTRACT(why_malformed(robot_));
    return std::move(robot_);
  }

  /// Says so if the file's floating joint was taken away, and if the caller wants it fixed anyway.
  std::optional<std::string> dropped_world() const {
    for (const DocumentJoint& j : document_.joints) {
      if (j.type != DocumentJointType::floating) continue;
      const bool floats = options_.root == Root::floating;
      const bool turned = !j.joint.placement.linear().isIdentity();
      return fmt::format(
          "floating joint {} left out: {} is the {} root{}", j.joint.name, j.child,
          floats ? "floating" : "fixed (as asked)",
          turned && !floats ? ", upright: how the joint's origin turns it is left out" : "");
    }
    return std::nullopt;
  }

  const Document& document_;
  const Tree& tree_;
  const UrdfOptions& options_;
  Robot robot_;
  NoteList notes_;
  std::map<std::string, const DocumentJoint*> joints_;  ///< by name, once it is asked for
  std::vector<Place> place_;                            ///< per link of the document
  /// Moving joints whose parent is placed; the smallest index stands first in the document.
  std::priority_queue<int, std::vector<int>, std::greater<>> ready_;
};

}  // namespace

Robot lump(const Document& document, const Tree& tree, const UrdfOptions& options) {
  return Lumper(document, tree, options).lump();
}

}  // namespace shapeid::urdf
