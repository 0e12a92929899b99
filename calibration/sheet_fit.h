// A curved sheet over a plane, through those of many points that lie on it.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "calibration/smooth_field.h"

namespace fude {

struct SheetFit {
  SmoothField height;        // z over (x, y), in the units of the points
  std::vector<bool> agrees;  // a point each
  // Foretells points that it has not seen better than a plane does, by more than the error of that
  // comparison.
  bool better_than_plane = false;
  double left_out_rms = 0;
};

// Points lie about z = 0. None where they are fewer than 12 or do not spread over the rectangle about them:
// then only a plane can be told. `finest`: the smallest standard deviation to believe.
std::optional<SheetFit> fit_sheet(std::span<const Eigen::Vector3d> points, double finest);

// Points side by side that were left out together: how well the rest foretells them says whether the sheet
// was touched densely enough for its shape.
struct Strip {
  int axis = 0;  // 0: the strip stands upright, all its points near one x; 1: near one y
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  double rms = 0;
};

// The strips between the outermost, as many in each direction as points stand beside one another; those of
// many points narrower. Each is foretold by the sheet through the others.
std::vector<Strip> left_out_strips(std::span<const Eigen::Vector3d> points);

// The smooth sheet through points that are all believed: of the free shapes, that which foretells points it
// has not seen best.
SmoothField sheet_through(std::span<const Eigen::Vector3d> points);

// At most about 200 points with the same shape: means of those that fall into one cell.
std::vector<Eigen::Vector3d> thinned(std::span<const Eigen::Vector3d> points);

}  // namespace fude
