// The passport of a session: of the calibrations that are kept, those of the devices that it records.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "capture/session.h"
#include "rig/calibration/calibration_file.h"
#include "signal/device.h"

namespace fude {

class Passport {
 public:
  explicit Passport(std::vector<StoredCalibration> kept) : kept_(std::move(kept)) {}

  // The next device of the session. Gives the calibrations all of whose devices are there now, each once.
  std::vector<RecordedCalibration> begin(const DeviceDescription& device);

 private:
  std::vector<StoredCalibration> kept_;  // that wait for a device
  std::set<std::string> devices_;
};

// "pivot brush": what a session calls it.
std::string passport_name(const CalibrationReport& report);

}  // namespace fude
