// Compiled once for each instruction set, with FUDE_STEP_KERNELS naming its table. A row of cells is one
// vector loop. Nothing here may be shared with another translation unit: the linker could keep the copy
// that the processor cannot run. So all but the table stands in an unnamed namespace.
#include "sim/ink/tile_step.h"

#include "sim/ink/kernels/lang_cpp.h"

namespace fude {
namespace {

// clang-format off
#include "sim/ink/kernels/numeric.k"
#include "sim/ink/kernels/site.k"
#include "sim/ink/kernels/link.k"
#include "sim/ink/kernels/collide.k"
#include "sim/ink/kernels/dry.k"
// clang-format on

// What the cells of a row show their neighbours, derived once. Two rows are kept while a block is swept from
// below, and the links of two rows; they stay in the first-level cache.
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
  shown_water,
  shown_per_water,
  shown_concentration,
  shown_head = shown_concentration + 4,
  shown_diagonal_head,
  shown_toes,
  shown_barrier,
  shown_toe,
  shown_fields
};

// The links of a row of cells to the east and upwards, six floats each.
enum Linked : int { linked_water, linked_mass, linked_edge = linked_mass + 4 };
constexpr int linked_fields = 6;
enum Side : int { side_e, side_n, side_ne, side_nw };
constexpr int sides = 4;

constexpr int link_at(Side side, int pitch) { return static_cast<int>(side) * linked_fields * pitch; }

template <int block_width>
struct Rows {
  static constexpr int width = block_width;
  static constexpr int margin = 16;  // column 0 on a cache line, and one cell beyond either end
  static constexpr int pitch = width + 2 * margin;
  alignas(64) float shown[3][shown_fields * pitch];
  alignas(64) float linked[2][sides * linked_fields * pitch];

