#include "calibration/touch_coverage.h"

#include <algorithm>
#include <cmath>

namespace fude {
namespace {

std::string part_name(int column, int row) {
  static constexpr const char* up[] = {"lower", "middle", "upper"};
  static constexpr const char* along[] = {"left", "middle", "right"};
  if (row == 1) return column == 1 ? "middle" : along[column];
  return std::string(up[row]) + " " + along[column];
}

struct Lines {
  double count = 1, spacing = 0;
};
// Of values that lie close together each.
Lines lines_of(std::vector<double> values) {
  std::ranges::sort(values);
  const double extent = values.back() - values.front();
  constexpr double apart = 0.3;  // of the spacing in a square grid of as many points
  const double gap = apart * extent / std::sqrt(double(values.size()));
  Lines lines;
  for (std::size_t i = 1; i < values.size(); ++i) lines.count += values[i] - values[i - 1] > gap;
  lines.spacing = extent / std::max(1.0, lines.count - 1);
  return lines;
}

}  // namespace

std::optional<Eigen::Vector2d> grid_spacing(std::span<const Eigen::Vector3d> points) {
  std::vector<double> x, y;
  for (const Eigen::Vector3d& p : points) {
    x.push_back(p.x());
    y.push_back(p.y());
  }
  const Lines columns = lines_of(x), rows = lines_of(y);
  constexpr double few_missing = 1.3;
  if (columns.count * rows.count > few_missing * double(points.size())) return std::nullopt;
  return Eigen::Vector2d(columns.spacing, rows.spacing);
}

std::vector<std::string> untouched_parts(std::span<const Eigen::Vector3d> points, double width_mm,
                                         double height_mm) {
  constexpr double far = 1.5;
  constexpr int steps = 9;  // three by three places a part
  const double reach = far * std::sqrt(width_mm * height_mm / double(points.size()));
  std::vector<std::string> parts;
  for (int j = 0; j < steps; ++j)
    for (int i = 0; i < steps; ++i) {
      const Eigen::Vector2d place(width_mm * i / (steps - 1), height_mm * j / (steps - 1));
      const auto near = [&](const Eigen::Vector3d& p) { return (p.head<2>() - place).norm() < reach; };
      const std::string part = part_name(i / 3, j / 3);
      if (std::none_of(points.begin(), points.end(), near) && std::ranges::find(parts, part) == parts.end())
        parts.push_back(part);
    }
  return parts;
}

}  // namespace fude
