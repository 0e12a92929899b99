// Where a tracker stands to a reference, from landmarks that are touched or were measured
// (calibration/landmarks.h).
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <memory>
#include <optional>

#include "rig/calibration/calibrator.h"
#include "rig/calibration/known_calibrations.h"
#include "rig/calibration/tool_poses.h"

namespace fude {

struct TrackerWish {
  ToolWish tool;
  std::optional<Eigen::Vector3d> tip_m;           // instead of a pivot that is known
  std::filesystem::path landmarks;                // the list of the reference
  std::optional<std::filesystem::path> measured;  // the same as the tracker has them: no session is heard
};

// Errors: those of reading the lists. hear() also has the errors of tip_of.
Result<std::unique_ptr<Calibrator>> tracker_calibrator(TrackerWish wish, KnownCalibrations known);

}  // namespace fude
