// The painting surface from touches of a calibrated tip: a plane or a smooth curved sheet, and the paper on
// it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "calibration/pose_screen.h"
#include "calibration/report.h"
#include "calibration/smooth_field.h"
#include "calibration/touches.h"
#include "signal/pose.h"
#include "signal/pose_sample.h"

namespace fude {

struct SurfaceCalibration {
  // Between frames in millimetres on both sides: take on_paper() for points of a tracker in metres.
  Pose<Paper, Tracker> paper_from_tracker;
  // Height of the sheet over z = 0 at (x, y), mm; none: it is flat.
  std::optional<SmoothField> sheet;
  double width_mm = 0;  // of the paper, or of what was touched
  double height_mm = 0;
};
Fields to_fields(const SurfaceCalibration& surface);
std::optional<SurfaceCalibration> surface_from(const Fields& fields);

// x and y on the paper and the height above the sheet, mm.
Eigen::Vector3d on_paper(const SurfaceCalibration& surface, const Eigen::Vector3d& tracker_m);

// The sheet where it is touched: for contacts, against which a tip is pressed along the normal.
struct SheetPoint {
  double height_mm = 0;                               // of the sheet over the paper's z = 0
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // unit, upwards, in the paper's frame
};
// At x and y on the paper, mm; also beyond its edges, where the sheet goes on as it left. About 5 µs with the
// 200 knots that a sheet has at the most, nothing on a plane.
SheetPoint sheet_at(const SurfaceCalibration& surface, const Eigen::Vector2d& paper_mm);

class SurfaceProcedure {
 public:
  // `tip_m` in the tool's frame, from a pivot. `corners_first`: the first four touches are the paper's
  // corners, lower left, lower right, upper right, upper left as the painter sees it; without, the paper is
  // the rectangle about all touches.
  explicit SurfaceProcedure(const Eigen::Vector3d& tip_m, bool corners_first = false)
      : tip_m_(tip_m), corners_first_(corners_first) {}

  Progress add(const PoseSample& sample);

  // Takes the places where the tip rested; with fewer than six, every sample, of which those that lie on one
  // surface count (wiping). A curved sheet only where it foretells left-out touches better than the plane by
  // more than chance. Refused: fewer than six places, all on a line, a frozen tracker; more than a fifth of
  // the touches (of wiping, 70 in 100 samples) off the surface; a residual above 2 mm; corners out of order;
  // a sheet with more waves than its touches show, and where. Warned of: parts of a curved sheet where the
  // tip never was.
  Calibration<SurfaceCalibration> finish() const;

 private:
  std::string missing() const;

  Eigen::Vector3d tip_m_;
  bool corners_first_;
  PoseScreen screen_;
  std::vector<TipPoint> way_;
  // For the progress alone: places far from one another, and since when the tip has rested.
  std::vector<Eigen::Vector3d> places_;
  std::size_t rests_since_ = 0;
  Eigen::Vector3d handle_side_ = Eigen::Vector3d::Zero();
  std::string tool_;
};

}  // namespace fude
