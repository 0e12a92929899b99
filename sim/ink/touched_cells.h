// A footprint map brought to the lattice: how much of each cell each patch newly covers, and how long it
// rests there.
#pragma once

#include <vector>

#include "signal/ink_event.h"

namespace fude {

struct TouchedCell {
  int column;
  int row;
  std::uint16_t patch;
  float fresh;      // share of the lattice cell
  float contact_s;  // seconds times the share covered
};

// In order of row, column and patch; one entry for each patch that touches a cell. Map cells are shared out
// by area; what lies off the sheet (columns × rows cells of cell_mm, lower left corner at the origin) is cut.
// Values that are not positive and finite count as nought, fresh above 1 as 1, patches that the deposit lacks
// are skipped.
std::vector<TouchedCell> touched_cells(const Deposit& deposit, double cell_mm, int columns, int rows);

}  // namespace fude
