#include "sim/ink/sheet_state.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace fude {
namespace {

constexpr std::size_t mass_planes = 4;
constexpr std::size_t saved_planes = tile::paper_begin;  // the paper grows again

double sum(const PlaneView& view, std::size_t plane) {
  double total = 0;
  for (int y = 0; y < tile::side; ++y) {
    const float* row = view.cells(plane, y);
    for (int x = 0; x < tile::side; ++x) total += static_cast<double>(row[x]);
  }
  return total;
}

double sum(const FixedPigment& pigment, std::size_t plane) {
  double total = 0;
  for (std::size_t i = 0; i < tile::cells; ++i)
    total += static_cast<double>(pigment[plane * tile::cells + i]);
  return total;
}

// The part of a tile that a region covers, in the tile's own cells.
struct Cut {
  int left, right, bottom, top;
};

Cut cut(TilePlace place, const CellRect& rect) {
  const int x = place.column * tile::side;
  const int y = place.row * tile::side;
  return {std::max(rect.left - x, 0), std::min(rect.left + rect.columns - x, tile::side),
          std::max(rect.bottom - y, 0), std::min(rect.bottom + rect.rows - y, tile::side)};
}

std::size_t region_index(const InkRegion& region, TilePlace place, int x, int y) {
  return static_cast<std::size_t>(place.row * tile::side + y - region.rect.bottom) *
             static_cast<std::size_t>(region.rect.columns) +
         static_cast<std::size_t>(place.column * tile::side + x - region.rect.left);
}

bool any(const std::vector<float>& values) {
  return std::ranges::any_of(values, [](float v) { return v != 0; });
}

// Whether a saved tile holds anything besides fixed pigment.
bool wet(const InkSnapshot::Tile& tile) {
  const auto nonzero = [&](std::size_t first, std::size_t last) {
    return std::any_of(tile.planes.begin() + static_cast<std::ptrdiff_t>(first * tile::cells),
                       tile.planes.begin() + static_cast<std::ptrdiff_t>(last * tile::cells),
                       [](float v) { return v != 0; });
  };
  return nonzero(0, tile::fixed_ink) ||
         nonzero(tile::still_begin + tile::surface, tile::still_begin + tile::fixed_mass);
}

// Into planes that are there already.
void save(const AwakeTile& tile, InkSnapshot::Tile& saved) {
  saved.column = tile.place.column;
  saved.row = tile.place.row;
  float* to = saved.planes.data();
  for (std::size_t p = 0; p < saved_planes; ++p)
    for (int y = 0; y < tile::side; ++y, to += tile::side) std::copy_n(tile.view.cells(p, y), tile::side, to);
  saved.wet = wet(saved);
}

void load(const InkSnapshot::Tile& saved, AwakeTile& tile) {
  const float* from = saved.planes.data();
  const auto take = [&](std::size_t plane) {
    for (int y = 0; y < tile::side; ++y, from += tile::side)
      std::copy_n(from, tile::side, tile.view.cells(plane, y));
  };
  for (std::size_t p = 0; p < saved_planes; ++p) take(p);
  tile.changed = true;
  // Until the next step has looked, take every edge for wet.
  tile.wet = (1U << tile::neighbourhood) - 1;
}

}  // namespace

InkTotals sum_layers(const SheetView& sheet) {
  InkTotals totals;
  for (const AwakeTile& t : sheet.awake) {
    for (std::size_t f = tile::rest; f <= tile::se; ++f) totals.water_left += sum(t.view, f);
    totals.water_left += sum(t.view, tile::still_begin + tile::surface);
    for (std::size_t c = 0; c < mass_planes; ++c) {
      totals.pigment_flow[c] += sum(t.view, tile::mass + c);
      totals.pigment_surface[c] += sum(t.view, tile::still_begin + tile::surface_mass + c);
      totals.pigment_fixed[c] += sum(t.view, tile::still_begin + tile::fixed_mass + c);
    }
  }
  for (const auto& [place, pigment] : sheet.asleep)
    for (std::size_t c = 0; c < mass_planes; ++c) totals.pigment_fixed[c] += sum(pigment, c);
  return totals;
}

int cells_across(double mm, double cell_mm) {
  return std::max(1, static_cast<int>(std::ceil(mm / cell_mm - 1e-9)));
}

InkRegion blank_region(const CellRect& wanted, int columns, int rows) {
  InkRegion region;
  region.rect.left = std::clamp(wanted.left, 0, columns);
  region.rect.bottom = std::clamp(wanted.bottom, 0, rows);
  region.rect.columns =
      std::clamp(wanted.left + wanted.columns, region.rect.left, columns) - region.rect.left;
  region.rect.rows = std::clamp(wanted.bottom + wanted.rows, region.rect.bottom, rows) - region.rect.bottom;
  const std::size_t cells =
      static_cast<std::size_t>(region.rect.columns) * static_cast<std::size_t>(region.rect.rows);
  region.flow_water.resize(cells);
  region.surface_water.resize(cells);
  region.pigment.resize(cells);
  return region;
}

