// The ink step of one tile, compiled once for each instruction set; all give the same bits.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "sim/compute/instruction_set.h"
#include "sim/ink/lattice_numbers.h"
#include "sim/ink/tile_layout.h"

namespace fude {

// What one step made of a tile.
struct TileOutcome {
  double evaporated = 0;  // water, in saturated cells; summed in a fixed order
  // Bit i: a cell beside neighbour i (tile_layout.h) holds water in the flow layer; bit 4: the tile holds
  // water.
  std::uint16_t wet = 0;
};

// The dense lattice steps blocks of this width, tile::side rows high, in planes over the whole sheet, with as
// many cells as `dense_margin` on either side and a row below and above.
inline constexpr int dense_width = 128;
inline constexpr int dense_margin = 16;

using Neighbourhood = std::array<float*, tile::neighbourhood>;

struct StageKernels {
  // Steps the tile in the middle of nine blocks in place. Reads their edges of `parity`, writes its own of
  // the other. `next`: those of the tile most likely to be stepped after it.
  void (*tile)(const LatticeNumbers&, const Neighbourhood&, const Neighbourhood& next, int parity,
               TileOutcome&);
  // Makes the edges of `parity` of a tile whose cells have been changed.
  void (*edges)(const LatticeNumbers&, float* block, int parity);
  // Steps a block of the dense lattice: reads the flowing planes of `now`, writes those of `next`.
  void (*dense)(const LatticeNumbers&, const PlaneView& now, const PlaneView& next, TileOutcome&);
};

struct StepKernels {
  StageKernels full;   // all of the ink
  StageKernels water;  // stream, block and collide alone, without fronts, evaporation or pigment
};

// The kernels for a set that the processor has.
const StepKernels& step_kernels(InstructionSet set);

}  // namespace fude
