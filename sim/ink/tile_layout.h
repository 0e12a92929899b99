// How the lattice lies in memory. The sheet is divided into square tiles; only tiles that are awake hold
// state, each in one block of an arena. A block is a row of planes, one float a cell, rows from the
// bottom of the sheet up:
//
//   flowing planes of parity 0 | of parity 1 | still planes | paper planes
//
// Neighbours read the flowing planes, so a step reads one parity and writes the other. Only the cell itself
// reads the still planes; the paper planes never change while the tile is awake.
#pragma once

#include <cstddef>
#include <cstdint>

namespace fude {

// Where the cells of a rectangle lie in the planes.
struct PlaneView {
  float* origin = nullptr;   // its lower left cell in the first plane
  std::ptrdiff_t row = 0;    // floats from one row of cells to the next
  std::ptrdiff_t plane = 0;  // floats from one plane to the next

  float* cells(std::size_t plane_index, int y) const {
    return origin + static_cast<std::ptrdiff_t>(plane_index) * plane + y * row;
  }
};

namespace tile {

inline constexpr int side = 32;  // cells; see docs/kernels.md for what 64 costs
inline constexpr int cells = side * side;
// Planes of whole 4 KiB would all fall into one set of the first-level cache.
inline constexpr std::size_t plane_stride = cells + 16;

enum Flowing : std::size_t { rest, e, n, w, s, ne, nw, sw, se, mass, fixed_ink = mass + 4, flowing_planes };
enum Still : std::size_t {
  surface,
  surface_mass,
  fixed_mass = surface_mass + 4,
  still_planes = fixed_mass + 4
};
enum Paper : std::size_t { blocking, grain, toe, paper_planes };

inline constexpr std::size_t still_begin = 2 * flowing_planes;
inline constexpr std::size_t paper_begin = still_begin + still_planes;
inline constexpr std::size_t planes = paper_begin + paper_planes;
inline constexpr std::size_t block_floats = planes * plane_stride;

// The nine tiles around one, row by row from below left; the tile itself is number 4.
inline constexpr std::size_t own = 4;
inline constexpr std::size_t neighbourhood = 9;

// What off the sheet keeps everything out: no link opens to it.
inline constexpr float closed_blocking = 3;
inline constexpr float closed_grain = 1e9F;

}  // namespace tile
}  // namespace fude
