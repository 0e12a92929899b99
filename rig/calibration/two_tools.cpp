#include "rig/calibration/two_tools.h"

#include <variant>

namespace fude {

TwoTools::TwoTools(const std::string& tool, const std::string& other)
    : tool_({.name = tool, .kinds = is_kind<PoseSample>, .but = other}),
      other_({.name = other, .what = "other tool", .option = "--other", .kinds = is_kind<PoseSample>}) {}

void TwoTools::begin(DeviceNumber device, const DeviceDescription& description) {
  tool_.begin(device, description);
  other_.begin(device, description);
}

Result<TwoTools::Heard> TwoTools::hear(DeviceNumber device, const Sample& sample) {
  const auto of_tool = tool_.takes(device, sample), of_other = other_.takes(device, sample);
  if (!of_tool) return tl::unexpected(of_tool.error());
  if (!of_other) return tl::unexpected(of_other.error());
  const auto* pose = std::get_if<PoseSample>(&sample);
  return Heard{*of_tool ? pose : nullptr, *of_other ? pose : nullptr};
}

Result<void> TwoTools::found() const {
  for (const StreamChoice* choice : {&tool_, &other_})
    if (const auto found = choice->found(); !found) return tl::unexpected(found.error());
  return {};
}

void TwoTools::sign(CalibrationReport& report) const {
  if (!tool_.chosen() || !other_.chosen()) return;
  report.devices = {tool_.chosen()->device.id};
  if (other_.chosen()->number != tool_.chosen()->number) report.devices.push_back(other_.chosen()->device.id);
  report.tool = tool_.chosen()->part;
}

void TwoTools::sign_tracker(CalibrationReport& report) const {
  if (!tool_.chosen() || !other_.chosen()) return;
  report.devices = {tool_.chosen()->device.id};
  if (other_.chosen()->number == tool_.chosen()->number) report.tool = tool_.chosen()->part;
}

}  // namespace fude
