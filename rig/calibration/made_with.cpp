#include "rig/calibration/made_with.h"

#include <algorithm>

namespace fude {

bool may_be_any(std::string_view device) { return device.empty() || device.starts_with("text:"); }

std::string made_otherwise(const CalibrationReport& report, const CalibratedHere& here) {
  if (std::ranges::none_of(here.devices, may_be_any))
    for (const std::string& device : report.devices)
      if (!may_be_any(device) && std::ranges::find(here.devices, device) == here.devices.end())
        return "with the device " + device + ", which is not here";
  if (!report.tool.empty() && !here.tool.empty() && report.tool != here.tool)
    return "with the tool " + report.tool + ", and this is " + here.tool;
  if (report.reference != here.reference)
    return report.reference.empty() ? "without --reference " + here.reference
                                    : "with --reference " + report.reference;
  return {};
}

}  // namespace fude
