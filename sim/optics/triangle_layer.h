// Triangles drawn in software, for pictures of solid things over the paper. In a layer the nearest surface is
// seen; layers are blended by their depth at every sample, so it does not matter in which order they were
// made, nor that they cross each other. Anti-aliased by several samples a pixel.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace fude {

// Red, green, blue (linear light) and opacity, 0 to 1; the light is not yet multiplied by the opacity.
using Tint = Eigen::Array4f;

// Pixels: x to the right, y downwards; z grows away from the eye.
struct Corner {
  Eigen::Vector3d at = Eigen::Vector3d::Zero();
  Tint tint = Tint::Zero();
};

struct PixelBox {
  int left = 0;
  int top = 0;
  int columns = 0;
  int rows = 0;
  bool operator==(const PixelBox&) const = default;
};

// The pixels around these corners, `margin` more on every side, that lie in `within`; empty where none does.
PixelBox box_around(std::span<const Corner> corners, int margin, const PixelBox& within);

class TriangleLayer {
 public:
  // `samples_per_side`: 1 to 8, squared a pixel.
  TriangleLayer(const PixelBox& box, int samples_per_side);

  // Either way round. A corner that is not finite leaves the triangle out.
  void add(const Corner& a, const Corner& b, const Corner& c);

  // Draws over a rim of this width inside of what is covered.
  void outline(double width_pixels, const Tint& tint);

  const PixelBox& box() const { return box_; }
  int samples_per_side() const { return per_side_; }

  struct Sample {
    float depth;
    Tint tint;
  };
  // Sample (i, j) of the layer, from its upper left; null where nothing was drawn.
  const Sample* at(int i, int j) const;

 private:
  int columns() const { return box_.columns * per_side_; }
  int rows() const { return box_.rows * per_side_; }
  std::size_t index(int i, int j) const {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(columns()) + static_cast<std::size_t>(i);
  }

  PixelBox box_;
  int per_side_;
  std::vector<Sample> samples_;
};

// Light already multiplied by the opacity; what lies behind shows by 1 − opacity.
struct TintedImage {
  PixelBox box;
  std::vector<Tint> pixels;  // row by row from the upper left
  const Tint& at(int column, int row) const {
    return pixels[static_cast<std::size_t>(row) * static_cast<std::size_t>(box.columns) +
                  static_cast<std::size_t>(column)];
  }
};

// Layers of equally many samples a pixel, in any order, over the box around all.
TintedImage blend(std::span<const TriangleLayer> layers);

}  // namespace fude
