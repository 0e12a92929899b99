// Rows of cells as the step keeps them in the first-level cache: what each cell shows its neighbours, derived
// once, and the links between two rows. Whatever has an `x` does as many cells from x on as there are lanes.
// Part of tile_step.cpp alone, after the kernels: see there.
#pragma once

namespace fude {
namespace {

using tile::Shown;

// Beside what neighbours see, a row holds what its own cells need again.
enum ShownHere : int { shown_water = tile::shown_fields, shown_per_water, row_fields };

// The links of a row of cells to the east and upwards, six floats each.
enum Linked : int { linked_water, linked_mass, linked_edge = linked_mass + 4 };
constexpr int linked_fields = 6;
enum Side : int { side_e, side_n, side_ne, side_nw };
constexpr int sides = 4;

// Columns before the first, so that it lies on a cache line.
constexpr int margin = 16;

// Fields of a row of `width` cells one after the other, `pitch` apart; cells -1 and `width` are there too,
// and `reach` more on either side may be written.
template <int fields, int row_width, int row_reach>
struct Line {
  static constexpr int width = row_width;
  static constexpr int reach = row_reach;
  static constexpr int pitch = width + margin + reach;
  alignas(64) float floats[2 * margin + reach + fields * pitch];
  float* begin() { return floats + margin + reach; }
};

// Three rows while a block is swept from below, and the links of two.
template <int row_width, int row_reach>
struct Rows {
  using ShownLine = Line<row_fields, row_width, row_reach>;
  using LinkedLine = Line<sides * linked_fields, row_width, row_reach>;
  static constexpr int width = row_width;
  static constexpr int reach = row_reach;
  static constexpr int pitch = ShownLine::pitch;
  ShownLine shown_lines[3];
  LinkedLine linked_lines[2];

