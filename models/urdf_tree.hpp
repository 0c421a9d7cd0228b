// From a URDF as written to the tree of rigid bodies. Internal to models.
#pragma once

#include <vector>

#include "shapeid/models/urdf.hpp"
#include "shapeid/models/urdf_document.hpp"

namespace shapeid::urdf {

/// References resolved: the links and joints of a document form one tree.
struct Tree {
  int root = 0;                           ///< index of the root in Document::links
  std::vector<int> parent, child;         ///< per joint: indices of its two links
  std::vector<std::vector<int>> outward;  ///< per link: joints it is the parent of, document order
};

/// Throws InputError for names that repeat or are unknown, two parents, cycles, several roots. A
/// link without mass that carries nothing but one floating joint is the world, not a root.
[[nodiscard]] Tree resolve(const Document& document);

/// Lumps what fixed and locked joints tie together, parents first. Among the moving joints whose
/// parent is placed, the one that stands first in the document comes next.
[[nodiscard]] Robot lump(const Document& document, const Tree& tree, const UrdfOptions& options);

}  // namespace shapeid::urdf
