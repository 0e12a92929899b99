// How a camera sees: from a place before it to a pixel.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

namespace fude {

// A camera's frame: origin in its centre of projection, x right and y down in the picture, z ahead; metres.
struct Camera {};

// A pinhole with the lens distortion of Brown, as OpenCV counts its coefficients: k1, k2, p1, p2, k3.
struct CameraModel {
  std::int32_t width = 0;  // of the pictures that it holds for, in pixels
  std::int32_t height = 0;
  Eigen::Vector2d focal_px = Eigen::Vector2d::Zero();
  Eigen::Vector2d centre_px = Eigen::Vector2d::Zero();  // of the middle of the upper left pixel: 0, 0
  std::array<double, 5> distortion{};

  // `place`: in Camera, before it (z above 0).
  Eigen::Vector2d pixel_of(const Eigen::Vector3d& place) const;
};

}  // namespace fude
