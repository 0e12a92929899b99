// Triangles row by row, on a grid of unit cells whose centres decide.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <utility>

namespace fude {

// The first cell whose centre is not left of x, held to [0, limit]. (std::ceil is a call without SSE4.)
inline int first_centre(double x, int limit) {
  const double shifted = std::clamp(x - 0.5, 0.0, static_cast<double>(limit));
  const int below = static_cast<int>(shifted);
  return below < shifted ? below + 1 : below;
}

// Calls span(row, from, to) for each of `height` rows whose centre line crosses the triangle; cells
// with centres in [from, to) lie in it. Triangles that share an edge share no cell.
template <class Span>
void scan_triangle(Eigen::Vector2d p, Eigen::Vector2d q, Eigen::Vector2d r, int height, Span span) {
  if (p.y() > q.y()) std::swap(p, q);
  if (q.y() > r.y()) std::swap(q, r);
  if (p.y() > q.y()) std::swap(p, q);
  const int first = first_centre(p.y(), height);
  const int end = first_centre(r.y(), height);
  if (first >= end) return;
  const double whole = (r.x() - p.x()) / (r.y() - p.y());
  const double lower = q.y() > p.y() ? (q.x() - p.x()) / (q.y() - p.y()) : 0;
  const double upper = r.y() > q.y() ? (r.x() - q.x()) / (r.y() - q.y()) : 0;
  for (int row = first; row < end; ++row) {
    const double y = row + 0.5;
    const double one = p.x() + (y - p.y()) * whole;
    const double other = y < q.y() ? p.x() + (y - p.y()) * lower : q.x() + (y - q.y()) * upper;
    span(row, std::min(one, other), std::max(one, other));
  }
}

}  // namespace fude
