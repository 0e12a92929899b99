// Where on a sheet the tip never was, and what it could not see.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace fude {

// The parts of a sheet of that size ("lower left", "middle", "upper right" …, as the painter sees it; the
// nine of three by three) that hold a place farther from every point than one and a half times the distance
// of points spread evenly. `points`: x and y on the sheet, mm, at least one.
std::vector<std::string> untouched_parts(std::span<const Eigen::Vector3d> points, double width_mm,
                                         double height_mm);

// How far apart the columns (x) and the rows (y) stand in which all points lie, mm; none where there are
// points between the rows or columns of the others. A wave of about that length shows in such points as a
// long one or not at all (Nyquist).
std::optional<Eigen::Vector2d> grid_spacing(std::span<const Eigen::Vector3d> points);

}  // namespace fude
