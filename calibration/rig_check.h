// Whether brush and paper are still where they were calibrated: three of the paper's corners, touched again.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "calibration/pose_screen.h"
#include "calibration/report.h"
#include "calibration/surface.h"
#include "calibration/touches.h"
#include "signal/pose_sample.h"

namespace fude {

enum class RigMoved : std::uint8_t { nothing, paper, tip, unclear };

// How the paper lies now, about its middle and seen by the painter.
struct PaperMotion {
  Eigen::Vector3d shift_mm = Eigen::Vector3d::Zero();  // right, up (away from the painter), off the surface
  double turned_rad = 0;                               // counter-clockwise, about its normal
  double tilted_rad = 0;                               // of its normal
};

struct RigCheck {
  RigMoved moved = RigMoved::nothing;
  // Each as it would be, were it the only thing that moved; none where the corners were not touched.
  std::optional<PaperMotion> paper;
  std::optional<Eigen::Vector3d> tip_shift_mm;  // in Tool
};
Fields to_fields(const RigCheck& check);

class RigCheckProcedure {
 public:
  // What a person's touch may be off, and what counts as moved.
  static constexpr double limit_mm = 1;

  // The calibrations to be checked. `corners`: whether those of the surface are the paper's, as touched.
  RigCheckProcedure(SurfaceCalibration surface, const Eigen::Vector3d& tip_m, bool corners)
      : surface_(std::move(surface)), tip_m_(tip_m), corners_(corners) {}

  Progress add(const PoseSample& sample);

  // From where the tip rested, each place near a corner as that corner. A paper that moved takes the
  // touches along as one rigid body (Umeyama 1991); a tip that moved takes each along by the same way in the
  // frame of the handle, which differs in the room as far as the handle leans differently. What explains the
  // touches to `limit_mm` and alone does so has moved; where both do, it cannot be told which. Touches away
  // from the corners tell the height alone. Accepted: nothing moved by more than `limit_mm`. Refused: what
  // moved, and how far; fewer than three touches; a frozen tracker. rms, p95 and max are of the touches'
  // distances from where they should be, mm; ci95 is [0, limit_mm]. Details: `moved`, and how the paper and
  // the tip would have.
  Calibration<RigCheck> finish() const;

 private:
  struct Touch {
    Eigen::Vector3d at_mm;         // on the paper
    Eigen::Vector3d corner_mm;     // the nearest
    Eigen::Matrix3d paper_turned;  // from Tool
  };
  std::vector<Touch> touches() const;
  // Those that are the paper's corners; none where fewer than three are.
  std::vector<Touch> corners_among(const std::vector<Touch>& touched) const;
  Calibration<RigCheck> by_height(CalibrationReport report, const std::vector<Touch>& touched) const;
  Calibration<RigCheck> by_corners(CalibrationReport report, const std::vector<Touch>& touched) const;

  SurfaceCalibration surface_;
  Eigen::Vector3d tip_m_;
  bool corners_;
  PoseScreen screen_;
  std::vector<TipPoint> way_;
  std::vector<Eigen::Quaterniond> turned_;  // of each point of the way, from Tool to Tracker
  std::size_t looked_ = 0, rested_ = 0;
};

}  // namespace fude
