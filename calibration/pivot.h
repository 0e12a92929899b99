// Where a brush's tip is in the frame of its markers: the brush turns in every direction about its tip,
// which rests in one place; then, if the handle's axis is wanted too, it is spun about itself.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "calibration/pivot_fit.h"
#include "calibration/pose_screen.h"
#include "calibration/report.h"
#include "signal/pose_sample.h"

namespace fude {

struct PivotCalibration {
  std::string tool;                                 // as the tracker names it
  Eigen::Vector3d tip_m = Eigen::Vector3d::Zero();  // in Tool
  std::optional<Eigen::Vector3d> axis;              // in Tool, unit, from the tip up the handle
};
Fields to_fields(const PivotCalibration& pivot);
std::optional<PivotCalibration> pivot_from(const Fields& fields);

class PivotProcedure {
 public:
  // Poses of one tool, of the tracker or of a reference that stands for it.
  Progress add(const PoseSample& sample);
  // What is added from now on spins about the handle's axis; the tip may rest or not.
  void begin_spin() {
    spinning_ = true;
    screen_.begin_again();
  }

  // The tip of the robust fit. Refused: fewer than 8 different poses; a frozen tracker; an orientation that
  // stays; turning in one plane only (condition above 40); transposed matrices; more than a quarter of the
  // poses on another tip; a tip a metre from its markers (poses inverted, wrong unit); a residual, or halves
  // of the poses that disagree, above 5 mm. A spin that cannot be used leaves the axis out, with a warning.
  // Details of the report: the plain algebraic fit, the sphere fit, their disagreement, the tips of either
  // half, and the outliers by number and time.
  Calibration<PivotCalibration> finish() const;

 private:
  struct Turn {
    ToolPose pose;
    Timestamp time;
    std::size_t number = 0;  // among the samples added
  };
  Progress progress() const;

  std::vector<Turn> turns_;
  std::vector<ToolPose> spins_;
  Eigen::Matrix3d rotation_sum_ = Eigen::Matrix3d::Zero();
  PoseScreen screen_;
  std::string tool_;
  bool spinning_ = false;
};

}  // namespace fude
