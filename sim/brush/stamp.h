// What of the tuft stands over each cell of a footprint: its patch, and how much of its hair leaves ink.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "signal/ink_event.h"
#include "sim/brush/coverage.h"
#include "sim/brush/hair_texture.h"
#include "sim/brush/tuft_surface.h"

namespace fude {

// Names the patch of every cell of `map` that holds a sample of `touched` (over the same frame), and takes
// off the share of it under hair that leaves no ink.
class Stamp {
 public:
  Stamp(const Coverage& touched, const HairTexture& texture, const std::vector<InkLoad>& loads,
        FootprintMap& map);

  // Cells that no earlier call has named: from the last instant back to the first.
  void add(const Contact& contact);

  // Cells that hold a sample of the footprint but no centre take after a neighbour.
  void finish();

 private:
  struct Corner {
    Eigen::Vector2d cell;
    Eigen::Vector2d on_tuft;  // along, around
  };
  Corner corner(const ContactRing& ring, std::size_t j) const;
  void add_triangle(const Corner& a, const Corner& b, const Corner& c);
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
