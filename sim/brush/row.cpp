#include "sim/brush/row.h"

#include <algorithm>

namespace fude {
namespace {

using Eigen::Vector3d;

// A section is narrower where the paper cuts it than in its middle: neighbours overlap by so much.
constexpr double overlap = 1.15;
// Half the width of a slice over its share of the row, dry and more for each wetness: wet slices bridge
// small gaps, dry ones leave some.
constexpr double dry_reach = 0.78;
constexpr double wet_reach = 0.75;

}  // namespace

void join_row(const BrushSpec& spec, std::span<const double> wetness, BrushSurface& surface) {
  const std::size_t last = surface.size() - 1;
  const double share_mm = 0.5 * spec.row_width_mm / static_cast<double>(surface.size());
  for (std::size_t i = 0; i < surface.front().size(); ++i) {
    const auto at = [&](std::size_t slice) -> const Vector3d& { return surface[slice][i].centre; };
    for (std::size_t slice = 0; slice <= last; ++slice) {
      Station& s = surface[slice][i];
      const std::size_t before = slice > 0 ? slice - 1 : slice;
      const std::size_t next = std::min(slice + 1, last);
      const Vector3d along = s.lateral.cross(s.down);
      Vector3d across = at(next) - at(before);
      across -= along * along.dot(across);
      const double length = across.norm();
      if (length > 1e-9) {
        s.lateral = across / length;
        const Vector3d down = along.cross(s.lateral);
        s.down = down.dot(s.down) < 0 ? Vector3d(-down) : down;
      }
      const double reach_mm = share_mm * (dry_reach + wet_reach * wetness[slice]);
      const auto half = [&](std::size_t neighbour) {
        if (neighbour == slice) return std::min(share_mm, reach_mm);
        return std::min(overlap * 0.5 * (at(neighbour) - s.centre).norm(), reach_mm);
      };
      s.major_a = half(next);
      s.major_b = half(before);
      s.squared = true;
    }
  }
}

}  // namespace fude
