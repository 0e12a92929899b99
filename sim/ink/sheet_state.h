// Reading and writing whole tiles: totals, regions, hashes, snapshots.
#pragma once

#include "sim/ink/ink.h"
#include "sim/ink/lattice.h"

namespace fude {

// Sums over every tile in order of place, in saturated cells; only the water left and the pigment layers.
InkTotals sum_layers(Lattice& lattice);

// Adds what one tile holds of the rectangle to a region; `per_area` turns masses into µl/mm².
void read_tile(const AwakeTile& tile, int parity, float per_area, InkRegion& region);
void read_sleeping_tile(TilePlace place, const FixedPigment& pigment, float per_area, InkRegion& region);

std::vector<InkSnapshot::Tile> save_tiles(Lattice& lattice);
void load_tiles(const std::vector<InkSnapshot::Tile>& tiles, Lattice& lattice);

std::uint64_t hash_tiles(const std::vector<InkSnapshot::Tile>& tiles);

}  // namespace fude
