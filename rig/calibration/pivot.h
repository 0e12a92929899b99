// The tip of a brush, from a session in which it turns about it (calibration/pivot.h).
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "rig/calibration/calibrator.h"
#include "rig/calibration/tool_poses.h"

namespace fude {

struct PivotWish {
  ToolWish tool;
  std::optional<std::filesystem::path> spin;  // a session in which the handle is spun about itself
};

// finish() also has the errors of reading `spin`.
std::unique_ptr<Calibrator> pivot_calibrator(PivotWish wish);

}  // namespace fude
