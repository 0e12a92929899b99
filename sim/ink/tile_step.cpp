// Compiled once for each instruction set, with FUDE_STEP_KERNELS naming its table. Nothing here may be shared
// with another translation unit: the linker could keep the copy that the processor cannot run. So all but the
// table stands in an unnamed namespace.
#include "sim/ink/tile_step.h"

#include <algorithm>
#include <type_traits>

#include "sim/ink/kernels/lang_lanes.h"

namespace fude {
namespace {

// clang-format off
#include "sim/ink/kernels/numeric.k"
#include "sim/ink/kernels/site.k"
#include "sim/ink/kernels/link.k"
#include "sim/ink/kernels/collide.k"
#include "sim/ink/kernels/dry.k"
// clang-format on

}  // namespace
}  // namespace fude

// clang-format off
#include "sim/ink/shown_rows.h"
#include "sim/ink/row_step.h"
// clang-format on

namespace fude {
namespace {

using TileRows = Rows<tile::side, 0>;
using Column = Line<tile::shown_fields, tile::side, 0>;
using ColumnLinks = Line<sides * linked_fields, tile::side, 0>;
constexpr int pitch = TileRows::pitch;
static_assert(Column::pitch == pitch && ColumnLinks::pitch == pitch);

RowMemory tile_row(float* block, int y) {
  float* row = block + y * tile::row_stride;
  return {row, row, row + tile::still_begin * tile::plane_stride,
          row + tile::paper_begin * tile::plane_stride};
}

// Of the fields that are no populations.
template <bool ink>
constexpr int last_field = ink ? int{tile::shown_fields} : int{tile::shown_blocking} + 1;

// What goes over an edge: its populations, and all that is no population.
template <bool ink, class Put>
FUNCTION void for_each_field(tile::Edge edge, const Put& put) {
  for (int i = 0; i < tile::edge_populations; ++i) put(tile::leaving[edge][i], i);
  for (int f = tile::shown_blocking; f < last_field<ink>; ++f)
    put(f, tile::edge_populations + f - tile::shown_blocking);
}

// A tile and its neighbours as one step sees them.
struct Around {
  const Neighbourhood& blocks;
  int parity;

  float* block(int dx, int dy) const { return blocks[static_cast<std::size_t>(tile::own + 3 * dy + dx)]; }
  float* edge(int dx, int dy, tile::Edge which) const { return arena_edge(block(dx, dy), parity, which); }
};

// The cells of an edge as a line.
template <bool ink>
void show_edge_line(const float* from, tile::Edge edge, float* line) {
  for_each_field<ink>(
      edge, [&](int f, int i) { std::copy_n(from + i * tile::side, tile::side, line + f * pitch); });
}

// The cell of a line at x from the corner of the neighbour across it.
template <bool ink>
void show_corner(const Around& around, int dx, int dy, float* line, int x) {
  const auto corner = static_cast<tile::Corner>((dy < 0 ? 2 : 0) + (dx < 0 ? 1 : 0));  // theirs, opposite
  const float* from = arena_corner(around.block(dx, dy), around.parity, corner);
  line[tile::leaving_corner[corner] * pitch + x] = from[0];
  for (int f = tile::shown_blocking; f < last_field<ink>; ++f)
    line[f * pitch + x] = from[1 + f - tile::shown_blocking];
}

// What lies beyond the ends of the tile's rows: the neighbours' columns, and the links to them.
struct Beyond {
  Column west;
  Column east;
  ColumnLinks west_links;
  ColumnLinks east_links;

  // above: the row over the tile.
  template <bool ink>
  void prepare(const LatticeNumbers& k, const Around& around, const float* above) {
    show_edge_line<ink>(around.edge(-1, 0, tile::east), tile::east, west.begin());
    show_edge_line<ink>(around.edge(1, 0, tile::west), tile::west, east.begin());
    for (int dy : {-1, 1}) {
      const int y = dy < 0 ? -1 : tile::side;
      show_corner<ink>(around, -1, dy, west.begin(), y);
      show_corner<ink>(around, 1, dy, east.begin(), y);
    }
    if constexpr (ink) {
      Column own{};
      show_edge_line<ink>(around.edge(0, 0, tile::west), tile::west, own.begin());
      end_column(own, above, 0);
      link_columns<Column>(k, west.begin(), own.begin(), west_links.begin());
      show_edge_line<ink>(around.edge(0, 0, tile::east), tile::east, own.begin());
      end_column(own, above, tile::side - 1);
      link_columns<Column>(k, own.begin(), east.begin(), east_links.begin());
    }
  }

  static void end_column(Column& own, const float* above, int x) {
    for (int f = 0; f < tile::shown_fields; ++f) own.begin()[f * pitch + tile::side] = above[f * pitch + x];
  }

