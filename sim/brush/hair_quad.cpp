#include "sim/brush/hair_quad.h"

#include <cmath>
#include <cstddef>

namespace fude {

std::pair<int, int> find_rows(const HairQuad& quad, int height, std::vector<HairRow>& rows) {
  float bottom = quad[0].y;
  float top = bottom;
  for (const HairCorner& corner : quad) {
    bottom = std::min(bottom, corner.y);
    top = std::max(top, corner.y);
  }
  const int first_row = first_centre(bottom, height);
  const int end_row = first_centre(top, height);
  if (first_row >= end_row) return {first_row, first_row};
  rows.assign(static_cast<std::size_t>(end_row - first_row), {});
  for (std::size_t i = 0; i < quad.size(); ++i) {
    const HairCorner* low = &quad[i];
    const HairCorner* high = &quad[(i + 1) % quad.size()];
    if (low->y > high->y) std::swap(low, high);
    const int first = first_centre(low->y, height);
    const int end = first_centre(high->y, height);
    if (first >= end) continue;
    const float by_row = 1 / (high->y - low->y);
    const float x_by_row = (high->x - low->x) * by_row;
    const Hair hair_by_row = (high->hair - low->hair) * by_row;
    const float start = static_cast<float>(first) + 0.5F - low->y;
    float x = low->x + start * x_by_row;
    Hair hair = low->hair + start * hair_by_row;
    for (int row = first; row < end; ++row, x += x_by_row, hair += hair_by_row) {
      HairRow& ends = rows[static_cast<std::size_t>(row - first_row)];
      if (x < ends.from) {
        ends.from = x;
        ends.first = hair;
      }
      if (x > ends.to) {
        ends.to = x;
        ends.last = hair;
      }
    }
  }
  return {first_row, end_row};
}

HairSlope slope_of(const HairQuad& quad) {
  HairSlope slope;
  slope.low = slope.high = quad[0].hair;
  for (const HairCorner& corner : quad) {
    slope.low = slope.low.min(corner.hair);
    slope.high = slope.high.max(corner.hair);
  }
  const float ux = quad[2].x - quad[0].x;
  const float uy = quad[2].y - quad[0].y;
  const float vx = quad[3].x - quad[1].x;
  const float vy = quad[3].y - quad[1].y;
  const float area = ux * vy - uy * vx;
  constexpr float flat = 1e-3F;
  if (std::abs(area) < flat * (ux * ux + uy * uy + vx * vx + vy * vy)) return slope;
  const Hair by_u = (quad[2].hair - quad[0].hair) / area;
  const Hair by_v = (quad[3].hair - quad[1].hair) / area;
  slope.by_x = vy * by_u - uy * by_v;
  slope.by_y = ux * by_v - vx * by_u;
  return slope;
}

}  // namespace fude