  float* shown_row(int y) { return shown[(y + 3) % 3] + margin; }
  float* linked_row(int y) { return linked[(y + 2) % 2] + margin; }
};

// The rows below, at and above a cell, and the links of those below and at it.
template <int row_pitch>
struct Surroundings {
  static constexpr int pitch = row_pitch;
  const float* shown[3];
  const float* linked[2];
};

template <class Around>
FUNCTION float shown(const Around& rows, int field, int x, int dx, int dy) {
  return rows.shown[1 + dy][field * Around::pitch + x + dx];
}

template <class Around>
FUNCTION Site shown_site(const Around& rows, int x, int dx, int dy) {
  Site site;
  site.water = shown(rows, shown_water, x, dx, dy);
  site.per_water = shown(rows, shown_per_water, x, dx, dy);
  site.concentration = {
      shown(rows, shown_concentration, x, dx, dy), shown(rows, shown_concentration + 1, x, dx, dy),
      shown(rows, shown_concentration + 2, x, dx, dy), shown(rows, shown_concentration + 3, x, dx, dy)};
  site.blocking = shown(rows, shown_blocking, x, dx, dy);
  site.head = shown(rows, shown_head, x, dx, dy);
  site.diagonal_head = shown(rows, shown_diagonal_head, x, dx, dy);
  site.toes = shown(rows, shown_toes, x, dx, dy);
  site.barrier = shown(rows, shown_barrier, x, dx, dy);
  site.toe = shown(rows, shown_toe, x, dx, dy);
  return site;
}

template <class Around>
FUNCTION Crossing linked(const Around& rows, Side side, int x, int dx, int dy) {
  const float* c = rows.linked[1 + dy] + link_at(side, Around::pitch) + x + dx;
  constexpr int pitch = Around::pitch;
  return {c[linked_water * pitch],
          {c[linked_mass * pitch], c[(linked_mass + 1) * pitch], c[(linked_mass + 2) * pitch],
           c[(linked_mass + 3) * pitch]},
          c[linked_edge * pitch]};
}

template <int pitch>
FUNCTION void put_link(float* row, Side side, int x, const Crossing& crossing) {
  float* c = row + link_at(side, pitch) + x;
  c[linked_water * pitch] = crossing.water;
  c[linked_mass * pitch] = crossing.mass.x;
  c[(linked_mass + 1) * pitch] = crossing.mass.y;
  c[(linked_mass + 2) * pitch] = crossing.mass.z;
  c[(linked_mass + 3) * pitch] = crossing.mass.w;
  c[linked_edge * pitch] = crossing.edge;
}

#define CELL_PARAMETERS , const auto &rows, int x
#define CELL_ARGUMENTS , rows, x
#define CROSSING(side, dx, dy) linked(rows, side_##side, x, dx, dy)
#define ARRIVING(member, dx, dy) shown(rows, shown_##member, x, dx, dy)
#define BLOCKING(dx, dy) shown(rows, shown_blocking, x, dx, dy)
#include "sim/ink/kernels/step.k"
#include "sim/ink/kernels/water.k"

template <class Around>
FUNCTION Crossing link_e(const LatticeNumbers& k, const Around& rows, const Site& here, int x) {
  const Site there = shown_site(rows, x, 1, 0);
  return crossing(k, here, there, here.head, there.head, k.pace_straight, ARRIVING(e, 0, 0),
                  ARRIVING(w, 1, 0));
}

template <class Around>
FUNCTION Crossing link_n(const LatticeNumbers& k, const Around& rows, const Site& here, int x) {
  const Site there = shown_site(rows, x, 0, 1);
  return crossing(k, here, there, here.head, there.head, k.pace_straight, ARRIVING(n, 0, 0),
                  ARRIVING(s, 0, 1));
}

template <class Around>
FUNCTION Crossing link_ne(const LatticeNumbers& k, const Around& rows, const Site& here, int x) {
  const Site there = shown_site(rows, x, 1, 1);
  return crossing(k, here, there, here.diagonal_head, there.diagonal_head, k.pace_diagonal,
                  ARRIVING(ne, 0, 0), ARRIVING(sw, 1, 1));
}

template <class Around>
FUNCTION Crossing link_nw(const LatticeNumbers& k, const Around& rows, const Site& here, int x) {
  const Site there = shown_site(rows, x, -1, 1);
  return crossing(k, here, there, here.diagonal_head, there.diagonal_head, k.pace_diagonal,
                  ARRIVING(nw, 0, 0), ARRIVING(se, -1, 1));
}

// The links of the row `rows` stands at, to the east and to the row above.
template <class Rows>
void link_row(const LatticeNumbers& numbers, const Surroundings<Rows::pitch>& rows, float* to) {
  const LatticeNumbers k = numbers;
  constexpr int pitch = Rows::pitch;
  constexpr int width = Rows::width;
  put_link<pitch>(to, side_e, -1, link_e(k, rows, shown_site(rows, -1, 0, 0), -1));
  put_link<pitch>(to, side_ne, -1, link_ne(k, rows, shown_site(rows, -1, 0, 0), -1));
  put_link<pitch>(to, side_nw, width, link_nw(k, rows, shown_site(rows, width, 0, 0), width));
#pragma GCC ivdep
  for (int x = 0; x < width; ++x) {
    const Site here = shown_site(rows, x, 0, 0);
    put_link<pitch>(to, side_e, x, link_e(k, rows, here, x));
    put_link<pitch>(to, side_n, x, link_n(k, rows, here, x));
    put_link<pitch>(to, side_ne, x, link_ne(k, rows, here, x));
    put_link<pitch>(to, side_nw, x, link_nw(k, rows, here, x));
  }
}

// Where a row of cells lies in the planes: its cells, and those just left and right of it.
struct Source {
  const float* left;
  const float* row;
  const float* right;
};

// Planes one after the other in a tile's block, or each over the whole sheet.
struct TilePlanes {
  static constexpr std::ptrdiff_t plane = tile::plane_stride;
};
struct DensePlanes {
  std::ptrdiff_t plane;
};

template <class Planes>
FUNCTION Population population(const Planes& planes, const float* cell, int x) {
  const float* f = cell + x;
  return {f[tile::rest * planes.plane], f[tile::e * planes.plane],  f[tile::n * planes.plane],
          f[tile::w * planes.plane],    f[tile::s * planes.plane],  f[tile::ne * planes.plane],
          f[tile::nw * planes.plane],   f[tile::sw * planes.plane], f[tile::se * planes.plane]};
}

template <int pitch>
FUNCTION void show_population(const Population& f, float* to) {
  to[shown_e * pitch] = f.e;
  to[shown_n * pitch] = f.n;
  to[shown_w * pitch] = f.w;
  to[shown_s * pitch] = f.s;
  to[shown_ne * pitch] = f.ne;
  to[shown_nw * pitch] = f.nw;
  to[shown_sw * pitch] = f.sw;
  to[shown_se * pitch] = f.se;
}

template <class Planes>
FUNCTION vec4 quad(const Planes& planes, const float* cell, std::size_t first, int x) {
  const float* c = cell + static_cast<std::ptrdiff_t>(first) * planes.plane + x;
  return {c[0], c[planes.plane], c[2 * planes.plane], c[3 * planes.plane]};
}

template <class Planes>
FUNCTION void put_quad(const Planes& planes, float* cell, std::size_t first, int x, const vec4& v) {
  float* c = cell + static_cast<std::ptrdiff_t>(first) * planes.plane + x;
  c[0] = v.x;
  c[planes.plane] = v.y;
  c[2 * planes.plane] = v.z;
  c[3 * planes.plane] = v.w;
}

template <bool ink, int pitch, class Planes>
FUNCTION void show_cell(const LatticeNumbers& k, const Planes& planes, const float* flowing,
                        const float* paper, int x, float* to) {
  const Population f = population(planes, flowing, x);
  show_population<pitch>(f, to);
  const float blocking = paper[tile::blocking * planes.plane + x];
  if constexpr (!ink) {
    to[shown_blocking * pitch] = blocking;
  } else {
    const Site site = site_of(k, total(f), quad(planes, flowing, tile::mass, x),
                              flowing[tile::fixed_ink * planes.plane + x], blocking,
                              paper[tile::grain * planes.plane + x], paper[tile::toe * planes.plane + x]);
    to[shown_blocking * pitch] = site.blocking;
    to[shown_water * pitch] = site.water;
    to[shown_per_water * pitch] = site.per_water;
    to[shown_concentration * pitch] = site.concentration.x;
    to[(shown_concentration + 1) * pitch] = site.concentration.y;
    to[(shown_concentration + 2) * pitch] = site.concentration.z;
    to[(shown_concentration + 3) * pitch] = site.concentration.w;
    to[shown_head * pitch] = site.head;
    to[shown_diagonal_head * pitch] = site.diagonal_head;
    to[shown_toes * pitch] = site.toes;
    to[shown_barrier * pitch] = site.barrier;
    to[shown_toe * pitch] = site.toe;
  }
}

template <bool ink, class Rows, class Planes>
void show_row(const LatticeNumbers& numbers, const Planes& planes, const Source& flowing, const Source& paper,
              float* to) {
  const LatticeNumbers k = numbers;
  show_cell<ink, Rows::pitch>(k, planes, flowing.left, paper.left, 0, to - 1);
  show_cell<ink, Rows::pitch>(k, planes, flowing.right, paper.right, 0, to + Rows::width);
#pragma GCC ivdep
  for (int x = 0; x < Rows::width; ++x)
    show_cell<ink, Rows::pitch>(k, planes, flowing.row, paper.row, x, to + x);
}

template <class Planes>
FUNCTION void put_population(const Planes& planes, float* cell, int x, const Population& f) {
  float* to = cell + x;
  to[tile::rest * planes.plane] = f.rest;
  to[tile::e * planes.plane] = f.e;
  to[tile::n * planes.plane] = f.n;
  to[tile::w * planes.plane] = f.w;
  to[tile::s * planes.plane] = f.s;
  to[tile::ne * planes.plane] = f.ne;
  to[tile::nw * planes.plane] = f.nw;
  to[tile::sw * planes.plane] = f.sw;
  to[tile::se * planes.plane] = f.se;
}

// One row of cells in memory: what is read, written, and both.
struct RowMemory {
  const float* flowing;
  float* next;
  float* still;
};

template <bool over_relaxed, class Rows, class Planes>
void step_ink_row(const LatticeNumbers& numbers, const Planes& planes, const Surroundings<Rows::pitch>& rows,
                  const RowMemory& memory, float* evaporated, float* wet) {
  const LatticeNumbers k = numbers;
#pragma GCC ivdep
  for (int x = 0; x < Rows::width; ++x) {
    const Population before = population(planes, memory.flowing, x);
    vec4 mass = quad(planes, memory.flowing, tile::mass, x);
    float surface = memory.still[tile::surface * planes.plane + x];
    vec4 surface_mass = quad(planes, memory.still, tile::surface_mass, x);
    vec4 fixed_mass = quad(planes, memory.still, tile::fixed_mass, x);
    Population after;
    float water;
    float gone;
    step_cell(k, over_relaxed, shown_site(rows, x, 0, 0), before CELL_ARGUMENTS, mass, surface, surface_mass,
              fixed_mass, after, water, gone);
    put_population(planes, memory.next, x, after);
    put_quad(planes, memory.next, tile::mass, x, mass);
    memory.next[tile::fixed_ink * planes.plane + x] =
        (fixed_mass.x + fixed_mass.y) + (fixed_mass.z + fixed_mass.w);
    memory.still[tile::surface * planes.plane + x] = surface;
    put_quad(planes, memory.still, tile::surface_mass, x, surface_mass);
    put_quad(planes, memory.still, tile::fixed_mass, x, fixed_mass);
    evaporated[x] = gone;
    wet[x] = water + surface;
  }
}

template <bool over_relaxed, class Rows, class Planes>
void step_water_row(const LatticeNumbers& numbers, const Planes& planes,
                    const Surroundings<Rows::pitch>& rows, const RowMemory& memory) {
  const LatticeNumbers k = numbers;
#pragma GCC ivdep
  for (int x = 0; x < Rows::width; ++x)
    put_population(planes, memory.next, x,
                   step_water(k, over_relaxed, population(planes, memory.flowing, x) CELL_ARGUMENTS));
}

template <int width>
bool any(const float* wet) {
  float most = 0;
  for (int x = 0; x < width; ++x) most = greatest(most, wet[x]);
  return most > 0;
}

// Sums of a block in an order that no vector width changes: each column upwards, then from left to right.
template <int width>
struct Tally {
  alignas(64) double evaporated[width] = {};
  alignas(64) float wet[width] = {};
  bool wet_below = false;
  bool wet_above = false;
  std::uint16_t corners = 0;