  // Cells -1 and tile::side of row y.
  template <bool ink>
  void show(int y, float* line) {
    for_each_field<ink>(tile::east, [&](int f, int) { line[f * pitch - 1] = west.begin()[f * pitch + y]; });
    for_each_field<ink>(tile::west,
                        [&](int f, int) { line[f * pitch + tile::side] = east.begin()[f * pitch + y]; });
  }

  void link(int y, float* line) {
    const auto put = [&](Side side, int x, ColumnLinks& links) {
      const int from = link_at(side, pitch);
      for (int f = 0; f < linked_fields; ++f)
        line[from + f * pitch + x] = links.begin()[from + f * pitch + y];
    };
    put(side_e, -1, west_links);
    put(side_ne, -1, west_links);
    put(side_nw, tile::side, east_links);
  }
};

// The outermost columns of a tile, planes one after the other from south to north.
struct OuterColumns {
  alignas(64) float west[tile::planes * tile::side];
  alignas(64) float east[tile::planes * tile::side];

  template <bool ink>
  void take(const float* row, int y) {
    const auto take_planes = [&](std::size_t first, std::size_t count) {
      for (std::size_t p = first; p < first + count; ++p) {
        const std::size_t to = p * tile::side + static_cast<std::size_t>(y);
        west[to] = row[p * tile::side];
        east[to] = row[p * tile::side + tile::side - 1];
      }
    };
    take_planes(tile::rest, ink ? std::size_t{tile::flowing_planes} : std::size_t{tile::mass});
    take_planes(tile::paper_begin, ink ? std::size_t{tile::paper_planes} : 1);
  }
};

template <bool ink, tile::Edge edge>
void make_edge(const LatticeNumbers& k, const float* cells, float* block, int parity) {
  show_row<ink, EdgeFields<edge>, 0, tile::side>(k, TilePlanes{}, cells,
                                                 cells + tile::paper_begin * tile::plane_stride,
                                                 arena_edge(block, parity, edge));
}

void make_corner(float* block, int parity, tile::Corner corner) {
  const bool up = corner == tile::north_west || corner == tile::north_east;
  const bool right = corner == tile::south_east || corner == tile::north_east;
  const tile::Edge edge = up ? tile::north : tile::south;
  const int* leaving = tile::leaving[edge];
  const auto i = std::find(leaving, leaving + tile::edge_populations, tile::leaving_corner[corner]) - leaving;
  const float* from = arena_edge(block, parity, edge) + (right ? tile::side - 1 : 0);
  float* to = arena_corner(block, parity, corner);
  to[0] = from[i * tile::side];
  for (int f = tile::edge_populations; f < tile::edge_fields; ++f)
    to[1 + f - tile::edge_populations] = from[f * tile::side];
}

template <bool ink>
void make_edges(const LatticeNumbers& k, float* block, const OuterColumns& columns, int parity) {
  make_edge<ink, tile::south>(k, block, block, parity);
  make_edge<ink, tile::north>(k, block + (tile::side - 1) * tile::row_stride, block, parity);
  make_edge<ink, tile::west>(k, columns.west, block, parity);
  make_edge<ink, tile::east>(k, columns.east, block, parity);
  for (int corner = 0; corner < tile::corners; ++corner)
    make_corner(block, parity, static_cast<tile::Corner>(corner));
}

template <bool ink>
void make_edges_anew(const LatticeNumbers& k, float* block, int parity) {
  OuterColumns columns;
  for (int y = 0; y < tile::side; ++y) columns.take<ink>(block + y * tile::row_stride, y);
  make_edges<ink>(k, block, columns, parity);
}

// Asks for what later rows need: the processor does not foresee jumps between this many planes and loops. Far
// ahead from memory, shortly before into the first level (docs/kernels.md has what it is worth).
constexpr int rows_ahead = 8;
constexpr int rows_soon = 2;
constexpr int cache_line = 64 / sizeof(float);

enum class Level { first = 3, second = 2 };  // as __builtin_prefetch counts

// One of `parts` equal parts of some floats: the processor waits when it is asked for too much at once.
template <Level level, int part = 0, int parts = 1>
FUNCTION void fetch(const float* first, int floats) {
  const int count = floats / cache_line;
#pragma GCC unroll 64
  for (int i = count * part / parts; i < count * (part + 1) / parts; ++i)
    __builtin_prefetch(first + i * cache_line, level == Level::second, static_cast<int>(level));
}

struct Ahead {
  const Around& here;
  const Around& next;

  template <bool ink, int part>
  [[gnu::always_inline]] void row(int y) const {
    fetch_row<Level::second, ink, part>(y + rows_ahead);
    if (y + rows_soon < tile::side) fetch_row<Level::first, ink, part>(y + rows_soon);
  }

