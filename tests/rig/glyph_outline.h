// The outlines of a printed character as a mask of cells, to compare a written one with.
#pragma once

#include <string>
#include <vector>

namespace fude::glyph {

struct Mask {
  int columns = 0;
  int rows = 0;
  std::vector<char> cells;  // row by row from the bottom

  bool at(int column, int row) const {
    return column >= 0 && row >= 0 && column < columns && row < rows &&
           cells[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                 static_cast<std::size_t>(column)];
  }
};

// SVG paths of M, L, Q, C and Z with absolute coordinates, y up, 1024 to the em, filled even-odd one by
// one and united. `em_mm` is the size of the em; its lower left corner lies at (left_mm, bottom_mm).
Mask fill(const std::vector<std::string>& paths, double em_mm, double left_mm, double bottom_mm,
          double cell_mm, int columns, int rows);

// Intersection over union of two masks at the shift of `b` (within ± `reach` cells) that makes it greatest.
double best_overlap(const Mask& a, const Mask& b, int reach);

}  // namespace fude::glyph
