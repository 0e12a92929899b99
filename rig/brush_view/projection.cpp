#include "rig/brush_view/projection.h"

#include <Eigen/LU>

namespace fude {

Eigen::Vector2d Projection::on_paper(const Eigen::Vector2d& pixel) const {
  // Of the sheet's points z is 0, and the depth is not asked for.
  Eigen::Matrix3d pixel_from_sheet;
  for (int i = 0; i < 3; ++i) {
    const int row = i < 2 ? i : 3;
    pixel_from_sheet.row(i) << pixels_from_paper(row, 0), pixels_from_paper(row, 1),
        pixels_from_paper(row, 3);
  }
  return (pixel_from_sheet.inverse() * pixel.homogeneous()).hnormalized();
}

Projection oblique(double pixels_per_mm, const Eigen::Vector2d& origin_pixel,
                   const Eigen::Vector2d& per_height) {
  Projection projection;
  projection.pixels_from_paper << pixels_per_mm, 0, pixels_per_mm * per_height.x(), origin_pixel.x(),  //
      0, -pixels_per_mm, -pixels_per_mm * per_height.y(), origin_pixel.y(),                            //
      0, 0, -1, 0,                                                                                     //
      0, 0, 0, 1;
  return projection;
}

Projection perspective(const Eigen::Vector3d& eye, const Eigen::Vector3d& target, double pixels_per_rad,
                       const Eigen::Vector2d& middle_pixel) {
  const Eigen::Vector3d ahead = (target - eye).normalized();
  const Eigen::Vector3d right = ahead.cross(Eigen::Vector3d::UnitZ()).normalized();
  const Eigen::Vector3d below = ahead.cross(right);
  const Eigen::RowVector3d x = pixels_per_rad * right + middle_pixel.x() * ahead;
  const Eigen::RowVector3d y = pixels_per_rad * below + middle_pixel.y() * ahead;
  const Eigen::RowVector3d w = ahead;
  Projection projection;
  // z/w = −1/w grows with the distance, and is linear over a triangle's pixels.
  projection.pixels_from_paper << x, -x.dot(eye), y, -y.dot(eye), 0, 0, 0, -1, w, -w.dot(eye);
  return projection;
}

}  // namespace fude
