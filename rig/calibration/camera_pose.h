// Where a camera stands over the paper, from a session of pictures of a board that lies on it
// (vision/camera_pose.h).
#pragma once

#include <memory>
#include <string>

#include "rig/calibration/board_on_paper.h"
#include "rig/calibration/calibrator.h"
#include "rig/calibration/known_calibrations.h"
#include "vision/board.h"

namespace fude {

struct CameraPoseWish {
  std::string camera;  // the name of its device; empty: the only one
  Board board;
  BoardPlaceWish at;
};

// Errors: usage for a board that cannot be, or that looks the same upside down; those of place_of. hear():
// usage where no calibration of the camera's lens is known.
Result<std::unique_ptr<Calibrator>> camera_pose_calibrator(const CameraPoseWish& wish,
                                                           KnownCalibrations known);

}  // namespace fude
