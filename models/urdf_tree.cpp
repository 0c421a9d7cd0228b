#include "shapeid/models/urdf_tree.hpp"

#include <fmt/format.h>

#include <unordered_map>

namespace shapeid::urdf {
namespace {

using Names = std::unordered_map<std::string, int>;

template <typename Items, typename NameOf>
Names index_names(const Document& document, const Items& items, const char* what, NameOf name_of) {
  Names names;
  for (std::size_t i = 0; i < items.size(); ++i) {
    const auto [first, fresh] = names.emplace(name_of(items[i]), static_cast<int>(i));
    if (!fresh) {
      const int earlier = items[static_cast<std::size_t>(first->second)].line;
      throw InputError(
          {document.file, items[i].line, {}},
          fmt::format("a second {} {} (the first is in line {})", what, name_of(items[i]), earlier),
          "names must differ");
    }
  }
  return names;
}

int link_named(const Document& document, const Names& names, const std::string& link,
               const DocumentJoint& joint, const char* role) {
  const auto found = names.find(link);
  if (found == names.end()) {
    throw InputError({document.file, joint.line, {}},
                     fmt::format("joint {}: no link is named {}", joint.joint.name, link),
                     fmt::format("name a link of this file as its {}", role));
  }
  return found->second;
}

int find_root(const Document& document, const std::vector<int>& parent_joint) {
  int root = -1;
  for (std::size_t i = 0; i < parent_joint.size(); ++i) {
    if (parent_joint[i] >= 0) continue;
    if (root >= 0) {
      throw InputError(
          {document.file, document.links[i].line, {}},
          fmt::format("links {} and {} both have no parent",
                      document.links[static_cast<std::size_t>(root)].name, document.links[i].name),
          "a robot is one tree: join them, or remove one");
    }
    root = static_cast<int>(i);
  }
  if (root < 0) {
    throw InputError({document.file, document.links.front().line, {}},
                     "every link has a parent, so the joints form a cycle",
                     "a robot is a tree: remove a joint");
  }
  return root;
}

/// With one parent each and one root, a link that the root does not reach hangs on a cycle.
void refuse_cycles(const Document& document, const Tree& tree) {
  std::vector<bool> reached(document.links.size(), false);
  std::vector<int> pending = {tree.root};
  while (!pending.empty()) {
    const auto link = static_cast<std::size_t>(pending.back());
    pending.pop_back();
    reached[link] = true;
    for (const int j : tree.outward[link]) {
      pending.push_back(tree.child[static_cast<std::size_t>(j)]);
    }
  }
  for (std::size_t i = 0; i < reached.size(); ++i) {
    if (reached[i]) continue;
    throw InputError({document.file, document.links[i].line, {}},
                     fmt::format("link {} is on a cycle of joints, or hangs on one, apart from {}",
                                 document.links[i].name,
                                 document.links[static_cast<std::size_t>(tree.root)].name),
                     "a robot is a tree: remove a joint");
  }
}

/// <joint type="floating"> from an empty link says only that its child floats.
void drop_world(const Document& document, Tree& tree) {
  const auto world = static_cast<std::size_t>(tree.root);
  for (const DocumentJoint& joint : document.joints) {
    if (joint.type != DocumentJointType::floating) continue;
    const DocumentLink& root = document.links[world];
    const bool empty = (!root.inertial || root.inertial->mass == 0.0) && root.collision.empty();
    if (joint.parent != root.name || !empty || tree.outward[world].size() != 1) {
      throw InputError({document.file, joint.line, {}},
                       fmt::format("joint {} is floating, but {} is not an empty root link that "
                                   "carries nothing else",
                                   joint.joint.name, joint.parent),
                       "a floating joint ties the whole robot to the world, or is not understood");
    }
    tree.root = tree.child[static_cast<std::size_t>(tree.outward[world].front())];
  }
}

}  // namespace

Tree resolve(const Document& document) {
  const Names links =
      index_names(document, document.links, "link", [](const DocumentLink& l) { return l.name; });
  index_names(document, document.joints, "joint",
              [](const DocumentJoint& j) { return j.joint.name; });

  Tree tree;
  tree.outward.resize(document.links.size());
  std::vector<int> parent_joint(document.links.size(), -1);
  for (std::size_t j = 0; j < document.joints.size(); ++j) {
    const DocumentJoint& joint = document.joints[j];
    const int parent = link_named(document, links, joint.parent, joint, "parent");
    const int child = link_named(document, links, joint.child, joint, "child");
    int& above = parent_joint[static_cast<std::size_t>(child)];
    if (above >= 0) {
      throw InputError({document.file, joint.line, {}},
                       fmt::format("link {} has two parents: joints {} and {}", joint.child,
                                   document.joints[static_cast<std::size_t>(above)].joint.name,
                                   joint.joint.name),
                       "a robot is a tree: remove one of the joints");
    }
    above = static_cast<int>(j);
    tree.parent.push_back(parent);
    tree.child.push_back(child);
    tree.outward[static_cast<std::size_t>(parent)].push_back(static_cast<int>(j));
  }
  tree.root = find_root(document, parent_joint);
  refuse_cycles(document, tree);
  drop_world(document, tree);
  return tree;
}

}  // namespace shapeid::urdf
