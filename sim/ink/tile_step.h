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

// The dense lattice steps blocks of this width, tile::side rows high, in planes over the whole sheet.
inline constexpr int dense_width = 128;

struct StepKernels {
  // All of the ink: blocks of the nine tiles of the neighbourhood, the parity to read.
  void (*tile)(const LatticeNumbers&, const std::array<float*, tile::neighbourhood>&, int parity,
               TileOutcome&);
  // Stream, block and collide alone, without fronts, evaporation or pigment.
  void (*tile_water)(const LatticeNumbers&, const std::array<float*, tile::neighbourhood>&, int parity,
                     TileOutcome&);
  void (*dense)(const LatticeNumbers&, const PlaneView&, int parity, TileOutcome&);
  void (*dense_water)(const LatticeNumbers&, const PlaneView&, int parity, TileOutcome&);
};

// The kernels for a set that the processor has.
const StepKernels& step_kernels(InstructionSet set);

}  // namespace fude
