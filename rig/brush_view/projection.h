// How the paper's millimetres come to the pixels of a picture: x to the right, y downwards, z away from the
// eye.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace fude {

struct Projection {
  Eigen::Matrix4d pixels_from_paper = Eigen::Matrix4d::Identity();  // homogeneous

  // Not finite where the point lies in the plane of the eye.
  Eigen::Vector3d operator()(const Eigen::Vector3d& mm) const {
    const Eigen::Vector4d p = pixels_from_paper * mm.homogeneous();
    return p.head<3>() / p.w();
  }
  // The place of the paper that is seen at a pixel.
  Eigen::Vector2d on_paper(const Eigen::Vector2d& pixel) const;
};

// From straight above, but for what stands over the paper: a millimetre of height moves it by `per_height` mm
// on the paper. `origin_pixel` is where the paper's origin is seen.
Projection oblique(double pixels_per_mm, const Eigen::Vector2d& origin_pixel,
                   const Eigen::Vector2d& per_height);

// As an eye sees it that looks at `target`, both over the paper; `pixels_per_rad` about the middle of the
// picture.
Projection perspective(const Eigen::Vector3d& eye, const Eigen::Vector3d& target, double pixels_per_rad,
                       const Eigen::Vector2d& middle_pixel);

}  // namespace fude
