#include "rig/calibration/passport.h"

#include <algorithm>

namespace fude {

std::string passport_name(const CalibrationReport& report) {
  return report.procedure + (report.tool.empty() ? "" : " " + report.tool);
}

std::vector<RecordedCalibration> Passport::begin(const DeviceDescription& device) {
  devices_.insert(device.id);
  std::vector<RecordedCalibration> whole;
  std::erase_if(kept_, [&](const StoredCalibration& calibration) {
    const CalibrationReport& report = calibration.report;
    const bool here = !report.devices.empty() && std::ranges::all_of(report.devices, [&](const auto& id) {
      return devices_.contains(id);
    });
    if (here) whole.push_back({passport_name(report), toml_of(calibration)});
    return here;
  });
  return whole;
}

}  // namespace fude