  float* shown(int y) { return shown_lines[(y + 3) % 3].begin(); }
  float* linked(int y) { return linked_lines[(y + 2) % 2].begin(); }
};

constexpr int link_at(Side side, int pitch) { return static_cast<int>(side) * linked_fields * pitch; }

template <int pitch>
FUNCTION vec4 quad(const float* from, int first) {
  const float* c = from + first * pitch;
  return {loaded(c), loaded(c + pitch), loaded(c + 2 * pitch), loaded(c + 3 * pitch)};
}

template <int pitch>
FUNCTION void put_quad(float* to, int first, const vec4& v) {
  float* c = to + first * pitch;
  stored(c, v.x);
  stored(c + pitch, v.y);
  stored(c + 2 * pitch, v.z);
  stored(c + 3 * pitch, v.w);
}

template <int pitch>
FUNCTION void put_link(float* line, Side side, int x, const Crossing& crossing) {
  float* c = line + link_at(side, pitch) + x;
  stored(c + linked_water * pitch, crossing.water);
  put_quad<pitch>(c, linked_mass, crossing.mass);
  stored(c + linked_edge * pitch, crossing.edge);
}

template <int pitch>
FUNCTION Crossing link_of(const float* line, Side side, int x) {
  const float* c = line + link_at(side, pitch) + x;
  return {loaded(c + linked_water * pitch), quad<pitch>(c, linked_mass), loaded(c + linked_edge * pitch)};
}

// Of a line; water and 1/water are a cell's own affair and nought here.
template <int pitch>
FUNCTION Site shown_site(const float* line, int x) {
  const float* s = line + x;
  return {0.0f,
          0.0f,
          quad<pitch>(s, tile::shown_concentration),
          loaded(s + tile::shown_blocking * pitch),
          loaded(s + tile::shown_head * pitch),
          loaded(s + tile::shown_diagonal_head * pitch),
          loaded(s + tile::shown_toes * pitch),
          loaded(s + tile::shown_barrier * pitch),
          loaded(s + tile::shown_toe * pitch)};
}

// A link from `here` to the cell at x of a line: which population leaves by it, and which the other end
// sends.
template <int pitch>
FUNCTION Crossing straight(const LatticeNumbers& k, const Site& here, const real& leaving, const float* line,
                           int x, Shown back) {
  const Site there = shown_site<pitch>(line, x);
  return crossing(k, here, there, here.head, there.head, k.pace_straight, leaving,
                  loaded(line + back * pitch + x));
}

template <int pitch>
FUNCTION Crossing diagonal(const LatticeNumbers& k, const Site& here, const real& leaving, const float* line,
                           int x, Shown back) {
  const Site there = shown_site<pitch>(line, x);
  return crossing(k, here, there, here.diagonal_head, there.diagonal_head, k.pace_diagonal, leaving,
                  loaded(line + back * pitch + x));
}

// The links of row `here` to the east and to the row above.
template <class Rows>
void link_row(const LatticeNumbers& k, const float* here, const float* above, float* to) {
  constexpr int pitch = Rows::pitch;
  for (int x = -Rows::reach; x < Rows::width + Rows::reach; x += lanes) {
    const Site site = shown_site<pitch>(here, x);
    const float* from = here + x;
    put_link<pitch>(
        to, side_e, x,
        straight<pitch>(k, site, loaded(from + tile::shown_e * pitch), here, x + 1, tile::shown_w));
    put_link<pitch>(to, side_n, x,
                    straight<pitch>(k, site, loaded(from + tile::shown_n * pitch), above, x, tile::shown_s));
    put_link<pitch>(
        to, side_ne, x,
        diagonal<pitch>(k, site, loaded(from + tile::shown_ne * pitch), above, x + 1, tile::shown_sw));
    put_link<pitch>(
        to, side_nw, x,
        diagonal<pitch>(k, site, loaded(from + tile::shown_nw * pitch), above, x - 1, tile::shown_se));
  }
}

// The links between two columns side by side, as lines from south to north, of which entry y is that of the
// cell in row y, from -1 on: e and ne of the left one, nw of the right one.
template <class Column>
void link_columns(const LatticeNumbers& k, const float* left, const float* right, float* to) {
  constexpr int pitch = Column::pitch;
  for (int y = -lanes; y < Column::width; y += lanes) {
    const Site west = shown_site<pitch>(left, y);
    put_link<pitch>(
        to, side_e, y,
        straight<pitch>(k, west, loaded(left + tile::shown_e * pitch + y), right, y, tile::shown_w));
    put_link<pitch>(
        to, side_ne, y,
        diagonal<pitch>(k, west, loaded(left + tile::shown_ne * pitch + y), right, y + 1, tile::shown_sw));
    const Site east = shown_site<pitch>(right, y);
    put_link<pitch>(
        to, side_nw, y,
        diagonal<pitch>(k, east, loaded(right + tile::shown_nw * pitch + y), left, y + 1, tile::shown_se));
  }
}

// Planes one after the other in a tile's row, or each over the whole sheet.
struct TilePlanes {
  static constexpr std::ptrdiff_t plane = tile::plane_stride;
};
struct DensePlanes {
  std::ptrdiff_t plane;
};

// One row of cells in memory: what is read, written, and both.
struct RowMemory {
  const float* flowing;
  float* next;
  float* still;
  const float* paper;
};

template <class Planes>
FUNCTION Population population(const Planes& planes, const float* cell) {
  const auto f = [&](tile::Flowing i) { return loaded(cell + i * planes.plane); };
  return {f(tile::rest), f(tile::e),  f(tile::n),  f(tile::w), f(tile::s),
          f(tile::ne),   f(tile::nw), f(tile::sw), f(tile::se)};
}

template <class Planes>
FUNCTION void put_population(const Planes& planes, float* cell, const Population& f) {
  const auto put = [&](tile::Flowing i, const real& value) { stored(cell + i * planes.plane, value); };
  put(tile::rest, f.rest);
  put(tile::e, f.e);
  put(tile::n, f.n);
  put(tile::w, f.w);
  put(tile::s, f.s);
  put(tile::ne, f.ne);
  put(tile::nw, f.nw);
  put(tile::sw, f.sw);
  put(tile::se, f.se);
}

template <class Planes>
FUNCTION vec4 masses(const Planes& planes, const float* cell, std::ptrdiff_t first) {
  const float* c = cell + first * planes.plane;
  return {loaded(c), loaded(c + planes.plane), loaded(c + 2 * planes.plane), loaded(c + 3 * planes.plane)};
}

template <class Planes>
FUNCTION void put_masses(const Planes& planes, float* cell, std::ptrdiff_t first, const vec4& v) {
  float* c = cell + first * planes.plane;
  stored(c, v.x);
  stored(c + planes.plane, v.y);
  stored(c + 2 * planes.plane, v.z);
  stored(c + 3 * planes.plane, v.w);
}

// Where a line keeps its fields: a row all of them, also what only its own cells need.
template <int line_pitch>
struct RowFields {
  static constexpr int at(int field) { return field * line_pitch; }
};

// An edge keeps some; -1 for the others.
template <tile::Edge edge>
struct EdgeFields {
  static constexpr int at(int field) {
    if (field >= tile::shown_fields) return -1;
    if (field >= tile::shown_blocking)
      return (tile::edge_populations + field - tile::shown_blocking) * tile::side;
    for (int i = 0; i < tile::edge_populations; ++i)
      if (tile::leaving[edge][i] == field) return i * tile::side;
    return -1;
  }
};

// What cells show, from -reach on.
template <bool ink, class Fields, int reach, int width, class Planes>
void show_row(const LatticeNumbers& k, const Planes& planes, const float* flowing, const float* paper,
              float* line) {
  for (int x = -reach; x < width + reach; x += lanes) {
    const auto show = [&]<int field>(std::integral_constant<int, field>, const real& value) {
      if constexpr (Fields::at(field) >= 0) stored(line + Fields::at(field) + x, value);
    };
    const auto grown = [&](tile::Paper i) { return loaded(paper + i * planes.plane + x); };
    const Population f = population(planes, flowing + x);
#define SHOW(field, value) show(std::integral_constant<int, field>{}, value)
    SHOW(tile::shown_e, f.e);
    SHOW(tile::shown_n, f.n);
    SHOW(tile::shown_w, f.w);
    SHOW(tile::shown_s, f.s);
    SHOW(tile::shown_ne, f.ne);
    SHOW(tile::shown_nw, f.nw);
    SHOW(tile::shown_sw, f.sw);
    SHOW(tile::shown_se, f.se);
    if constexpr (!ink) {
      SHOW(tile::shown_blocking, grown(tile::blocking));
    } else {
      const Site site = site_of(k, total(f), masses(planes, flowing + x, tile::mass),
                                loaded(flowing + tile::fixed_ink * planes.plane + x), grown(tile::blocking),
                                grown(tile::grain), grown(tile::toe));
      SHOW(tile::shown_blocking, site.blocking);
      SHOW(tile::shown_concentration, site.concentration.x);
      SHOW(tile::shown_concentration + 1, site.concentration.y);
      SHOW(tile::shown_concentration + 2, site.concentration.z);
      SHOW(tile::shown_concentration + 3, site.concentration.w);
      SHOW(tile::shown_head, site.head);
      SHOW(tile::shown_diagonal_head, site.diagonal_head);
      SHOW(tile::shown_toes, site.toes);
      SHOW(tile::shown_barrier, site.barrier);
      SHOW(tile::shown_toe, site.toe);
      SHOW(shown_water, site.water);
      SHOW(shown_per_water, site.per_water);
    }
#undef SHOW
  }
}

}  // namespace
}  // namespace fude
