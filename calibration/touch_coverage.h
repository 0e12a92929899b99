// Where on a sheet the tip never was.
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

namespace fude {

// The parts of a sheet of that size ("lower left", "middle", "upper right" …, as the painter sees it; the
// nine of three by three) that hold a place farther from every point than one and a half times the distance
// of points spread evenly. `points`: x and y on the sheet, mm, at least one.
std::vector<std::string> untouched_parts(std::span<const Eigen::Vector3d> points, double width_mm,
                                         double height_mm);

}  // namespace fude
