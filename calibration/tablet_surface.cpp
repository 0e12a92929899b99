#include "calibration/tablet_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "calibration/stored_field.h"
#include "signal/elementary.h"

namespace fude {
namespace {

constexpr double least_depth = 0.1;  // nearer the horizon of the homography nothing is believed

Eigen::Vector2d flat_on_paper(const TabletSurface& surface, const Eigen::Vector2d& moved_counts) {
  const Eigen::Matrix3d& m = surface.mm_from_counts;
  const double x = moved_counts.x(), y = moved_counts.y();
  const double depth = std::max(least_depth, m(2, 0) * x + m(2, 1) * y + m(2, 2));
  return {(m(0, 0) * x + m(0, 1) * y + m(0, 2)) / depth, (m(1, 0) * x + m(1, 1) * y + m(1, 2)) / depth};
}

std::optional<std::vector<double>> finite(const Fields& fields, const char* key, std::size_t count) {
  auto numbers = numbers_in(fields, key);
  const auto sound = [](double v) { return std::isfinite(v); };
  if (!numbers || numbers->size() != count || !std::ranges::all_of(*numbers, sound)) return std::nullopt;
  return numbers;
}

}  // namespace

Fields to_fields(const TabletSurface& surface) {
  std::vector<double> map;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) map.push_back(surface.mm_from_counts(i, j));
  Fields fields{{"shape", std::string("tablet")},
                {"mm_from_counts", map},
                {"lean_counts", std::vector{surface.lean_counts.x(), surface.lean_counts.y()}},
                {"width_mm", surface.width_mm},
                {"height_mm", surface.height_mm}};
  if (surface.warp) store(fields, "warp", *surface.warp);
  return fields;
}

std::optional<TabletSurface> tablet_surface_from(const Fields& fields) {
  if (text_in(fields, "shape") != "tablet") return std::nullopt;
  const auto map = finite(fields, "mm_from_counts", 9), lean = finite(fields, "lean_counts", 2),
             width = finite(fields, "width_mm", 1), height = finite(fields, "height_mm", 1);
  if (!map || !lean || !width || !height || !(width->front() > 0) || !(height->front() > 0))
    return std::nullopt;
  TabletSurface surface;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) surface.mm_from_counts(i, j) = (*map)[std::size_t(3 * i + j)];
  surface.lean_counts = {(*lean)[0], (*lean)[1]};
  surface.width_mm = width->front();
  surface.height_mm = height->front();
  if (!numbers_in(fields, "warp_knots")) return surface;
  surface.warp = stored_field(fields, "warp", 2);
  if (!surface.warp) return std::nullopt;
  return surface;
}

Eigen::Vector2d on_paper(const TabletSurface& surface, const Eigen::Vector2d& counts,
                         const Eigen::Vector2d& lean) {
  const Eigen::Vector2d flat = flat_on_paper(surface, counts + surface.lean_counts.cwiseProduct(lean));
  if (!surface.warp) return flat;
  const Eigen::RowVectorXd warp = surface.warp->at(Eigen::RowVector2d(flat.x(), flat.y()));
  return {flat.x() + warp(0), flat.y() + warp(1)};
}

Eigen::Vector2d on_paper(const TabletSurface& surface, const PenSample& pen) {
  return on_paper(surface, {pen.x_counts, pen.y_counts}, lean_of(pen));
}

Eigen::Matrix2d mm_per_count(const TabletSurface& surface, const Eigen::Vector2d& counts) {
  const Eigen::Matrix3d& m = surface.mm_from_counts;
  const Eigen::Vector2d at = flat_on_paper(surface, counts);
  const double depth = std::max(least_depth, m(2, 0) * counts.x() + m(2, 1) * counts.y() + m(2, 2));
  return (m.topLeftCorner<2, 2>() - at * m.block<1, 2>(2, 0)) / depth;
}

Radians turn_of(const TabletSurface& surface) {
  // Where the middle of the paper lies on the tablet, by the adjugate of the map: signs and size divide out.
  const Eigen::Matrix3d& m = surface.mm_from_counts;
  const Eigen::Vector3d middle(0.5 * surface.width_mm, 0.5 * surface.height_mm, 1);
  const Eigen::Vector3d first = m.row(1).cross(m.row(2)), second = m.row(2).cross(m.row(0)),
                        third = m.row(0).cross(m.row(1));
  const Eigen::Vector3d counts = first * middle.x() + second * middle.y() + third * middle.z();
  if (counts.z() == 0) return {};
  const Eigen::Vector2d right =
      mm_per_count(surface, {counts.x() / counts.z(), counts.y() / counts.z()}).col(0);
  return Radians(elementary::arctangent(right.y(), right.x()));
}

}  // namespace fude
