// The relief of a sheet of paper as a dry brush feels it: the seam between what knows the paper and what
// touches it.
#pragma once

#include <span>

namespace fude {

class PaperGrain {
 public:
  virtual ~PaperGrain() = default;

  // Writes how high the paper stands at (left + i · spacing, y), in mm on the paper: 0 the deepest hollow, 1
  // the highest hill, and a share h of the sheet lies lower than h. The same at any place for any spacing.
  virtual void heights(double left_mm, double y_mm, double spacing_mm, std::span<float> row) = 0;
};

}  // namespace fude
