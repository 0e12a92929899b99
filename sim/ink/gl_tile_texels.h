// A tile between the processor's planes (tile_layout.h) and the card's texels (gl_tiles.inc).
#pragma once

#include <span>
#include <vector>

#include "sim/ink/lattice_numbers.h"
#include "sim/ink/tile_layout.h"

namespace fude {

// The texels of one tile, each group as it lies in its buffer: two for every cell, one of the paper.
struct TileTexels {
  std::vector<float> moving;
  std::vector<float> surface;
  std::vector<float> shown;
  std::vector<float> pigment;
  std::vector<float> paper;
};

inline constexpr std::size_t floats_a_texel = 4;
inline constexpr std::size_t pair_floats = 2 * floats_a_texel * tile::cells;
inline constexpr std::size_t paper_floats = floats_a_texel * tile::cells;

// planes: all of tile::planes; fixed_ink follows from the fixed masses.
TileTexels texels_of(const LatticeNumbers& numbers, const PlaneView& planes);

// Fills the flowing and the still planes. Each span: pair_floats.
void fill_planes(std::span<const float> moving, std::span<const float> surface,
                 std::span<const float> pigment, const PlaneView& planes);

// The fixed masses in a tile's pigment texels, plane by plane.
std::vector<float> fixed_masses(std::span<const float> pigment);

}  // namespace fude
