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

// What the cells of a row show their neighbours. Three rows are kept while a block is swept from below;
// they stay in the first-level cache, and what a site derives from its state is derived once.
enum Shown : int {
  shown_e,
  shown_n,
  shown_w,
  shown_s,
  shown_ne,
  shown_nw,
  shown_sw,
  shown_se,
  shown_populations,
  shown_blocking = shown_populations,
  shown_grain,
  shown_toe,
  shown_water,
  shown_per_water,
  shown_concentration,
  shown_hold = shown_concentration + 4,
  shown_toes,
  shown_fields
};

template <int block_width>
struct Rows {
  static constexpr int width = block_width;
  static constexpr int margin = 16;  // column 0 on a cache line, and one cell beyond either end
  static constexpr int pitch = width + 2 * margin;
  alignas(64) float cell[3][shown_fields * pitch];

  float* row(int y) { return cell[(y + 3) % 3] + margin; }
};

// The rows below, at and above a cell.
template <int row_pitch>
struct Surroundings {
  static constexpr int pitch = row_pitch;
  const float* row[3];
};

template <class Around>
FUNCTION float shown(const Around& rows, int field, int x, int dx, int dy) {
  return rows.row[1 + dy][field * Around::pitch + x + dx];
}

template <class Around>
FUNCTION Site shown_site(const Around& rows, int x, int dx, int dy) {
  return {shown(rows, shown_water, x, dx, dy),
          shown(rows, shown_per_water, x, dx, dy),
          {shown(rows, shown_concentration, x, dx, dy), shown(rows, shown_concentration + 1, x, dx, dy),
           shown(rows, shown_concentration + 2, x, dx, dy), shown(rows, shown_concentration + 3, x, dx, dy)},
          shown(rows, shown_blocking, x, dx, dy),
          shown(rows, shown_hold, x, dx, dy),
          shown(rows, shown_toes, x, dx, dy)};
}

#define CELL_PARAMETERS , const auto &rows, int x
#define SITE(dx, dy) shown_site(rows, x, dx, dy)
#define RELIEF(dx, dy) \
  Relief { shown(rows, shown_grain, x, dx, dy), shown(rows, shown_toe, x, dx, dy) }
#define ARRIVING(member, dx, dy) shown(rows, shown_##member, x, dx, dy)
#define BLOCKING(dx, dy) shown(rows, shown_blocking, x, dx, dy)
#define CELL_ARGUMENTS , rows, x
#include "sim/ink/kernels/step.k"
#include "sim/ink/kernels/water.k"

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
                              flowing[tile::fixed_ink * planes.plane + x], blocking);
    to[shown_blocking * pitch] = site.blocking;
    to[shown_grain * pitch] = paper[tile::grain * planes.plane + x];
    to[shown_toe * pitch] = paper[tile::toe * planes.plane + x];
    to[shown_water * pitch] = site.water;
    to[shown_per_water * pitch] = site.per_water;
    to[shown_concentration * pitch] = site.concentration.x;
    to[(shown_concentration + 1) * pitch] = site.concentration.y;
    to[(shown_concentration + 2) * pitch] = site.concentration.z;
    to[(shown_concentration + 3) * pitch] = site.concentration.w;
    to[shown_hold * pitch] = site.hold;
    to[shown_toes * pitch] = site.toes;
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

template <class Rows, class Planes>
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
    step_cell(k, before CELL_ARGUMENTS, mass, surface, surface_mass, fixed_mass, after, water, gone);
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

template <class Rows, class Planes>
void step_water_row(const LatticeNumbers& numbers, const Planes& planes,
                    const Surroundings<Rows::pitch>& rows, const RowMemory& memory) {
  const LatticeNumbers k = numbers;
#pragma GCC ivdep
  for (int x = 0; x < Rows::width; ++x)
    put_population(planes, memory.next, x,
                   step_water(k, population(planes, memory.flowing, x) CELL_ARGUMENTS));
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

// Sweeps a block of rows from below. source(plane, y) finds row y of a plane, -1 to tile::side.
template <bool ink, class Rows, class Planes, class SourceOf>
FUNCTION void sweep(const LatticeNumbers& k, const Planes& planes, const SourceOf& source, int parity,
                    float* block, std::ptrdiff_t row, TileOutcome& outcome) {
  const std::size_t now = static_cast<std::size_t>(parity) * tile::flowing_planes;
  const std::size_t next = tile::flowing_planes - now;
  Rows rows;
  Tally<Rows::width> tally;
  alignas(64) float evaporated[Rows::width];
  alignas(64) float wet[Rows::width];
  const auto show = [&](int y) {
    show_row<ink, Rows>(k, planes, source(now, y), source(tile::paper_begin, y), rows.row(y));
  };
  show(-1);
  show(0);
  for (int y = 0; y < tile::side; ++y) {
    show(y + 1);
    const Surroundings<Rows::pitch> around{{rows.row(y - 1), rows.row(y), rows.row(y + 1)}};
    const auto at = [&](std::size_t plane) {
      return block + static_cast<std::ptrdiff_t>(plane) * planes.plane + y * row;
    };
    const RowMemory memory{at(now), at(next), at(tile::still_begin)};
    if constexpr (ink) {
      step_ink_row<Rows>(k, planes, around, memory, evaporated, wet);
      tally.add(y, evaporated, wet);
    } else {
      step_water_row<Rows>(k, planes, around, memory);
    }
  }
  if constexpr (ink) tally.finish(outcome);
}

template <bool ink>
void step_tile(const LatticeNumbers& k, const std::array<float*, tile::neighbourhood>& blocks, int parity,
               TileOutcome& outcome) {
  const auto source = [&](std::size_t plane, int y) -> Source {
    const std::size_t band = y < 0 ? 0 : y >= tile::side ? 6 : 3;
    const std::size_t offset =
        plane * tile::plane_stride + static_cast<std::size_t>((y + tile::side) % tile::side) * tile::side;
    return {blocks[band] + offset + tile::side - 1, blocks[band + 1] + offset, blocks[band + 2] + offset};
  };
  sweep<ink, Rows<tile::side>>(k, TilePlanes{}, source, parity, blocks[tile::own], tile::side, outcome);
}

template <bool ink>
void step_dense(const LatticeNumbers& k, const PlaneView& block, int parity, TileOutcome& outcome) {
  const auto source = [&](std::size_t plane, int y) -> Source {
    const float* row = block.origin + static_cast<std::ptrdiff_t>(plane) * block.plane + y * block.row;
    return {row - 1, row, row + dense_width};
  };
  sweep<ink, Rows<dense_width>>(k, DensePlanes{block.plane}, source, parity, block.origin, block.row,
                                outcome);
}

}  // namespace

extern const StepKernels FUDE_STEP_KERNELS;
const StepKernels FUDE_STEP_KERNELS{step_tile<true>, step_tile<false>, step_dense<true>, step_dense<false>};

}  // namespace fude
