#include "calibration/surface.h"

#include <Eigen/Geometry>
#include <cmath>

#include "calibration/stored_field.h"

namespace fude {
namespace {

constexpr double mm_per_m = 1e3;

}  // namespace

Fields to_fields(const SurfaceCalibration& surface) {
  const Eigen::Quaterniond& q = surface.paper_from_tracker.rotation;
  const Eigen::Vector3d t_m = surface.paper_from_tracker.translation / mm_per_m;
  const auto tracker_from_paper = surface.paper_from_tracker.inverse();
  const auto corner_m = [&](double x, double y) {
    const double z = surface.sheet ? surface.sheet->at(Eigen::RowVector2d(x, y))(0) : 0;
    return Eigen::Vector3d((tracker_from_paper * Eigen::Vector3d(x, y, z)) / mm_per_m);
  };
  std::vector<double> corners;
  for (const auto& [x, y] :
       {std::pair(0.0, 0.0), std::pair(surface.width_mm, 0.0), std::pair(surface.width_mm, surface.height_mm),
        std::pair(0.0, surface.height_mm)})
    for (const double v : corner_m(x, y)) corners.push_back(v);
  Fields fields{{"shape", std::string(surface.sheet ? "sheet" : "plane")},
                {"paper_from_tracker_q", std::vector{q.w(), q.x(), q.y(), q.z()}},
                {"paper_from_tracker_m", std::vector{t_m.x(), t_m.y(), t_m.z()}},
                {"width_mm", surface.width_mm},
                {"height_mm", surface.height_mm},
                {"corners_m", corners}};
  if (surface.sheet) store(fields, "sheet", *surface.sheet);
  return fields;
}

std::optional<SurfaceCalibration> surface_from(const Fields& fields) {
  const auto q = numbers_in(fields, "paper_from_tracker_q");
  const auto t_m = numbers_in(fields, "paper_from_tracker_m");
  const auto width = numbers_in(fields, "width_mm"), height = numbers_in(fields, "height_mm");
  if (!q || q->size() != 4 || !t_m || t_m->size() != 3 || !width || !height || width->empty() ||
      height->empty())
    return std::nullopt;
  SurfaceCalibration surface;
  const Eigen::Quaterniond rotation((*q)[0], (*q)[1], (*q)[2], (*q)[3]);
  if (!(std::abs(rotation.norm() - 1) < 1e-3)) return std::nullopt;
  surface.paper_from_tracker = {rotation.normalized(), mm_per_m * Eigen::Vector3d(t_m->data())};
  surface.width_mm = width->front();
  surface.height_mm = height->front();
  if (text_in(fields, "shape") != "sheet") return surface;
  surface.sheet = stored_field(fields, "sheet", 1);
  if (!surface.sheet) return std::nullopt;
  return surface;
}

Eigen::Vector3d on_paper(const SurfaceCalibration& surface, const Eigen::Vector3d& tracker_m) {
  Eigen::Vector3d p = surface.paper_from_tracker * (mm_per_m * tracker_m);
  if (surface.sheet) p.z() -= surface.sheet->at(p.head<2>().transpose())(0);
  return p;
}

SheetPoint sheet_at(const SurfaceCalibration& surface, const Eigen::Vector2d& paper_mm) {
  if (!surface.sheet) return {};
  const Eigen::RowVector2d at = paper_mm.transpose();
  const Eigen::Vector2d slope = surface.sheet->slope(at).col(0);
  return {surface.sheet->at(at)(0), Eigen::Vector3d(-slope.x(), -slope.y(), 1).normalized()};
}

}  // namespace fude
