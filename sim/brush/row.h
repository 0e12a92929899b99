// The slices of a flat brush hang together as long as they are wet (Chu 2.8).
#pragma once

#include <span>

#include "sim/brush/brush_spec.h"
#include "sim/brush/footprint.h"

namespace fude {

// Turns the sections of each slice to face along its neighbours', squares them, and lets them reach as far as
// the neighbour does where `wetness` (0 to 1, slice by slice) still holds them together. Drier slices draw
// in, and gaps open between them.
void join_row(const BrushSpec& spec, std::span<const double> wetness, BrushSurface& surface);

}  // namespace fude
