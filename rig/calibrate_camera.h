// A camera's calibration from the pictures of a session.
#pragma once

#include <string>

#include "capture/session.h"
#include "rig/calibrate_session.h"
#include "signal/result.h"
#include "vision/board.h"

namespace fude {

// `camera`: the name of its device; empty where there is only one. Pictures are named "picture 1", "picture
// 2" … in their order. Details of the report: each view with its rms, what was left out, the coverage.
// Errors: not_found where there are no pictures of that camera, usage for a board that cannot be. What the
// pictures do not bear is refused in the report.
Result<CalibrationOutcome> calibrate_camera(const Session& session, const std::string& camera,
                                            const Board& board, const OnProgress& on_progress);

}  // namespace fude
