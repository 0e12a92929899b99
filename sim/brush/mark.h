// What a brush left on the paper since it was clean: the sum of its footprints.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "signal/ink_event.h"

namespace fude {

// Where the brush left ink: the share of each cell that was covered, 0 to 1. Paper millimetres.
struct Mark {
  double left_mm = 0;
  double bottom_mm = 0;
  double cell_mm = 0.1;
  int columns = 0;
  int rows = 0;
  std::vector<float> covered;  // row by row, upwards

  double area_mm2() const;
  // Between cells it goes evenly; 0 outside.
  double at(const Eigen::Vector2d& mm) const;
  void add(const FootprintMap& map);
};

}  // namespace fude
