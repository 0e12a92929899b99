// The painting surface, from a session of touches with a calibrated tip (calibration/surface.h).
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>

#include "rig/calibration/calibrator.h"
#include "rig/calibration/known_calibrations.h"
#include "rig/calibration/tool_poses.h"

namespace fude {

struct SurfaceWish {
  ToolWish tool;
  std::optional<Eigen::Vector3d> tip_m;  // instead of a pivot that is known
  bool corners_first = false;            // the first four touches are the paper's corners
};

// hear() also has the errors of tip_of.
std::unique_ptr<Calibrator> surface_calibrator(SurfaceWish wish, KnownCalibrations known);

}  // namespace fude
