// The relief of a sheet, from its own fibres and clouds: a pure function of paper, seed and place, whatever
// lattice the ink runs on.
#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "signal/paper_grain.h"
#include "sim/ink/paper_texture.h"

namespace fude {

// One thread at a time: remembers the parts of the sheet that were asked for lately.
class SheetGrain : public PaperGrain {
 public:
  SheetGrain(const PaperSpec& paper, std::uint64_t seed);

  void heights(double left_mm, double y_mm, double spacing_mm, std::span<float> row) override;

 private:
  using Tile = std::vector<float>;  // thickness
  const Tile& tile_at(int column, int row);
  float thickness(int column, int row);
  float evened(float thickness) const;

  PaperTexture texture_;
  std::unordered_map<std::uint64_t, Tile> tiles_;
  std::uint64_t last_key_ = 0;
  const Tile* last_ = nullptr;
  std::array<float, 257> quantiles_{};  // of the thickness
};

}  // namespace fude
