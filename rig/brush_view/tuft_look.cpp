#include "rig/brush_view/tuft_look.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "sim/brush/loading.h"

namespace fude {
namespace {

using Eigen::Vector3d;

constexpr Bands hair = {0.62, 0.47, 0.30};  // goat, washed
constexpr double rim_pixels = 1.3;
constexpr int columns = 28;                                      // around a section
constexpr double film_ul_per_mm2 = 0.5 * unit_layer_ul_per_mm2;  // of ink on wet hair, as it is seen
constexpr double ambient = 0.42;
constexpr double gloss = 0.22;

const Vector3d lamp = Vector3d(-shadow_per_mm.x(), -shadow_per_mm.y(), 1).normalized();

// The penumbra: the lamp's disc, a few points of it.
constexpr std::array<std::array<double, 2>, 5> lamp_points = {
    {{0, 0}, {0.045, 0.02}, {-0.045, -0.02}, {0.02, -0.045}, {-0.02, 0.045}}};
constexpr float shadow_opacity = 0.085F;  // of one of them

constexpr double under_mm = 0.02;  // so that hair on the paper lies upon them

// A point of the surface at `around` turns from the lateral line.
Vector3d surface_point(const Station& s, double around) {
  const double angle = 2 * std::numbers::pi * around;
  const double cosine = std::cos(angle);
  const Vector3d down = s.flipped ? Vector3d(-s.down) : s.down;
  return s.centre + (cosine > 0 ? s.major_a : s.major_b) * cosine * s.lateral +
         s.minor * std::sin(angle) * down;
}

struct Grid {
  std::size_t rings;
  std::vector<Vector3d> points;
  const Vector3d& at(std::size_t ring, int column) const {
    return points[ring * columns + static_cast<std::size_t>((column + columns) % columns)];
  }
};

Grid grid_of(const TuftSurface& surface) {
  Grid grid{surface.size(), {}};
  for (const Station& s : surface)
    for (int c = 0; c < columns; ++c) {
      Vector3d p = surface_point(s, static_cast<double>(c) / columns);
      p.z() = std::max(p.z(), 0.0);  // hair that is pressed lies on the paper
      grid.points.push_back(p);
    }
  return grid;
}

// Outwards. What lies flat on the paper faces up.
Vector3d normal_of(const Grid& grid, std::size_t ring, int column) {
  const std::size_t before = ring == 0 ? 0 : ring - 1;
  const std::size_t after = std::min(ring + 1, grid.rings - 1);
  const Vector3d along = grid.at(after, column) - grid.at(before, column);
  const Vector3d around = grid.at(ring, column + 1) - grid.at(ring, column - 1);
  const Vector3d normal = around.cross(along);
  const double length = normal.norm();
  return length > 0 ? Vector3d(normal / length) : Vector3d::UnitZ();
}

Bands bare_or_inked(const SeenTuft& tuft, double along, double around, TuftLook look,
                    const Palette& palette) {
  if (look != TuftLook::colours || tuft.loads.size() != patch_count) return hair;
  const InkLoad& load = tuft.loads[static_cast<std::size_t>(patch_at(along, around))];
  Concentrations film{};
  for (std::size_t i = 0; i < film.size(); ++i)
    film[i] = std::max(0.0F, load.wetness * load.strength[i]) * static_cast<float>(film_ul_per_mm2);
  return colour(film, {palette.pigments, hair});
}

Tint lit(const Bands& seen, const Vector3d& normal, double opacity) {
  const double facing = std::max(0.0, normal.dot(lamp));
  const double shine = std::pow(std::max(0.0, normal.dot((lamp + Vector3d::UnitZ()).normalized())), 24);
  Tint tint;
  for (int band = 0; band < 3; ++band)
    tint[band] = static_cast<float>(
        seen[static_cast<std::size_t>(band)] * (ambient + (1 - ambient) * facing) + gloss * shine);
  tint[3] = static_cast<float>(opacity);
  return tint;
}

// The corners of all points, in the order of the grid.
template <class TintAt>
std::vector<Corner> corners_of(const Grid& grid, const Projection& projection, TintAt tint_at) {
  std::vector<Corner> corners;
  corners.reserve(grid.points.size());
  for (std::size_t ring = 0; ring < grid.rings; ++ring)
    for (int c = 0; c < columns; ++c) corners.push_back({projection(grid.at(ring, c)), tint_at(ring, c)});
  return corners;
}

void draw(TriangleLayer& layer, const std::vector<Corner>& corners, std::size_t rings) {
  for (std::size_t ring = 1; ring < rings; ++ring)
    for (std::size_t c = 0; c < columns; ++c) {
      const std::size_t next = (c + 1) % columns;
      const Corner& a = corners[(ring - 1) * columns + c];
      const Corner& b = corners[(ring - 1) * columns + next];
      const Corner& d = corners[ring * columns + c];
      const Corner& e = corners[ring * columns + next];
      layer.add(a, b, e);
      layer.add(a, e, d);
    }
}

}  // namespace

std::vector<TriangleLayer> tuft_layers(std::span<const SeenTuft> tufts, TuftLook look, double opacity,
                                       const Palette& palette, const Projection& projection,
                                       const PixelBox& picture, int samples_per_side) {
  std::vector<TriangleLayer> layers;
  if (look == TuftLook::off) return layers;
  const Tint rim(0.02F, 0.014F, 0.01F, static_cast<float>(std::min(1.0, opacity + 0.15)));
  for (const SeenTuft& tuft : tufts) {
    if (tuft.surface.size() < 2) continue;
    const Grid grid = grid_of(tuft.surface);
    const auto tint_at = [&](std::size_t ring, int c) -> Tint {
      if (look == TuftLook::outline) return Tint(1, 1, 1, 0);
      return lit(
          bare_or_inked(tuft, tuft.surface[ring].along, static_cast<double>(c) / columns, look, palette),
          normal_of(grid, ring, c), opacity);
    };
    const std::vector<Corner> corners = corners_of(grid, projection, tint_at);
    layers.emplace_back(box_around(corners, 1, picture), samples_per_side);
    draw(layers.back(), corners, grid.rings);
    layers.back().outline(rim_pixels, rim);
  }
  return layers;
}

std::vector<TriangleLayer> shadow_layers(std::span<const SeenTuft> tufts, const Projection& projection,
                                         const PixelBox& picture, int samples_per_side) {
  const Tint dark(0, 0, 0, shadow_opacity);
  std::vector<TriangleLayer> layers;
  for (const auto& point : lamp_points) {
    const Eigen::Vector2d per_mm = shadow_per_mm + Eigen::Vector2d(point[0], point[1]);
    std::vector<std::vector<Corner>> shadows;
    std::vector<Corner> all;
    for (const SeenTuft& tuft : tufts) {
      if (tuft.surface.size() < 2) continue;
      Grid grid = grid_of(tuft.surface);
      for (Vector3d& p : grid.points) {
        p.head<2>() += p.z() * per_mm;
        p.z() = -under_mm;
      }
      shadows.push_back(corners_of(grid, projection, [&](std::size_t, int) { return dark; }));
      all.insert(all.end(), shadows.back().begin(), shadows.back().end());
    }
    TriangleLayer layer(box_around(all, 1, picture), samples_per_side);
    for (const auto& corners : shadows) draw(layer, corners, corners.size() / columns);
    layers.push_back(std::move(layer));
  }
  return layers;
}

}  // namespace fude
