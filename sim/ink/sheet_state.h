// Reading and writing whole tiles: totals, regions, hashes, snapshots.
#pragma once

#include <map>
#include <span>

#include "sim/ink/ink.h"
#include "sim/ink/lattice.h"

namespace fude {

// A sheet between two steps, wherever its lattice keeps it. Awake tiles in ascending order of place.
struct SheetView {
  std::span<const AwakeTile> awake;
  const std::map<TilePlace, FixedPigment>& asleep;
};

inline SheetView view_of(Lattice& lattice) { return {lattice.awake(), lattice.asleep()}; }

// Sums over every tile in order of place, in saturated cells; only the water left and the pigment layers.
InkTotals sum_layers(const SheetView& sheet);

// The cells that cover a length.
int cells_across(double mm, double cell_mm);

// A region of dry white paper: the rectangle, cut to a sheet of columns × rows cells.
InkRegion blank_region(const CellRect& wanted, int columns, int rows);

// The smallest rectangle around tiles, cut to the sheet; no columns where there are none.
CellRect rect_around(std::span<const TilePlace> tiles, int columns, int rows);

// Adds what one tile holds of the rectangle to a region; `per_area` turns masses into µl/mm².
void read_tile(const AwakeTile& tile, float per_area, InkRegion& region);
void read_sleeping_tile(TilePlace place, const FixedPigment& pigment, float per_area, InkRegion& region);

// `memory`: tiles that are not needed any more; what they hold is written over.
std::vector<InkSnapshot::Tile> save_tiles(const SheetView& sheet, ThreadPool& threads,
                                          std::vector<InkSnapshot::Tile> memory = {});
void load_tiles(const std::vector<InkSnapshot::Tile>& tiles, Lattice& lattice);

// Fixes all pigment of a saved tile; its water is gone.
void dry(InkSnapshot::Tile& tile);

std::uint64_t hash_tiles(const std::vector<InkSnapshot::Tile>& tiles);

}  // namespace fude
