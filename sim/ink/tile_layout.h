// How the lattice lies in memory. The sheet is divided into square tiles; only tiles that are awake hold
// state, each a block of an arena: its rows from the bottom of the sheet up, in each row its planes, one
// float a cell, so that a step reads and writes one long run of memory; then its edges.
//
// A step works in place: neighbours do not read a tile's cells but its edges, which hold what its outermost
// cells show, and which are there twice. A step reads those of one parity and writes those of the other.
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

inline constexpr std::size_t still_begin = flowing_planes;
inline constexpr std::size_t paper_begin = still_begin + still_planes;
inline constexpr std::size_t planes = paper_begin + paper_planes;

// What a cell shows its neighbours, in the order of the edges.
enum Shown : int {
  shown_e,
  shown_n,
  shown_w,
  shown_s,
  shown_ne,
  shown_nw,
  shown_sw,
  shown_se,
  shown_blocking,
  shown_concentration,
  shown_head = shown_concentration + 4,
  shown_diagonal_head,
  shown_toes,
  shown_barrier,
  shown_toe,
  shown_fields
};

// An edge holds what its outermost cells show, from west to east or from south to north: the three
// populations that leave the tile over it, then all that is no population.
enum Edge : int { south, north, west, east, edges };
inline constexpr int edge_populations = 3;
inline constexpr int leaving[edges][edge_populations] = {{shown_s, shown_sw, shown_se},
                                                         {shown_n, shown_ne, shown_nw},
                                                         {shown_w, shown_nw, shown_sw},
                                                         {shown_e, shown_ne, shown_se}};
inline constexpr int edge_fields = edge_populations + shown_fields - shown_blocking;

// The cells at the corners show it to the tiles across them: one population, then as an edge; a cache line
// each.
enum Corner : int { south_west, south_east, north_west, north_east, corners };
inline constexpr int leaving_corner[corners] = {shown_sw, shown_se, shown_nw, shown_ne};

// In the arena.
inline constexpr std::size_t chunk_tiles = 64;
inline constexpr std::ptrdiff_t plane_stride = side;
inline constexpr std::ptrdiff_t row_stride = planes * plane_stride;
inline constexpr std::ptrdiff_t edge_floats = edge_fields * side;
inline constexpr std::ptrdiff_t corner_floats = 16;
inline constexpr std::ptrdiff_t edges_begin = side * row_stride;
inline constexpr std::ptrdiff_t edges_stride = edges * edge_floats + corners * corner_floats;
inline constexpr std::size_t block_floats = edges_begin + 2 * edges_stride;

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
  float* flowing;        // its lower left cell in the first flowing plane
  float* other;          // the same in the first of the still and paper planes
  std::ptrdiff_t row;    // floats from one row of cells to the next
  std::ptrdiff_t plane;  // floats from one plane to the next

  [[gnu::always_inline]] PlaneView(float* first_flowing, float* first_other, std::ptrdiff_t row_stride,
                                   std::ptrdiff_t plane_stride)
      : flowing(first_flowing), other(first_other), row(row_stride), plane(plane_stride) {}
  // Planes all one after the other.
  [[gnu::always_inline]] PlaneView(float* first, std::ptrdiff_t row_stride, std::ptrdiff_t plane_stride)
      : PlaneView(first, first + static_cast<std::ptrdiff_t>(tile::flowing_planes) * plane_stride, row_stride,
                  plane_stride) {}

  [[gnu::always_inline]] float* cells(std::size_t index, int y) const {
    const bool flows = index < tile::flowing_planes;
    const std::size_t at = flows ? index : index - tile::flowing_planes;
    return (flows ? flowing : other) + static_cast<std::ptrdiff_t>(at) * plane + y * row;
  }
};

[[gnu::always_inline]] inline PlaneView arena_view(float* block) {
  return {block, tile::row_stride, tile::plane_stride};
}

[[gnu::always_inline]] inline float* arena_edge(float* block, int parity, tile::Edge edge) {
  return block + tile::edges_begin + parity * tile::edges_stride + edge * tile::edge_floats;
}

[[gnu::always_inline]] inline float* arena_corner(float* block, int parity, tile::Corner corner) {
  return arena_edge(block, parity, tile::edges) + corner * tile::corner_floats;
}

}  // namespace fude
