// A quadrilateral of the tuft's surface over a grid of unit cells whose centres decide, and which hair
// stands over each of them.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <limits>
#include <utility>
#include <vector>

namespace fude {

// What goes over linearly from corner to corner: along (0 root to 1 tip), around (in turns from the lateral
// line, and one more, so that it is not below 0), and two numbers of whoever draws.
using Hair = Eigen::Array4f;

struct HairCorner {
  float x;  // cells
  float y;
  Hair hair;
};
using HairQuad = std::array<HairCorner, 4>;

// What of one row of cells lies in a quad.
struct HairRow {
  float from = std::numeric_limits<float>::max();
  float to = -std::numeric_limits<float>::max();
  Hair first = Hair::Zero();
  Hair last = Hair::Zero();
};

// The first cell whose centre is not left of x, held to [0, limit]. (std::ceil is a call without SSE4.)
inline int first_centre(float x, int limit) {
  const float shifted = std::clamp(x - 0.5F, 0.0F, static_cast<float>(limit));
  const int below = static_cast<int>(shifted);
  return static_cast<float>(below) < shifted ? below + 1 : below;
}

// Fills `rows` for the rows from the first to before the last that is returned, held to [0, height). Along a
// row hair goes over linearly from edge to edge, so that neighbouring quads agree on what they share.
std::pair<int, int> find_rows(const HairQuad& quad, int height, std::vector<HairRow>& rows);

// How hair changes from cell to cell, by the diagonals of the quad, and between what it stays; the same
// everywhere where the quad is flat.
struct HairSlope {
  Hair by_x = Hair::Zero();
  Hair by_y = Hair::Zero();
  Hair low = Hair::Zero();
  Hair high = Hair::Zero();
};
HairSlope slope_of(const HairQuad& quad);

}  // namespace fude
