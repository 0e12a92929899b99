#include "sim/ink/lattice.h"

namespace fude {

FixedPigment fixed_of(const PlaneView& tile) {
  FixedPigment pigment;
  pigment.reserve(4 * tile::cells);
  for (std::size_t c = 0; c < 4; ++c)
    for (int y = 0; y < tile::side; ++y) {
      const float* row = tile.cells(tile::still_begin + tile::fixed_mass + c, y);
      pigment.insert(pigment.end(), row, row + tile::side);
    }
  return pigment;
}

void lay_fixed(const PlaneView& tile, const FixedPigment& pigment) {
  for (int y = 0; y < tile::side; ++y)
    for (int x = 0; x < tile::side; ++x) {
      std::array<float, 4> m;
      for (std::size_t c = 0; c < 4; ++c) {
        m[c] = pigment[c * tile::cells + static_cast<std::size_t>(y * tile::side + x)];
        tile.cells(tile::still_begin + tile::fixed_mass + c, y)[x] = m[c];
      }
      tile.cells(tile::fixed_ink, y)[x] = (m[0] + m[1]) + (m[2] + m[3]);  // in the order the step sums it
    }
}

}  // namespace fude
