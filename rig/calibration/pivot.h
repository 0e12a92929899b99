// The tip of a brush, from a session in which it turns about it (calibration/pivot.h).
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "rig/calibration/calibrator.h"
#include "rig/calibration/known_calibrations.h"
#include "rig/calibration/tool_poses.h"

namespace fude {

struct PivotWish {
  ToolWish tool;
  std::optional<std::filesystem::path> spin;  // a session in which the handle is spun about itself
};

// finish() also has the errors of reading `spin`, whose poses are put right by the distortion that is known.
std::unique_ptr<Calibrator> pivot_calibrator(PivotWish wish, KnownCalibrations known = {});

}  // namespace fude
