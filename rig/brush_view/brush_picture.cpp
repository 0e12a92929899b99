#include "rig/brush_view/brush_picture.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "sim/brush/loading.h"
#include "sim/optics/srgb.h"

namespace fude {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int samples = 3;  // a side of a pixel
constexpr double grid_mm = 10;
constexpr double ink_ul_per_mm2 = 0.8 * unit_layer_ul_per_mm2;

// A part of the handle: from one distance from the root up to another, along the handle.
struct Piece {
  double from, to;  // tuft lengths
  double width_from, width_to;
  Bands colour;
};
constexpr std::array<Piece, 2> handle_pieces = {{{0, 0.42, 1.04, 0.86, {0.42, 0.40, 0.38}},      // ferrule
                                                 {0.42, 2.6, 0.80, 0.72, {0.36, 0.17, 0.07}}}};  // wood
constexpr int handle_sides = 28;

Tint lit(const Bands& colour, const Vector3d& normal) {
  const Vector3d lamp = Vector3d(-shadow_per_mm.x(), -shadow_per_mm.y(), 1).normalized();
  const double facing = std::max(0.0, normal.dot(lamp));
  const double shine =
      0.3 * std::pow(std::max(0.0, normal.dot((lamp + Vector3d(0, -1, 0.3)).normalized())), 20);
  Tint tint = Tint::Ones();
  for (int band = 0; band < 3; ++band)
    tint[band] = static_cast<float>(colour[static_cast<std::size_t>(band)] * (0.4 + 0.6 * facing) + shine);
  return tint;
}

TriangleLayer handle_layer(const Station& root, const Pose<Paper, Handle>& paper_from_handle,
                           double length_mm, const Projection& projection, const PixelBox& picture) {
  const Vector3d up = paper_from_handle.rotation * Vector3d::UnitZ();
  const Vector3d across = up.cross(root.lateral);
  const auto corner = [&](double along, double width, int side, const Bands& colour) {
    const double angle = 2 * std::numbers::pi * side / handle_sides;
    const Vector3d out = std::cos(angle) * 0.5 * (root.major_a + root.major_b) * root.lateral +
                         std::sin(angle) * root.minor * across;
    return Corner{projection(paper_from_handle.translation + along * length_mm * up + width * out),
                  lit(colour, out.normalized())};
  };
  TriangleLayer layer(picture, samples);
  for (const Piece& piece : handle_pieces)
    for (int side = 0; side < handle_sides; ++side) {
      const Corner a = corner(piece.from, piece.width_from, side, piece.colour);
      const Corner b = corner(piece.from, piece.width_from, side + 1, piece.colour);
      const Corner c = corner(piece.to, piece.width_to, side + 1, piece.colour);
      const Corner d = corner(piece.to, piece.width_to, side, piece.colour);
      layer.add(a, b, c);
      layer.add(a, c, d);
    }
  return layer;
}

// The paper with what the brush left and a line each centimetre.
Bands paper_at(const Vector2d& mm, double mm_per_pixel, const Mark& mark, const Palette& palette) {
  const double covered = mark.at(mm);
  const Bands inked = colour({static_cast<float>(ink_ul_per_mm2), 0, 0, 0}, palette);
  double line = 0;
  for (const double x : {mm.x(), mm.y()}) {
    const double away = std::abs(x - grid_mm * std::round(x / grid_mm));
    line = std::max(line, 1 - away / std::max(0.12, 0.7 * mm_per_pixel));
  }
  Bands seen{};
  for (std::size_t band = 0; band < seen.size(); ++band)
    seen[band] = (1 - covered) * palette.ground[band] * (1 - 0.18 * line) + covered * inked[band];
  return seen;
}

Projection projection_of(const PosedBrush& posed, double length_mm, const PictureWish& wish) {
  // About the tuft and its mark, from the painter's side.
  const Vector3d root = posed.brush.state().paper_from_handle.translation;
  const Mark& mark = posed.mark;
  double left = root.x() - 0.8 * length_mm;
  double right = root.x() + 0.8 * length_mm;
  if (mark.columns > 0) {
    left = std::min(left, mark.left_mm);
    right = std::max(right, mark.left_mm + mark.columns * mark.cell_mm);
  }
  const double width = std::max(right - left, 1.3 * root.z());
  const Vector3d target(0.5 * (left + right), root.y(), 0.45 * root.z());
  const Vector3d from = Vector3d(-0.12, -1, 0.72).normalized();
  constexpr double view_rad = 0.42;  // across the picture
  return perspective(target + width / view_rad * from, target, 0.86 * wish.width / view_rad,
                     0.5 * Vector2d(wish.width, wish.height));
}

}  // namespace

std::vector<SeenTuft> seen_tufts(const Brush& brush) {
  const std::vector<InkLoad> loads = offered(brush.state().loading);
  std::vector<SeenTuft> seen;
  for (TuftShape& tuft : brush.shape()) {
    std::vector<InkLoad> own;
    for (const std::uint16_t patch : tuft.patches) own.push_back(loads[patch]);
    seen.push_back({std::move(tuft.sections), std::move(own)});
  }
  return seen;
}

Picture picture_of(const PosedBrush& posed, const PictureWish& wish) {
  const std::vector<SeenTuft> tufts = seen_tufts(posed.brush);
  const double length_mm = posed.brush.spec().tuft_length_mm;
  const Projection projection = projection_of(posed, length_mm, wish);
  const PixelBox whole{0, 0, wish.width, wish.height};
  std::vector<TriangleLayer> layers =
      tuft_layers(tufts, wish.look, wish.opacity, wish.palette, projection, whole, samples);
  for (TriangleLayer& shadow : shadow_layers(tufts, projection, whole, samples))
    layers.push_back(std::move(shadow));
  layers.push_back(handle_layer(tufts.front().surface.front(), posed.brush.state().paper_from_handle,
                                length_mm, projection, whole));
  const TintedImage image = blend(layers);

  Picture picture(wish.width, wish.height);
  for (int row = 0; row < wish.height; ++row)
    for (int column = 0; column < wish.width; ++column) {
      const Vector2d here = projection.on_paper({column + 0.5, row + 0.5});
      const double mm_per_pixel = (projection.on_paper({column + 0.5, row + 1.5}) - here).norm();
      Bands seen = paper_at(here, mm_per_pixel, posed.mark, wish.palette);
      const Tint& over = image.at(column, row);
      for (std::size_t band = 0; band < seen.size(); ++band) {
        const double light = static_cast<double>(over[static_cast<Eigen::Index>(band)]) +
                             (1 - static_cast<double>(over[3])) * seen[band];
        picture.row(row)[static_cast<std::size_t>(column)][band] = srgb16_from_linear(light);
      }
    }
  return picture;
}

Picture contact_sheet(std::span<const Picture> pictures) {
  constexpr std::size_t in_a_row = 3;
  if (pictures.empty()) return {};
  const int width = pictures.front().width;
  const int height = pictures.front().height;
  const auto across = static_cast<int>(std::min(in_a_row, pictures.size()));
  const auto down = static_cast<int>((pictures.size() + in_a_row - 1) / in_a_row);
  Picture sheet(width * across, height * down);
  for (Rgb16& pixel : sheet.pixels) pixel = {0xffff, 0xffff, 0xffff};
  for (std::size_t i = 0; i < pictures.size(); ++i)
    for (int y = 0; y < height; ++y)
      std::ranges::copy(pictures[i].row(y), sheet.row(static_cast<int>(i / in_a_row) * height + y).begin() +
                                                static_cast<std::ptrdiff_t>(i % in_a_row) * width);
  return sheet;
}

}  // namespace fude
