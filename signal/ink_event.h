// What the ink takes and what it answers: the seam between everything that wets the paper and the
// paper itself. Maps are in millimetres with a cell size of their own, finer than the lattice.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <variant>
#include <vector>

#include "signal/timestamp.h"

namespace fude {

// Concentrations travel in groups of four; glue is one of them and moves as pigment does (Chu 3.8).
inline constexpr std::size_t concentrations_per_group = 4;
inline constexpr std::size_t glue_channel = 3;
using Concentrations = std::array<float, concentrations_per_group>;

// What one patch of the tuft offers while this event lasts.
struct InkLoad {
  float wetness = 0;          // 0 dry to 1 full: how much of the film it can leave
  Concentrations strength{};  // µl of full-strength pigment in one µl of what flows out, and glue likewise
};

// A raster over the paper frame. Cell (column, row) covers x in left + column·cell …, y in
// bottom + row·cell …; row-major, rows in the direction of +y.
struct FootprintMap {
  double left_mm = 0;
  double bottom_mm = 0;
  double cell_mm = 0;
  int columns = 0;
  int rows = 0;
  std::vector<float> fresh;          // 0..1: share of the cell newly covered during this event
  std::vector<float> contact_s;      // seconds of contact during this event, times the share covered
  std::vector<std::uint16_t> patch;  // index into Deposit::patches
};

// A touch of the brush: a film on what is newly covered and an exchange over the time of contact
// (Chu 2.7, 3.6). What the paper refuses stays on the brush: Exchange says how much.
struct Deposit {
  FootprintMap map;
  std::vector<InkLoad> patches;
};

// Dry the whole sheet at once: all water gone (counted as evaporated), all pigment fixed.
struct DryPaper {};

struct InkEvent {
  Duration at{};         // session time
  std::uint64_t id = 0;  // ascending
  std::variant<Deposit, DryPaper> what;
};

// What the paper took from a patch, net of what the patch got back from it (may be negative).
struct PatchExchange {
  double water_ul = 0;
  std::array<double, concentrations_per_group> pigment_ul{};  // of full-strength ink, and glue
};

struct Exchange {
  std::uint64_t event = 0;  // InkEvent::id
  std::vector<PatchExchange> patches;
};

}  // namespace fude
