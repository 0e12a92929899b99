// The one place where SI units become lattice units: one cell, one step, and 1 = saturated paper.
#pragma once

#include "sim/ink/paper.h"

namespace fude {

// The constants of the kernels, in the order of the shader block.
struct LatticeNumbers {
#define NUMBER(name, meaning) float name = 0;
#include "sim/ink/kernels/lattice_numbers.inl"
#undef NUMBER
};

// Seconds of one step: 1/120 at cells of 0.1 mm, in proportion to the square of the cell, so that water
// spreads through a finer lattice as far in a second.
double step_seconds(double cell_mm);

LatticeNumbers lattice_numbers(const PaperSpec& paper, double cell_mm);

}  // namespace fude
