#include "sim/ink/sheet_grain.h"

#include <algorithm>
#include <cmath>

namespace fude {
namespace {

constexpr double spacing_mm = 0.1;        // finer than a fibre is wide
constexpr std::size_t most_tiles = 4096;  // 16 MB, and more than any brush covers

int floor_div(int a, int b) { return a >= 0 ? a / b : -((-a + b - 1) / b); }

}  // namespace

SheetGrain::SheetGrain(const PaperSpec& paper, std::uint64_t seed)
    : texture_(paper, seed, spacing_mm, 0, 0, true) {
  // Tiles far from one another stand for the sheet.
  std::vector<float> all;
  for (int i = 0; i < 12; ++i) {
    const Tile& tile = tile_at(17 * i, 29 * (i % 5));
    all.insert(all.end(), tile.begin(), tile.end());
  }
  std::sort(all.begin(), all.end());
  for (std::size_t i = 0; i < quantiles_.size(); ++i)
    quantiles_[i] = all[std::min(all.size() - 1, i * all.size() / (quantiles_.size() - 1))];
}

const SheetGrain::Tile& SheetGrain::tile_at(int column, int row) {
  const std::uint64_t key =
      std::uint64_t{static_cast<std::uint32_t>(row)} << 32 | static_cast<std::uint32_t>(column);
  if (last_ && key == last_key_) return *last_;
  auto found = tiles_.find(key);
  if (found == tiles_.end()) {
    if (tiles_.size() >= most_tiles) tiles_.clear();
    std::array<Texture, tile::cells> cells;
    texture_.sample(column * tile::side, row * tile::side, cells.data());
    Tile grain(cells.size());
    std::transform(cells.begin(), cells.end(), grain.begin(), [](const Texture& t) { return t.grain; });
    found = tiles_.emplace(key, std::move(grain)).first;
  }
  last_key_ = key;
  last_ = &found->second;
  return *last_;
}

float SheetGrain::thickness(int column, int row) {
  const int tile_column = floor_div(column, tile::side);
  const int tile_row = floor_div(row, tile::side);
  const int x = column - tile_column * tile::side;
  const int y = row - tile_row * tile::side;
  return tile_at(tile_column, tile_row)[static_cast<std::size_t>(y * tile::side + x)];
}

// The share of the sheet that is thinner.
float SheetGrain::evened(float thickness) const {
  const auto above = std::upper_bound(quantiles_.begin() + 1, quantiles_.end() - 1, thickness);
  const float low = *(above - 1);
  const float part = *above > low ? std::clamp((thickness - low) / (*above - low), 0.0F, 1.0F) : 0.5F;
  return (static_cast<float>(above - quantiles_.begin() - 1) + part) /
         static_cast<float>(quantiles_.size() - 1);
}

void SheetGrain::heights(double left_mm, double y_mm, double spacing, std::span<float> row) {
  const double y = y_mm / spacing_mm - 0.5;
  const int below = static_cast<int>(std::floor(y));
  const auto up = static_cast<float>(y - below);
  int last = 0;
  float left = 0;
  float right = 0;
  bool known = false;
  for (std::size_t i = 0; i < row.size(); ++i) {
    const double x = (left_mm + static_cast<double>(i) * spacing) / spacing_mm - 0.5;
    const int before = static_cast<int>(std::floor(x));
    if (!known || before != last) {
      const auto column = [&](int c) {
        const float low = thickness(c, below);
        return low + up * (thickness(c, below + 1) - low);
      };
      left = known && before == last + 1 ? right : column(before);
      right = column(before + 1);
      last = before;
      known = true;
    }
    row[i] = evened(left + static_cast<float>(x - before) * (right - left));
  }
}

}  // namespace fude
