#include "sim/brush/mark.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fude {

double Mark::area_mm2() const {
  double sum = 0;
  for (const float share : covered) sum += static_cast<double>(share);
  return sum * cell_mm * cell_mm;
}

double Mark::at(const Eigen::Vector2d& mm) const {
  const double x = (mm.x() - left_mm) / cell_mm - 0.5;
  const double y = (mm.y() - bottom_mm) / cell_mm - 0.5;
  if (!(x > -1 && y > -1 && x < columns && y < rows)) return 0;
  const int column = static_cast<int>(std::floor(x));
  const int row = static_cast<int>(std::floor(y));
  const auto share = [&](int c, int r) {
    if (c < 0 || r < 0 || c >= columns || r >= rows) return 0.0;
    return static_cast<double>(covered[static_cast<std::size_t>(r) * static_cast<std::size_t>(columns) +
                                       static_cast<std::size_t>(c)]);
  };
  const double s = x - column;
  const double t = y - row;
  return (1 - t) * ((1 - s) * share(column, row) + s * share(column + 1, row)) +
         t * ((1 - s) * share(column, row + 1) + s * share(column + 1, row + 1));
}

void Mark::add(const FootprintMap& map) {
  const double top_mm = bottom_mm + rows * cell_mm;
  const double right_mm = left_mm + columns * cell_mm;
  const double map_right = map.left_mm + map.columns * map.cell_mm;
  const double map_top = map.bottom_mm + map.rows * map.cell_mm;
  if (columns == 0 || map.left_mm < left_mm || map.bottom_mm < bottom_mm || map_right > right_mm ||
      map_top > top_mm) {
    // Room for this map and some more.
    constexpr double more_mm = 8;
    Mark wider;
    wider.cell_mm = cell_mm;
    const auto grid = [&](double mm) { return std::floor(mm / cell_mm) * cell_mm; };
    wider.left_mm = columns == 0 ? grid(map.left_mm) : std::min(left_mm, grid(map.left_mm - more_mm));
    wider.bottom_mm = columns == 0 ? grid(map.bottom_mm) : std::min(bottom_mm, grid(map.bottom_mm - more_mm));
    const double far_right = columns == 0 ? map_right : std::max(right_mm, map_right + more_mm);
    const double far_top = columns == 0 ? map_top : std::max(top_mm, map_top + more_mm);
    wider.columns = static_cast<int>(std::ceil((far_right - wider.left_mm) / cell_mm)) + 1;
    wider.rows = static_cast<int>(std::ceil((far_top - wider.bottom_mm) / cell_mm)) + 1;
    wider.covered.assign(static_cast<std::size_t>(wider.columns) * static_cast<std::size_t>(wider.rows), 0);
    const auto shift_x = static_cast<int>(std::lround((left_mm - wider.left_mm) / cell_mm));
    const auto shift_y = static_cast<int>(std::lround((bottom_mm - wider.bottom_mm) / cell_mm));
    for (int r = 0; r < rows; ++r)
      std::copy_n(covered.begin() + static_cast<std::ptrdiff_t>(r) * columns, columns,
                  wider.covered.begin() + static_cast<std::ptrdiff_t>(r + shift_y) * wider.columns + shift_x);
    *this = std::move(wider);
  }
  const double share = map.cell_mm * map.cell_mm / (cell_mm * cell_mm);
  for (int r = 0; r < map.rows; ++r)
    for (int c = 0; c < map.columns; ++c) {
      const float fresh = map.fresh[static_cast<std::size_t>(r) * static_cast<std::size_t>(map.columns) +
                                    static_cast<std::size_t>(c)];
      if (fresh <= 0) continue;
      const auto column =
          static_cast<std::size_t>((map.left_mm + (c + 0.5) * map.cell_mm - left_mm) / cell_mm);
      const auto row =
          static_cast<std::size_t>((map.bottom_mm + (r + 0.5) * map.cell_mm - bottom_mm) / cell_mm);
      float& here = covered[row * static_cast<std::size_t>(columns) + column];
      here = std::min(1.0F, here + fresh * static_cast<float>(share));
    }
}

}  // namespace fude
