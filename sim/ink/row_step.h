// The step of one row of cells between rows that show theirs, and the sums of a block. Part of tile_step.cpp
// alone, after shown_rows.h.
#pragma once

namespace fude {
namespace {

// The rows below, at and above a cell, and the links of those below and at it.
template <int row_pitch>
struct Surroundings {
  static constexpr int pitch = row_pitch;
  const float* shown[3];
  const float* linked[2];
};

#define CELL_PARAMETERS , const auto &rows, int x
#define CELL_ARGUMENTS , rows, x
#define CROSSING(side, dx, dy) \
  link_of<std::decay_t<decltype(rows)>::pitch>(rows.linked[1 + dy], side_##side, x + dx)
#define ARRIVING(member, dx, dy) \
  loaded(rows.shown[1 + dy] + tile::shown_##member * std::decay_t<decltype(rows)>::pitch + x + dx)
#define BLOCKING(dx, dy) ARRIVING(blocking, dx, dy)
#include "sim/ink/kernels/step.k"
#include "sim/ink/kernels/water.k"

template <bool over_relaxed, int width, class Planes, class Around>
void step_ink_row(const LatticeNumbers& k, const Planes& planes, const Around& rows, const RowMemory& memory,
                  float* evaporated, float* wet) {
  constexpr int pitch = Around::pitch;
  for (int x = 0; x < width; x += lanes) {
    const Population before = population(planes, memory.flowing + x);
    vec4 mass = masses(planes, memory.flowing + x, tile::mass);
    real surface = loaded(memory.still + tile::surface * planes.plane + x);
    vec4 surface_mass = masses(planes, memory.still + x, tile::surface_mass);
    vec4 fixed_mass = masses(planes, memory.still + x, tile::fixed_mass);
    Site here = shown_site<pitch>(rows.shown[1], x);
    here.water = loaded(rows.shown[1] + shown_water * pitch + x);
    here.per_water = loaded(rows.shown[1] + shown_per_water * pitch + x);
    Population after;
    real water;
    real gone;
    step_cell(k, over_relaxed, here, before CELL_ARGUMENTS, mass, surface, surface_mass, fixed_mass, after,
              water, gone);
    put_population(planes, memory.next + x, after);
    put_masses(planes, memory.next + x, tile::mass, mass);
    stored(memory.next + tile::fixed_ink * planes.plane + x,
           (fixed_mass.x + fixed_mass.y) + (fixed_mass.z + fixed_mass.w));
    stored(memory.still + tile::surface * planes.plane + x, surface);
    put_masses(planes, memory.still + x, tile::surface_mass, surface_mass);
    put_masses(planes, memory.still + x, tile::fixed_mass, fixed_mass);
    stored(evaporated + x, gone);
    stored(wet + x, water + surface);
  }
}

template <bool over_relaxed, int width, class Planes, class Around>
void step_water_row(const LatticeNumbers& k, const Planes& planes, const Around& rows,
                    const RowMemory& memory) {
  for (int x = 0; x < width; x += lanes)
    put_population(planes, memory.next + x,
                   step_water(k, over_relaxed, population(planes, memory.flowing + x) CELL_ARGUMENTS));
}

template <int width>
bool any(const float* wet) {
  float most = 0;
  for (int x = 0; x < width; ++x) most = wet[x] > most ? wet[x] : most;
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
    for (int x = 0; x < width; ++x) wet[x] = water[x] > wet[x] ? water[x] : wet[x];
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

// Steps row y of a block and counts it.
template <bool ink, int width, class Planes, class Around>
FUNCTION void step_row(const LatticeNumbers& k, const Planes& planes, const Around& rows,
                       const RowMemory& memory, int y, Tally<width>& tally) {
  if constexpr (ink) {
    alignas(64) float evaporated[width];
    alignas(64) float wet[width];
    if (k.relaxation > 1)
      step_ink_row<true, width>(k, planes, rows, memory, evaporated, wet);
    else
      step_ink_row<false, width>(k, planes, rows, memory, evaporated, wet);
    tally.add(y, evaporated, wet);
  } else if (k.relaxation > 1) {
    step_water_row<true, width>(k, planes, rows, memory);
  } else {
    step_water_row<false, width>(k, planes, rows, memory);
  }
}

}  // namespace
}  // namespace fude
