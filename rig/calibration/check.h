// Whether a rig is still as it was calibrated, from a session in which three of the paper's corners are
// touched (calibration/rig_check.h).
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>

#include "rig/calibration/calibrator.h"
#include "rig/calibration/known_calibrations.h"
#include "rig/calibration/tool_poses.h"

namespace fude {

struct CheckWish {
  ToolWish tool;
  std::optional<Eigen::Vector3d> tip_m;  // instead of a pivot that is known
};

// hear() also has the errors of tip_of, and usage where no surface is known.
std::unique_ptr<Calibrator> check_calibrator(CheckWish wish, KnownCalibrations known);

}  // namespace fude
