// A calibration from a recorded session: where capture and calibration meet.
#pragma once

#include "capture/session.h"
#include "rig/calibration/calibrator.h"
#include "signal/result.h"

namespace fude {

// Lets the calibrator hear the session in its order, and signs the report with date and session. Errors: its
// own.
Result<CalibrationOutcome> calibrate_session(Calibrator& calibrator, const Session& session,
                                             const OnProgress& on_progress = {});

// finish() with the date.
Result<CalibrationOutcome> finish_today(Calibrator& calibrator);

}  // namespace fude
