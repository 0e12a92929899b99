// Where on the paper a pen stands whose tablet or screen was tapped at known places.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "calibration/pen_presses.h"
#include "calibration/report.h"
#include "calibration/smooth_field.h"
#include "signal/pen_sample.h"
#include "signal/units.h"

namespace fude {

// Counts to millimetres of the paper, x to the right and y away from the painter, from its lower left corner.
struct TabletSurface {
  // The nib is not where the coil is that a tablet feels: the counts are moved by this, times the tangent of
  // each tilt, before they are mapped.
  Eigen::Vector2d lean_counts = Eigen::Vector2d::Zero();
  // A homography: (x, y, 1) in counts to (w·x, w·y, w) in millimetres, w about 1.
  Eigen::Matrix3d mm_from_counts = Eigen::Matrix3d::Identity();
  std::optional<SmoothField> warp;  // at those millimetres, what is to be added to x and y; none: nothing
  double width_mm = 0;
  double height_mm = 0;
};
Fields to_fields(const TabletSurface& surface);
// None where a key is missing or a number is not finite.
std::optional<TabletSurface> tablet_surface_from(const Fields& fields);

// The nib on the paper, mm. `lean`: tangents of tilt_x and tilt_y (lean_of). Finite for finite counts; the
// same bits on every machine.
Eigen::Vector2d on_paper(const TabletSurface& surface, const Eigen::Vector2d& counts,
                         const Eigen::Vector2d& lean);
Eigen::Vector2d on_paper(const TabletSurface& surface, const PenSample& pen);

// Millimetres for a count to the right (first column) and for one towards the painter (second) at that place,
// without the warp.
Eigen::Matrix2d mm_per_count(const TabletSurface& surface, const Eigen::Vector2d& counts);

// How the tablet lies on the paper, counter-clockwise as seen from above, by what is right on it in the
// middle of the paper.
Radians turn_of(const TabletSurface& surface);

// The places to tap, in their order, mm from the lower left corner of the paper.
struct TapSheet {
  std::vector<Eigen::Vector2d> places_mm;
  double width_mm = 0;
  double height_mm = 0;
  int columns = 0;  // of a grid; 0: a list
};
// Row by row as one reads, from the upper left; the outer places are the corners and edges of the sheet. Two
// columns and rows at the least.
TapSheet tap_grid(int columns, int rows, double width_mm, double height_mm);

class TabletProcedure {
 public:
  explicit TabletProcedure(TapSheet sheet) : sheet_(std::move(sheet)) {}

  Progress add(const PenSample& sample);

  // A homography; the shift with the tilt, and with 12 taps or more a smooth warp, only where they foretell
  // left-out taps better than without by more than chance. Bad taps are named and left out. `held_out_rms`:
  // each tap by a fit without it. Refused: fewer than nine places, or all on a line; another number of taps
  // than places; a frozen tablet; taps that do not rest; two on one place; mirrored; another order, or two
  // exchanged, that fits what this one does not; more than a quarter left out; a residual above 2 mm.
  Calibration<TabletSurface> finish() const;

 private:
  TapSheet sheet_;
  PressListener listener_;
  std::size_t samples_ = 0;
};

}  // namespace fude
