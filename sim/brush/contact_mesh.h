// A contact as a mesh of triangles, five points to a ring: what it covers, and what it passes over on its
// way to another contact of the same tuft. Only the rim of the mesh and its folds are drawn.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "sim/brush/tuft_surface.h"
#include "sim/brush/winding_fill.h"

namespace fude {

class ContactMesh {
 public:
  // Takes the place of what was there, in its memory.
  void take(const TuftSurface& surface);

  const Contact& contact() const { return contact_; }

  // All that the triangles cover.
  void add_to(WindingFill& filling) const;

  // What the rim passes over from a to b, where both show the same part of the tuft.
  friend void add_passage(WindingFill& filling, const ContactMesh& a, const ContactMesh& b);

 private:
  // Edges that start on a ring: across it, along to the next ring, and the diagonals between the two.
  static constexpr std::size_t edges_per_ring = 3 * ring_points - 2;
  using RimWeights = std::array<int, edges_per_ring>;

  const Eigen::Vector2d& head(std::size_t ring, std::size_t edge) const;
  const Eigen::Vector2d& tail(std::size_t ring, std::size_t edge) const;

  Contact contact_;
  std::vector<bool> joined_;  // of each ring: to the next
  // How often an edge borders what is covered, each triangle counting once whichever way it turns: nought
  // inside, one on the rim, two in a fold.
  std::vector<RimWeights> rim_;
};

}  // namespace fude
