// The lattice on a graphics card: tiles that wake and sleep with the water, as on the processor, but told of
// it some steps late, so that no step waits for the card. For the thread whose context is current.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "sim/compute/gl_buffer.h"
#include "sim/ink/gl_programs.h"
#include "sim/ink/gl_tile_texels.h"
#include "sim/ink/ink.h"
#include "sim/ink/lattice.h"

namespace fude {

// Awake tiles copied to the processor: views without paper.
struct TileCopies {
  std::vector<float> memory;
  std::vector<AwakeTile> tiles;  // in ascending order of place
};

class GlTiles {
 public:
  // columns × rows: cells of the sheet. Errors: unsupported, when the card has no room.
  static Result<GlTiles> make(const LatticeNumbers& numbers, const PaperTexture& texture, int columns,
                              int rows);

  // The slot of a tile of the sheet that water is about to be poured on; wakes it and those around it.
  // Throws std::runtime_error when the card has no room left.
  int pour(TilePlace place);

  void step(const GlInkPrograms& programs);

  // Binds what the deposit program reads and writes of the tiles.
  void bind_for_deposit() const;

  // Of the awake tiles, ascending.
  std::vector<TilePlace> places() const;
  // Water evaporated since the beginning, in saturated cells. Waits for the card.
  double evaporated() const;
  // No water on any tile. Waits for the card.
  bool still() const;

  // The awake tiles that touch a rectangle of cells. Waits for the card.
  TileCopies copies(const CellRect& rect) const;
  const std::map<TilePlace, FixedPigment>& asleep();

  // Back to a dry white sheet; then tiles of a snapshot, one by one.
  void clear();
  void load(const InkSnapshot::Tile& saved);

 private:
  struct Awake {
    int slot = 0;
    std::uint16_t wet = 0;    // as TileOutcome::wet, with a margin of wet_margin cells
    std::uint64_t since = 0;  // the step after which reports tell of it truly
  };
  struct Report {
    std::uint64_t step;
    GlReadBack columns;
  };

  GlTiles(const LatticeNumbers& numbers, const PaperTexture& texture, int columns, int rows);

  bool on_sheet(TilePlace place) const;
  Awake& wake(TilePlace place);
  int free_slot();
  Result<void> grow(std::size_t slots);
  void fall_asleep(TilePlace place, int slot);
  void collect_sleepers();
  void hear(const Report& report);
  void wake_where_water_comes();
  void sleep_where_none_can_come();
  void write_neighbours();
  std::uint16_t wet_bits(std::span<const std::byte> columns, int slot) const;
  void put(int slot, const TileTexels& texels);
  void put_fixed(int slot, TilePlace place, const FixedPigment& pigment);

  LatticeNumbers numbers_;
  PaperTexture texture_;
  int columns_;
  int rows_;
  std::map<TilePlace, Awake> awake_;
  std::map<TilePlace, FixedPigment> asleep_;
  std::map<TilePlace, GlReadBack> sleepers_;  // asleep, their pigment still on its way here
  std::vector<int> free_;
  std::size_t slots_ = 0;
  GlBuffer number_block_;
  std::array<GlTexels, 2> moving_;  // of either parity
  std::array<GlTexels, 2> shown_;
  GlTexels surface_;
  GlTexels pigment_;
  GlTexels paper_;
  GlBuffer column_sums_;
  GlTexels neighbours_;
  bool neighbours_written_ = false;
  int parity_ = 0;
  std::uint64_t steps_ = 0;
  std::optional<Report> report_;
};

}  // namespace fude
