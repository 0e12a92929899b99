// Where a camera stands over the paper, from a session of pictures of a board that lies on it
// (vision/camera_pose.h).
#pragma once

#include <memory>
#include <string>

#include "rig/calibration/calibrator.h"
#include "rig/calibration/known_calibrations.h"
#include "vision/board.h"

namespace fude {

// Where the board's first corner lies on the paper, and how its rows of corners are turned from the paper's
// x, counter-clockwise.
struct LyingAt {
  double x_mm = 0, y_mm = 0, turn_deg = 0;
};

struct CameraPoseWish {
  std::string camera;  // the name of its device; empty: the only one
  Board board;
  LyingAt lying_at;
};

// Errors: usage for a board that cannot be, or that looks the same upside down. hear(): usage where no
// calibration of the camera's lens is known.
Result<std::unique_ptr<Calibrator>> camera_pose_calibrator(const CameraPoseWish& wish,
                                                           KnownCalibrations known);

}  // namespace fude