  void add(int y, const float* gone, const float* water) {
    for (int x = 0; x < width; ++x) evaporated[x] += static_cast<double>(gone[x]);
    for (int x = 0; x < width; ++x) wet[x] = greatest(wet[x], water[x]);
    if (y == 0) {
      wet_below = any<width>(water);
      corners |= static_cast<std::uint16_t>((water[0] > 0) << 0 | (water[width - 1] > 0) << 2);
    }
    if (y == tile::side - 1) {
      wet_above = any<width>(water);
      corners |= static_cast<std::uint16_t>((water[0] > 0) << 6 | (water[width - 1] > 0) << 8);
    }
  }

  void finish(TileOutcome& outcome) const {
    outcome.evaporated = 0;
    for (int x = 0; x < width; ++x) outcome.evaporated += evaporated[x];
    outcome.wet =
        static_cast<std::uint16_t>(corners | wet_below << 1 | (wet[0] > 0) << 3 | any<width>(wet) << 4 |
                                   (wet[width - 1] > 0) << 5 | wet_above << 7);
  }
};

constexpr int rows_ahead = 4;

// Asks for row y of the tile to the right, whose edge is needed here and which is most likely stepped next: a
// step jumps between too many places for the processor to foresee (docs/kernels.md has what that is worth).
template <bool ink>
FUNCTION void fetch_ahead(const PlaneView& right, std::size_t now, std::size_t next, int y) {
  constexpr std::size_t line = 64 / sizeof(float);
  constexpr std::size_t flowing =
      (ink ? std::size_t{tile::flowing_planes} : std::size_t{tile::mass}) * tile::side;
  constexpr std::size_t still = (tile::planes - tile::still_begin) * tile::side;
  const float* from = right.cells(now, y);
  const float* to = right.cells(next, y);
  const float* other = right.cells(tile::still_begin, y);
#pragma GCC unroll 64
  for (std::size_t i = 0; i < flowing; i += line) __builtin_prefetch(from + i, 0, 2);
#pragma GCC unroll 64
  for (std::size_t i = 0; i < flowing; i += line) __builtin_prefetch(to + i, 1, 2);
#pragma GCC unroll 64
  for (std::size_t i = 0; ink && i < still; i += line) __builtin_prefetch(other + i, 1, 2);
}

// Sweeps a block of rows from below. source(plane, y) finds row y of a plane, -1 to tile::side.
template <bool ink, class Rows, class Planes, class SourceOf, class Ahead>
FUNCTION void sweep(const LatticeNumbers& k, const Planes& planes, const SourceOf& source, const Ahead& ahead,
                    int parity, const PlaneView& block, TileOutcome& outcome) {
  const std::size_t now = static_cast<std::size_t>(parity) * tile::flowing_planes;
  const std::size_t next = tile::flowing_planes - now;
  Rows rows;
  Tally<Rows::width> tally;
  alignas(64) float evaporated[Rows::width];
  alignas(64) float wet[Rows::width];
  const auto show = [&](int y) {
    show_row<ink, Rows>(k, planes, source(now, y), source(tile::paper_begin, y), rows.shown_row(y));
  };
  const auto around = [&](int y) -> Surroundings<Rows::pitch> {
    return {{rows.shown_row(y - 1), rows.shown_row(y), rows.shown_row(y + 1)},
            {rows.linked_row(y - 1), rows.linked_row(y)}};
  };
  for (int y = 0; y < rows_ahead; ++y) ahead(y);
  show(-1);
  show(0);
  if constexpr (ink) link_row<Rows>(k, around(-1), rows.linked_row(-1));
  for (int y = 0; y < tile::side; ++y) {
    if (y + rows_ahead < tile::side) ahead(y + rows_ahead);
    show(y + 1);
    const RowMemory memory{block.cells(now, y), block.cells(next, y), block.cells(tile::still_begin, y)};
    if constexpr (ink) {
      link_row<Rows>(k, around(y), rows.linked_row(y));
      if (k.relaxation > 1)
        step_ink_row<true, Rows>(k, planes, around(y), memory, evaporated, wet);
      else
        step_ink_row<false, Rows>(k, planes, around(y), memory, evaporated, wet);
      tally.add(y, evaporated, wet);
    } else if (k.relaxation > 1) {
      step_water_row<true, Rows>(k, planes, around(y), memory);
    } else {
      step_water_row<false, Rows>(k, planes, around(y), memory);
    }
  }
  if constexpr (ink) tally.finish(outcome);
}

template <bool ink>
void step_tile(const LatticeNumbers& k, const std::array<float*, tile::neighbourhood>& blocks, int parity,
               TileOutcome& outcome) {
  const auto source = [&](std::size_t plane, int y) -> Source {
    const std::size_t band = y < 0 ? 0 : y >= tile::side ? 6 : 3;
    const auto row = [&](std::size_t i) {
      return arena_view(blocks[band + i]).cells(plane, (y + tile::side) % tile::side);
    };
    return {row(0) + tile::side - 1, row(1), row(2)};
  };
  const std::size_t now = static_cast<std::size_t>(parity) * tile::flowing_planes;
  const auto ahead = [&](int y) {
    fetch_ahead<ink>(arena_view(blocks[tile::own + 1]), now, tile::flowing_planes - now, y);
  };
  sweep<ink, Rows<tile::side>>(k, TilePlanes{}, source, ahead, parity, arena_view(blocks[tile::own]),
                               outcome);
}

template <bool ink>
void step_dense(const LatticeNumbers& k, const PlaneView& block, int parity, TileOutcome& outcome) {
  const auto source = [&](std::size_t plane, int y) -> Source {
    const float* row = block.cells(plane, y);
    return {row - 1, row, row + dense_width};
  };
  sweep<ink, Rows<dense_width>>(
      k, DensePlanes{block.plane}, source, [](int) {}, parity, block, outcome);
}

}  // namespace

extern const StepKernels FUDE_STEP_KERNELS;
const StepKernels FUDE_STEP_KERNELS{step_tile<true>, step_tile<false>, step_dense<true>, step_dense<false>};

}  // namespace fude
