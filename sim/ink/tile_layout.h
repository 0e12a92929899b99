// How the lattice lies in memory. The sheet is divided into square tiles; only tiles that are awake hold
// state, each a block of an arena in three parts: the flowing planes of parity 0, those of parity 1, and the
// still and the paper planes. A part holds its rows from the bottom of the sheet up, and in each row its
// planes, one float a cell. The parts of many tiles lie together, so that a step reads and writes long runs
// of memory, which the processor foresees (docs/kernels.md has what that is worth).
//
// Neighbours read the flowing planes, so a step reads one parity and writes the other. Only the cell itself
// reads the still planes; the paper planes never change while the tile is awake.
#pragma once

#include <cstddef>
#include <cstdint>

namespace fude {

namespace tile {

inline constexpr int side = 32;  // cells; see docs/kernels.md for what 64 costs
inline constexpr int cells = side * side;

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
inline constexpr std::ptrdiff_t part_planes = flowing_planes;
static_assert(planes <= 3 * part_planes);

// In the arena.
inline constexpr std::size_t parts = 3;
inline constexpr std::size_t chunk_tiles = 64;
inline constexpr std::ptrdiff_t plane_stride = side;
inline constexpr std::ptrdiff_t row_stride = part_planes * plane_stride;
inline constexpr std::size_t part_floats = side * row_stride;
inline constexpr std::ptrdiff_t part_stride = chunk_tiles * part_floats;

// The nine tiles around one, row by row from below left; the tile itself is number 4.
inline constexpr std::size_t own = 4;
inline constexpr std::size_t neighbourhood = 9;

// What off the sheet keeps everything out: no link opens to it.
inline constexpr float closed_blocking = 3;
inline constexpr float closed_grain = 1e9F;

}  // namespace tile

// Where the cells of a rectangle lie in the planes. Always inlined: the units of the instruction sets use it,
// and must not leave copies that others could link to.
struct PlaneView {
  float* origin;         // its lower left cell in the first plane
  std::ptrdiff_t row;    // floats from one row of cells to the next
  std::ptrdiff_t plane;  // floats from one plane of a part to the next
  std::ptrdiff_t part;   // floats from one part to the next

  // Planes all one after the other.
  [[gnu::always_inline]] PlaneView(float* first, std::ptrdiff_t row_stride, std::ptrdiff_t plane_stride)
      : PlaneView(first, row_stride, plane_stride, tile::part_planes * plane_stride) {}
  [[gnu::always_inline]] PlaneView(float* first, std::ptrdiff_t row_stride, std::ptrdiff_t plane_stride,
                                   std::ptrdiff_t part_stride)
      : origin(first), row(row_stride), plane(plane_stride), part(part_stride) {}

  [[gnu::always_inline]] float* cells(std::size_t index, int y) const {
    return origin + static_cast<std::ptrdiff_t>(index / tile::part_planes) * part +
           static_cast<std::ptrdiff_t>(index % tile::part_planes) * plane + y * row;
  }
};

[[gnu::always_inline]] inline PlaneView arena_view(float* block) {
  return {block, tile::row_stride, tile::plane_stride, tile::part_stride};
}

}  // namespace fude
