#include "signal/camera_model.h"

namespace fude {

Eigen::Vector2d CameraModel::pixel_of(const Eigen::Vector3d& place) const {
  const Eigen::Vector2d ideal = place.head<2>() / place.z();
  const double x = ideal.x();
  const double y = ideal.y();
  const double r2 = ideal.squaredNorm();
  const auto& [k1, k2, p1, p2, k3] = distortion;
  const double radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
  const Eigen::Vector2d tangential{2 * p1 * x * y + p2 * (r2 + 2 * x * x),
                                   p1 * (r2 + 2 * y * y) + 2 * p2 * x * y};
  return centre_px + focal_px.cwiseProduct(radial * ideal + tangential);
}

}  // namespace fude
