// Whether brush and paper are still where they were calibrated: three of the paper's corners, touched again.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "calibration/pose_screen.h"
#include "calibration/report.h"
#include "calibration/rig_hypotheses.h"
#include "calibration/surface.h"
#include "calibration/touches.h"
#include "signal/pose_sample.h"

namespace fude {

struct RigCheck {
  RigMoved moved = RigMoved::nothing;
  double probability = 1;  // of that, among what may have moved
  // As it lies now to the tracker, and how the tip is off: each as it is likeliest where it moved alone, or
  // where both did.
  RigMotion paper, tip;
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

  // From where the tip rested, each place near a corner as that corner; where three corners are not known or
  // not touched, each place by its height alone. What moved is the hypothesis that has 95 % of the
  // probability (calibration/rig_hypotheses.h), unclear where none has. Accepted: nothing is off by more
  // than `limit_mm`. Refused: what moved, and how far; fewer than three touches; a frozen tracker. rms, p95
  // and max are of the touches' distances from where they should be, mm; ci95 is [0, limit_mm]. Details:
  // `moved` with its `probability`, and how the paper and the tip would have.
  Calibration<RigCheck> finish() const;

 private:
  std::vector<KnownTouch> touches() const;  // of the nearest corner each
  // Those that are the paper's corners; none where fewer than three are.
  std::vector<KnownTouch> corners_among(const std::vector<KnownTouch>& touched) const;
  Calibration<RigCheck> judged(CalibrationReport report, std::vector<KnownTouch> touched) const;

  SurfaceCalibration surface_;
  Eigen::Vector3d tip_m_;
  bool corners_;
  PoseScreen screen_;
  std::vector<TipPoint> way_;
  std::vector<Eigen::Quaterniond> turned_;  // of each point of the way, from Tool to Tracker
  std::size_t looked_ = 0, rested_ = 0;
};

}  // namespace fude
