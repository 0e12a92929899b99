#include "sim/optics/triangle_layer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace fude {
namespace {

constexpr float nothing = std::numeric_limits<float>::infinity();

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

PixelBox box_around(const PixelBox& a, const PixelBox& b) {
  if (a.columns == 0 || a.rows == 0) return b;
  if (b.columns == 0 || b.rows == 0) return a;
  const int left = std::min(a.left, b.left);
  const int top = std::min(a.top, b.top);
  return {left, top, std::max(a.left + a.columns, b.left + b.columns) - left,
          std::max(a.top + a.rows, b.top + b.rows) - top};
}

}  // namespace

PixelBox box_around(std::span<const Corner> corners, int margin, const PixelBox& within) {
  Eigen::Array2d low = Eigen::Array2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Array2d high = -low;
  for (const Corner& c : corners) {
    if (!c.at.allFinite()) continue;
    low = low.min(c.at.head<2>().array());
    high = high.max(c.at.head<2>().array());
  }
  const auto within_columns = [&](double x) {
    return static_cast<int>(std::clamp(x, double(within.left), double(within.left + within.columns)));
  };
  const auto within_rows = [&](double y) {
    return static_cast<int>(std::clamp(y, double(within.top), double(within.top + within.rows)));
  };
  PixelBox box{within_columns(std::floor(low.x()) - margin), within_rows(std::floor(low.y()) - margin), 0, 0};
  box.columns = std::max(0, within_columns(std::ceil(high.x()) + margin) - box.left);
  box.rows = std::max(0, within_rows(std::ceil(high.y()) + margin) - box.top);
  return box;
}

TriangleLayer::TriangleLayer(const PixelBox& box, int samples_per_side)
    : box_(box), per_side_(samples_per_side) {
  if (samples_per_side < 1 || samples_per_side > 8 || box.columns < 0 || box.rows < 0)
    throw std::invalid_argument("TriangleLayer: 1 to 8 samples a side, and a box");
  samples_.assign(static_cast<std::size_t>(columns()) * static_cast<std::size_t>(rows()),
                  {nothing, Tint::Zero()});
}

const TriangleLayer::Sample* TriangleLayer::at(int i, int j) const {
  if (i < 0 || j < 0 || i >= columns() || j >= rows()) return nullptr;
  const Sample& sample = samples_[index(i, j)];
  return sample.depth < nothing ? &sample : nullptr;
}

void TriangleLayer::add(const Corner& a, const Corner& b, const Corner& c) {
  if (!a.at.allFinite() || !b.at.allFinite() || !c.at.allFinite()) return;
  // In samples, their centres at whole numbers.
  const auto placed = [&](const Corner& corner) -> Eigen::Vector2d {
    return (corner.at.head<2>() - Eigen::Vector2d(box_.left, box_.top)) * per_side_ -
           Eigen::Vector2d::Constant(0.5);
  };
  const Eigen::Vector2d p = placed(a);
  const Eigen::Vector2d q = placed(b);
  const Eigen::Vector2d r = placed(c);
  const double doubled_area = cross(q - p, r - p);
  if (doubled_area == 0) return;
  const auto first = [](double x) { return static_cast<int>(std::ceil(std::max(x, 0.0))); };
  const auto last = [](double x, int count) {
    return static_cast<int>(std::floor(std::clamp(x, -1.0, double(count - 1))));
  };
  const Eigen::Vector2d low = p.cwiseMin(q).cwiseMin(r).cwiseMin(1e6);
  const Eigen::Vector2d high = p.cwiseMax(q).cwiseMax(r);
  for (int j = first(low.y()); j <= last(high.y(), rows()); ++j)
    for (int i = first(low.x()); i <= last(high.x(), columns()); ++i) {
      const Eigen::Vector2d s(i, j);
      const double to_b = cross(s - p, r - p) / doubled_area;
      const double to_c = cross(q - p, s - p) / doubled_area;
      if (to_b < 0 || to_c < 0 || to_b + to_c > 1) continue;
      const double to_a = 1 - to_b - to_c;
      const auto depth = static_cast<float>(to_a * a.at.z() + to_b * b.at.z() + to_c * c.at.z());
      Sample& sample = samples_[index(i, j)];
      if (depth >= sample.depth) continue;
      sample.depth = depth;
      sample.tint = static_cast<float>(to_a) * a.tint + static_cast<float>(to_b) * b.tint +
                    static_cast<float>(to_c) * c.tint;
    }
}

void TriangleLayer::outline(double width_pixels, const Tint& tint) {
  // Distance to the outside by the chamfer of steps 3 and 4 (Borgefors 1986).
  constexpr int straight = 3;
  constexpr int diagonal = 4;
  std::vector<int> distance(samples_.size());
  const auto reached = [&](int i, int j) {
    return i < 0 || j < 0 || i >= columns() || j >= rows() ? 0 : distance[index(i, j)];
  };
  for (int j = 0; j < rows(); ++j)
    for (int i = 0; i < columns(); ++i)
      distance[index(i, j)] =
          samples_[index(i, j)].depth < nothing
              ? std::min({reached(i - 1, j) + straight, reached(i, j - 1) + straight,
                          reached(i - 1, j - 1) + diagonal, reached(i + 1, j - 1) + diagonal})
              : 0;
  for (int j = rows() - 1; j >= 0; --j)
    for (int i = columns() - 1; i >= 0; --i) {
      int& here = distance[index(i, j)];
      here = std::min({here, reached(i + 1, j) + straight, reached(i, j + 1) + straight,
                       reached(i + 1, j + 1) + diagonal, reached(i - 1, j + 1) + diagonal});
      if (here > 0 && here <= straight * width_pixels * per_side_) samples_[index(i, j)].tint = tint;
    }
}

TintedImage blend(std::span<const TriangleLayer> layers) {
  TintedImage image;
  for (const TriangleLayer& layer : layers) image.box = box_around(image.box, layer.box());
  image.pixels.assign(static_cast<std::size_t>(image.box.columns) * static_cast<std::size_t>(image.box.rows),
                      Tint::Zero());
  if (layers.empty()) return image;
  const int per_side = layers.front().samples_per_side();
  const float share = 1 / static_cast<float>(per_side * per_side);
  std::vector<const TriangleLayer::Sample*> seen;
  for (int row = 0; row < image.box.rows; ++row)
    for (int column = 0; column < image.box.columns; ++column) {
      Tint sum = Tint::Zero();
      for (int k = 0; k < per_side * per_side; ++k) {
        seen.clear();
        for (const TriangleLayer& layer : layers) {
          const int i = (column + image.box.left - layer.box().left) * per_side + k % per_side;
          const int j = (row + image.box.top - layer.box().top) * per_side + k / per_side;
          if (const auto* sample = layer.at(i, j)) seen.push_back(sample);
        }
        std::ranges::sort(seen, {}, [](const auto* sample) { return sample->depth; });
        float through = 1;
        for (const auto* sample : seen) {
          const float weight = through * sample->tint[3];
          sum.head<3>() += weight * sample->tint.head<3>();
          sum[3] += weight;
          through -= weight;
        }
      }
      image.pixels[static_cast<std::size_t>(row) * static_cast<std::size_t>(image.box.columns) +
                   static_cast<std::size_t>(column)] = share * sum;
    }
  return image;
}

}  // namespace fude
