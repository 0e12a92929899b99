// A camera, from a session of pictures of a board (vision/camera_calibration.h).
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "rig/calibration/calibrator.h"
#include "signal/camera_model.h"
#include "vision/board.h"

namespace fude {

struct CameraWish {
  std::string camera;  // the name of its device; empty: the only one
  Board board;
};

// Pictures are named "picture 1", "picture 2" … in their order. Details of the report: each view with its
// rms, what was left out, the coverage. Errors: usage for a board that cannot be.
Result<std::unique_ptr<Calibrator>> camera_calibrator(const CameraWish& wish);

// The lens among the fields of its result; none where it is not whole.
std::optional<CameraModel> camera_from(const Fields& fields);

}  // namespace fude
