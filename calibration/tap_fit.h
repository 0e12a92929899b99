// The map from a tablet's counts to the paper through taps at known places.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "calibration/tablet_surface.h"

namespace fude {

struct Tap {
  Eigen::Vector2d counts = Eigen::Vector2d::Zero();
  Eigen::Vector2d lean = Eigen::Vector2d::Zero();  // tangents of the tilts
  Eigen::Vector2d place_mm = Eigen::Vector2d::Zero();
};

// What is sought beside the homography.
struct TapModel {
  bool lean = false;
  bool warp = false;
};

struct TapFit {
  TabletSurface surface;
  double freedom = 0;  // numbers that were fitted
  double sum_mm2 = 0;  // of squared distances
};

// Least squares of distances on the paper. At least nine taps, not on a line; of the warp at most about 250.
TapFit fit_taps(std::span<const Tap> taps, TapModel model);

// n × 2: each tap's place less where a fit without it puts the tap.
Eigen::MatrixXd left_out_errors(std::span<const Tap> taps, TapModel model);

struct RobustTaps {
  TapFit fit;
  TapModel model;
  bool leaned = false;       // the pen, in both directions, enough to tell what that does
  std::vector<bool> agrees;  // a tap each
  std::vector<Tap> used;     // those that agree
  Eigen::MatrixXd left_out;  // their errors, each left out in its turn
};

// With bad taps left out: one whose omission takes away more of the squares than chance does once in a
// thousand fits, as long as three quarters remain. The simplest model that none clearly beats on left-out
// taps.
RobustTaps robust_taps(std::span<const Tap> taps);

}  // namespace fude
