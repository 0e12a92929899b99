// Whether a calibration was made with what is here: the one rule for all that use earlier ones.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "calibration/report.h"

namespace fude {

// A table of numbers, or a device that tells no identity, may be any device.
bool may_be_any(std::string_view device);

struct CalibratedHere {
  std::vector<std::string> devices;  // identities
  std::string tool;                  // empty: of no account
  std::string reference;             // empty: the tracker's own frame
};

// What speaks against it, to be said after "was made": "with the device 0f44:ff20:A1, which is not here";
// empty where nothing does. Each of its devices must be here, unless either may be any. A calibration without
// a tool is that of a frame, whichever tool is seen in it.
std::string made_otherwise(const CalibrationReport& report, const CalibratedHere& here);

}  // namespace fude
