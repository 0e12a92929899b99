// What a calibration found, for machines: the fields of docs/calibration.md.
#pragma once

#include <string>

#include "rig/calibration/calibrator.h"

namespace fude {

// Ends in a line break. Bytes that are no text are replaced.
std::string json_of(const CalibrationOutcome& outcome);

}  // namespace fude
