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

}  // namespace

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