  // Of this tile or, past its end, of the next.
  template <Level level, bool ink, int part>
  [[gnu::always_inline]] void fetch_row(int y) const {
    const float* row = (y < tile::side ? here : next).block(0, 0) + y % tile::side * tile::row_stride;
    if constexpr (ink) {
      fetch<level, part, 3>(row, tile::row_stride);
    } else {
      fetch<level, part, 3>(row, tile::mass * tile::plane_stride);
      if constexpr (part == 0) fetch<level>(row + tile::paper_begin * tile::plane_stride, tile::plane_stride);
    }
  }

  // What the next tile reads and writes of its own edges, and reads of its neighbours' but the one to the
  // west, which this tile leaves in the cache.
  [[gnu::always_inline]] void edges(int y) const {
    constexpr int own = (2 * tile::edges_stride / cache_line + tile::side - 1) / tile::side * cache_line;
    fetch<Level::second>(next.block(0, 0) + tile::edges_begin + y * own, own);
    if (y * cache_line >= tile::edge_floats) return;
    fetch<Level::second>(next.edge(1, 0, tile::west) + y * cache_line, cache_line);
    fetch<Level::second>(next.edge(0, 1, tile::south) + y * cache_line, cache_line);
    fetch<Level::second>(next.edge(0, -1, tile::north) + y * cache_line, cache_line);
  }
};

template <bool ink>
void step_tile(const LatticeNumbers& k, const Neighbourhood& blocks, const Neighbourhood& next, int parity,
               TileOutcome& outcome) {
  const Around around{blocks, parity};
  const Around then{next, parity};
  const Ahead ahead{around, then};
  float* block = blocks[tile::own];
  TileRows rows;
  Beyond beyond{};
  OuterColumns columns;
  Tally<tile::side> tally;
  const auto link = [&](int y) {
    if constexpr (ink) {
      link_row<TileRows>(k, rows.shown(y), rows.shown(y + 1), rows.linked(y));
      beyond.link(y, rows.linked(y));
    }
  };
  show_edge_line<ink>(around.edge(0, 1, tile::south), tile::south, rows.shown(tile::side));
  beyond.prepare<ink>(k, around, rows.shown(tile::side));
  const auto show = [&](int y) {
    if (y < 0)
      show_edge_line<ink>(around.edge(0, -1, tile::north), tile::north, rows.shown(y));
    else if (y == tile::side)
      show_edge_line<ink>(around.edge(0, 1, tile::south), tile::south, rows.shown(y));
    else
      show_row<ink, RowFields<pitch>, 0, tile::side>(k, TilePlanes{}, tile_row(block, y).flowing,
                                                     tile_row(block, y).paper, rows.shown(y));
    beyond.show<ink>(y, rows.shown(y));
  };
  show(-1);
  show(0);
  link(-1);
  for (int y = 0; y < tile::side; ++y) {
    ahead.row<ink, 0>(y);
    show(y + 1);
    ahead.row<ink, 1>(y);
    link(y);
    ahead.row<ink, 2>(y);
    const Surroundings<pitch> here{{rows.shown(y - 1), rows.shown(y), rows.shown(y + 1)},
                                   {rows.linked(y - 1), rows.linked(y)}};
    const RowMemory memory = tile_row(block, y);
    step_row<ink>(k, TilePlanes{}, here, memory, y, tally);
    columns.take<ink>(memory.flowing, y);
    ahead.edges(y);
  }
  make_edges<ink>(k, block, columns, 1 - parity);
  if constexpr (ink) tally.finish(outcome);
}

template <bool ink>
void step_dense(const LatticeNumbers& k, const PlaneView& now, const PlaneView& next, TileOutcome& outcome) {
  constexpr int reach = dense_margin;
  using DenseRows = Rows<dense_width, reach>;
  const DensePlanes planes{now.plane};
  DenseRows rows;
  Tally<dense_width> tally;
  const auto show = [&](int y) {
    show_row<ink, RowFields<DenseRows::pitch>, reach, dense_width>(
        k, planes, now.cells(0, y), now.cells(tile::paper_begin, y), rows.shown(y));
  };
  const auto link = [&](int y) {
    if constexpr (ink) link_row<DenseRows>(k, rows.shown(y), rows.shown(y + 1), rows.linked(y));
  };
  show(-1);
  show(0);
  link(-1);
  for (int y = 0; y < tile::side; ++y) {
    show(y + 1);
    link(y);
    const Surroundings<DenseRows::pitch> here{{rows.shown(y - 1), rows.shown(y), rows.shown(y + 1)},
                                              {rows.linked(y - 1), rows.linked(y)}};
    step_row<ink>(
        k, planes, here,
        {now.cells(0, y), next.cells(0, y), now.cells(tile::still_begin, y), now.cells(tile::paper_begin, y)},
        y, tally);
  }
  if constexpr (ink) tally.finish(outcome);
}

}  // namespace

extern const StepKernels FUDE_STEP_KERNELS;
const StepKernels FUDE_STEP_KERNELS{{step_tile<true>, make_edges_anew<true>, step_dense<true>},
                                    {step_tile<false>, make_edges_anew<false>, step_dense<false>}};

}  // namespace fude
