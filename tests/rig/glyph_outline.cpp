#include "tests/rig/glyph_outline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <sstream>

namespace fude::glyph {
namespace {

struct Point {
  double x = 0;
  double y = 0;
};

constexpr int pieces = 16;  // of a curve

std::vector<Point> flatten(const std::string& path) {
  std::istringstream in(path);
  std::vector<Point> points;
  Point at;
  const auto read = [&in] {
    Point p;
    in >> p.x >> p.y;
    return p;
  };
  for (char verb = 0; in >> verb && verb != 'Z';) {
    if (verb == 'M' || verb == 'L') {
      points.push_back(at = read());
    } else if (verb == 'Q' || verb == 'C') {
      const Point a = read();
      const Point b = verb == 'C' ? read() : a;
      const Point end = read();
      for (int k = 1; k <= pieces; ++k) {
        const double s = double(k) / pieces;
        const double r = 1 - s;
        const std::array<double, 4> w = verb == 'C'
                                            ? std::array{r * r * r, 3 * r * r * s, 3 * r * s * s, s * s * s}
                                            : std::array{r * r, 2 * r * s, 0.0, s * s};
        points.push_back({w[0] * at.x + w[1] * a.x + w[2] * b.x + w[3] * end.x,
                          w[0] * at.y + w[1] * a.y + w[2] * b.y + w[3] * end.y});
      }
      at = end;
    }
  }
  return points;
}

double overlap_at(const Mask& a, const Mask& b, int dx, int dy) {
  std::int64_t both = 0;
  std::int64_t either = 0;
  for (int y = 0; y < a.rows; ++y)
    for (int x = 0; x < a.columns; ++x) {
      const bool in_a = a.at(x, y);
      const bool in_b = b.at(x - dx, y - dy);
      both += in_a && in_b;
      either += in_a || in_b;
    }
  return either == 0 ? 0 : double(both) / double(either);
}

}  // namespace

Mask fill(const std::vector<std::string>& paths, double em_mm, double left_mm, double bottom_mm,
          double cell_mm, int columns, int rows) {
  Mask mask{columns, rows,
            std::vector<char>(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows))};
  for (const std::string& path : paths) {
    std::vector<Point> outline = flatten(path);
    for (Point& p : outline)
      p = {(left_mm + p.x * em_mm / 1024) / cell_mm, (bottom_mm + p.y * em_mm / 1024) / cell_mm};
    for (int row = 0; row < rows; ++row) {
      std::vector<double> crossings;
      for (std::size_t i = 0; i < outline.size(); ++i) {
        const Point& p = outline[i];
        const Point& q = outline[(i + 1) % outline.size()];
        if ((p.y <= row + 0.5) != (q.y <= row + 0.5))
          crossings.push_back(p.x + (row + 0.5 - p.y) / (q.y - p.y) * (q.x - p.x));
      }
      std::sort(crossings.begin(), crossings.end());
      for (std::size_t i = 1; i < crossings.size(); i += 2)
        for (int column = std::max(0, int(std::ceil(crossings[i - 1] - 0.5)));
             column < std::min<double>(columns, crossings[i] - 0.5); ++column)
          mask.cells[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                     static_cast<std::size_t>(column)] = 1;
    }
  }
  return mask;
}

double best_overlap(const Mask& a, const Mask& b, int reach) {
  int x = 0;
  int y = 0;
  double best = overlap_at(a, b, 0, 0);
  for (int stride = reach / 2; stride >= 1; stride /= 2)
    for (bool better = true; better;) {
      better = false;
      for (const auto [dx, dy] : {std::array{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
        const int u = x + dx * stride;
        const int v = y + dy * stride;
        if (std::abs(u) > reach || std::abs(v) > reach) continue;
        if (const double now = overlap_at(a, b, u, v); now > best) {
          best = now;
          x = u;
          y = v;
          better = true;
        }
      }
    }
  return best;
}

}  // namespace fude::glyph
