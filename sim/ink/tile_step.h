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

// The dense lattice: the same planes, each over the whole sheet with a margin of closed cells.
struct DenseBlock {
  float* origin;         // of the block's first cell in the first plane
  std::ptrdiff_t row;    // floats from one row of cells to the next
  std::ptrdiff_t plane;  // floats from one plane to the next
};
inline constexpr int dense_width = 128;  // cells of a block; it is tile::side rows high

struct StepKernels {
  // All of the ink: blocks of the nine tiles of the neighbourhood, the parity to read.
  void (*tile)(const LatticeNumbers&, const std::array<float*, tile::neighbourhood>&, int parity,
               TileOutcome&);
  // Stream, block and collide alone, without fronts, evaporation or pigment.
  void (*tile_water)(const LatticeNumbers&, const std::array<float*, tile::neighbourhood>&, int parity,
                     TileOutcome&);
  void (*dense)(const LatticeNumbers&, const DenseBlock&, int parity, TileOutcome&);
  void (*dense_water)(const LatticeNumbers&, const DenseBlock&, int parity, TileOutcome&);
};

// The kernels for a set that the processor has.
const StepKernels& step_kernels(InstructionSet set);

}  // namespace fude
