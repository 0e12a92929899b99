// What udev and the kernel tell of an input device.
#pragma once

#include <filesystem>
#include <optional>

#include "drivers/transport/udev_device.h"
#include "signal/device.h"

namespace fude {

struct InputNode {
  // Identified. Without access it holds what sysfs tells: name, identity, keys and axes, no ranges.
  DeviceDescription description;
  bool access = false;
  std::optional<double> rate_hz;  // how often USB asks the device; none where it is not on USB
};

// Of a /dev/input/event…; none for what is no pen tablet and no touch surface.
std::optional<InputNode> input_node(udev_device* event);

}  // namespace fude
