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

// A corner of the mesh, and which hair it is.
struct MeshPoint {
  Eigen::Vector2d at;       // mm
  Eigen::Vector2d on_tuft;  // along, around
  HairState hair;
};

class ContactMesh {
 public:
  // Takes the place of what was there, in its memory.
  void take(const TuftSurface& surface);

  const Contact& contact() const { return contact_; }

  // All that the triangles cover.
  void add_to(WindingFill& filling) const;

  // Calls quad(a.head, a.tail, b.tail, b.head), of MeshPoints, for what each edge of the rim passes over
  // from a to b, where both show the same part of the tuft.
  template <class Quad>
  friend void for_each_passage(const ContactMesh& a, const ContactMesh& b, Quad quad);

 private:
  // Edges that start on a ring: across it, along to the next ring, and the diagonals between the two.
  static constexpr std::size_t edges_per_ring = 3 * ring_points - 2;
  using RimWeights = std::array<int, edges_per_ring>;
  struct Edge {
    std::size_t from;  // point of this ring
    bool onward;       // to a point of the next
    std::size_t to;
  };
  static constexpr std::array<Edge, edges_per_ring> edges = [] {
    std::array<Edge, edges_per_ring> all{};
    std::size_t i = 0;
    for (std::size_t j = 1; j < ring_points; ++j) all[i++] = {j - 1, false, j};
    for (std::size_t j = 0; j < ring_points; ++j) all[i++] = {j, true, j};
    for (std::size_t j = 1; j < ring_points; ++j) all[i++] = {j - 1, true, j};
    return all;
  }();

  MeshPoint point(std::size_t ring, std::size_t j) const {
    const ContactRing& r = contact_.rings[ring];
    return {r.point[j], {r.along, r.around[j]}, r.hair};
  }
  MeshPoint head(std::size_t ring, const Edge& edge) const { return point(ring, edge.from); }
  MeshPoint tail(std::size_t ring, const Edge& edge) const {
    return point(ring + (edge.onward ? 1 : 0), edge.to);
  }

  Contact contact_;
  std::vector<bool> joined_;  // of each ring: to the next
  // How often an edge borders what is covered, each triangle counting once whichever way it turns: nought
  // inside, one on the rim, two in a fold.
  std::vector<RimWeights> rim_;
};

template <class Quad>
void for_each_passage(const ContactMesh& a, const ContactMesh& b, Quad quad) {
  const auto& before = a.contact_.rings;
  const auto& after = b.contact_.rings;
  bool goes_on = false;
  for (std::size_t i = 0, j = 0; i < before.size() && j < after.size();) {
    if (before[i].place != after[j].place) {
      before[i].place < after[j].place ? ++i : ++j;
      goes_on = false;
      continue;
    }
    const bool begins = !goes_on;
    goes_on = a.joined_[i] && b.joined_[j] && before[i + 1].place == after[j + 1].place;
    for (std::size_t k = 0; k < ContactMesh::edges_per_ring; ++k) {
      const ContactMesh::Edge& edge = ContactMesh::edges[k];
      if (edge.onward && !goes_on) break;
      // Where the shared part ends its ring passes whole: what lies beyond differs.
      const bool ends = !edge.onward && (begins || !goes_on);
      if (!ends && a.rim_[i][k] == 0 && b.rim_[j][k] == 0) continue;
      quad(a.head(i, edge), a.tail(i, edge), b.tail(j, edge), b.head(j, edge));
    }
    ++i;
    ++j;
  }
}

}  // namespace fude
