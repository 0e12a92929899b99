// A magnetic tracker's distortion from places where its pose and the true one are known.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "calibration/distortion_field.h"
#include "calibration/landmarks.h"
#include "calibration/report.h"
#include "signal/pose_sample.h"

namespace fude {

// What is amiss at one place; metres and radians in the tracker's frame.
struct MappedPlace {
  Eigen::Vector3d at_m = Eigen::Vector3d::Zero();     // of the tool's origin, as measured
  Eigen::Vector3d shift_m = Eigen::Vector3d::Zero();  // from there to the true place
  std::optional<Eigen::Vector3d> turn_rad;            // likewise, of the rotation
};

// From a second tracker that no iron disturbs and that saw the same motion: where it stands is found from the
// motion too (calibration/motion_pairs.h), so a shift or a turn that is everywhere the same is not seen, and
// does not matter once tip and surface are found with corrected poses. None where they share too few moments.
std::vector<MappedPlace> places_of_motion(std::span<const PoseSample> magnetic,
                                          std::span<const PoseSample> undisturbed);

// From points of a true grid, touched in the order of the list: the grid lies where the points put it by
// least squares. Says nothing of turns. As many poses as landmarks.
std::vector<MappedPlace> places_of_grid(std::span<const Pose<Tracker, Tool>> touched,
                                        const Eigen::Vector3d& tip_m, const std::vector<Landmark>& grid);

class DistortionProcedure {
 public:
  Progress add(const MappedPlace& place);

  // A polyharmonic spline through the volume, as smooth as cross-validation finds it. More than 200 places
  // become the means of cells. Held out: places of every fifth cell, by the field of the others. Refused:
  // fewer than 20 places or cells; all on one plane; a field that does not foretell a fifth of the error;
  // what it leaves above 5 mm. Details: the error before, the turns before and after, the outliers' number.
  Calibration<DistortionField> finish() const;

 private:
  std::vector<MappedPlace> places_;
  std::size_t unusable_ = 0;
};

}  // namespace fude