CellRect rect_around(std::span<const TilePlace> tiles, int columns, int rows) {
  if (tiles.empty()) return {};
  TilePlace low = tiles.front();
  TilePlace high = low;
  for (const TilePlace& place : tiles) {
    low = {std::min(low.row, place.row), std::min(low.column, place.column)};
    high = {std::max(high.row, place.row), std::max(high.column, place.column)};
  }
  CellRect rect{low.column * tile::side, low.row * tile::side, 0, 0};
  rect.columns = std::min((high.column + 1) * tile::side, columns) - rect.left;
  rect.rows = std::min((high.row + 1) * tile::side, rows) - rect.bottom;
  return rect;
}

void read_tile(const AwakeTile& t, float per_area, InkRegion& region) {
  const Cut c = cut(t.place, region.rect);
  for (int y = c.bottom; y < c.top && c.left < c.right; ++y) {
    const std::size_t first = region_index(region, t.place, c.left, y);
    const auto cells = [&](std::size_t plane) { return t.view.cells(plane, y) + c.left; };
    const auto count = static_cast<std::size_t>(c.right - c.left);
    std::copy_n(cells(tile::still_begin + tile::surface), count, region.surface_water.data() + first);
    float* water = region.flow_water.data() + first;
    for (std::size_t f = tile::rest; f <= tile::se; ++f)
      for (std::size_t x = 0; x < count; ++x) water[x] += cells(f)[x];
    for (std::size_t m = 0; m < mass_planes; ++m) {
      const float* flow = cells(tile::mass + m);
      const float* surface = cells(tile::still_begin + tile::surface_mass + m);
      const float* fixed = cells(tile::still_begin + tile::fixed_mass + m);
      for (std::size_t x = 0; x < count; ++x)
        region.pigment[first + x][m] = per_area * (flow[x] + surface[x] + fixed[x]);
    }
  }
}

void read_sleeping_tile(TilePlace place, const FixedPigment& pigment, float per_area, InkRegion& region) {
  const Cut c = cut(place, region.rect);
  for (int y = c.bottom; y < c.top; ++y)
    for (int x = c.left; x < c.right; ++x) {
      Concentrations& out = region.pigment[region_index(region, place, x, y)];
      for (std::size_t m = 0; m < mass_planes; ++m)
        out[m] = per_area * pigment[m * tile::cells + static_cast<std::size_t>(y * tile::side + x)];
    }
}

std::vector<InkSnapshot::Tile> save_tiles(const SheetView& sheet, ThreadPool& threads,
                                          std::vector<InkSnapshot::Tile> memory) {
  std::vector<InkSnapshot::Tile> tiles = std::move(memory);
  tiles.resize(sheet.awake.size());
  for (InkSnapshot::Tile& t : tiles) t.planes.resize(saved_planes * tile::cells);
  threads.for_each(tiles.size(), [&](std::size_t i) { save(sheet.awake[i], tiles[i]); });
  for (std::size_t i = 0; i < tiles.size(); ++i)
    if (!tiles[i].wet) tiles[i].planes = fixed_of(sheet.awake[i].view);
  std::erase_if(tiles, [](const InkSnapshot::Tile& t) { return !t.wet && !any(t.planes); });
  for (const auto& [place, pigment] : sheet.asleep)
    tiles.push_back({place.column, place.row, false, pigment});
  std::ranges::sort(tiles, [](const auto& a, const auto& b) {
    return TilePlace{a.row, a.column} < TilePlace{b.row, b.column};
  });
  return tiles;
}

void load_tiles(const std::vector<InkSnapshot::Tile>& tiles, Lattice& lattice) {
  lattice.clear();
  for (const InkSnapshot::Tile& saved : tiles) {
    const TilePlace place{saved.row, saved.column};
    if (saved.wet)
      load(saved, lattice.wake(place));
    else
      lattice.lay(place, saved.planes);
  }
}

void dry(InkSnapshot::Tile& tile) {
  if (!tile.wet) return;
  const auto flow = [&](std::size_t p) { return tile.planes.data() + p * tile::cells; };
  const auto still = [&](std::size_t p) { return flow(tile::flowing_planes + p); };
  FixedPigment fixed(mass_planes * tile::cells);
  for (std::size_t c = 0; c < mass_planes; ++c)
    for (std::size_t i = 0; i < tile::cells; ++i)
      fixed[c * tile::cells + i] =
          still(tile::fixed_mass + c)[i] + (flow(tile::mass + c)[i] + still(tile::surface_mass + c)[i]);
  tile.planes = std::move(fixed);
  tile.wet = false;
}

std::uint64_t hash_tiles(const std::vector<InkSnapshot::Tile>& tiles) {
  std::uint64_t h = 0xcbf29ce484222325ULL;
  const auto add = [&](std::uint64_t word) {
    h = (h ^ word) * 0x9e3779b97f4a7c15ULL;
    h ^= h >> 29;
  };
  for (const InkSnapshot::Tile& t : tiles) {
    add(static_cast<std::uint64_t>(t.row) << 32 | static_cast<std::uint32_t>(t.column));
    // Adding nought makes -0 and 0 the same word.
    for (float v : t.planes) add(std::bit_cast<std::uint32_t>(v + 0.0F));
  }
  return h;
}

}  // namespace fude
