// What of the tuft stands over each cell of a footprint: its patch, and how much of its hair leaves ink.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "signal/ink_event.h"
#include "sim/brush/contact_mesh.h"
#include "sim/brush/coverage.h"
#include "sim/brush/hair_texture.h"
#include "sim/brush/tuft_surface.h"

namespace fude {

// Names the patches of a map's cells, and takes off the share of them under hair that leaves no ink.
class Stamp {
 public:
  // `map` is over `frame`; both outlive the stamp.
  Stamp(const CoverageFrame& frame, const HairTexture& texture, const std::vector<InkLoad>& loads,
        FootprintMap& map);

  // Cells that hold a sample of `cover` wait to be named, if they are not yet.
  void wait_for(const Coverage& cover);
  bool waits() const;

  // Names cells that wait: those under the contact, or under its rim on its way from a to b.
  void add(const Contact& contact);
  void add_passage(const ContactMesh& a, const ContactMesh& b);

  // Cells that still wait, since no centre of theirs was covered, take after a neighbour.
  void finish();

 private:
  MeshPoint in_cells(const MeshPoint& p) const;
  void add_quad(const MeshPoint& a, const MeshPoint& b, const MeshPoint& c, const MeshPoint& d);
  void add_triangle(const MeshPoint& a, const MeshPoint& b, const MeshPoint& c);
  template <class Take>
  void take_waiting(int row, int first, int end, Take take);
  std::size_t nearest(int row, int column) const;
  std::size_t at(int row, int column) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(map_.columns) +
           static_cast<std::size_t>(column);
  }

  const CoverageFrame& frame_;
  const HairTexture& texture_;
  const std::vector<InkLoad>& loads_;
  FootprintMap& map_;
  bool streaky_ = false;
  std::vector<float> inked_;  // where streaky
  // A bit a cell, in rows of whole words.
  std::size_t words_ = 0;
  std::vector<std::uint64_t> waiting_;
  std::vector<std::uint64_t> named_;
};

}  // namespace fude
