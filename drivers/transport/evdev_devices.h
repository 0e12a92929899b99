// The input devices that udev knows, and their coming and going.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "drivers/transport/udev_device.h"
#include "drivers/transport/waker.h"
#include "signal/device.h"
#include "signal/result.h"

namespace fude {

struct FoundDevice {
  std::filesystem::path node;  // /dev/input/event5
  // Identified. Without access it holds what sysfs tells: name, identity, keys and axes, no ranges.
  DeviceDescription description;
  bool access = false;
  std::optional<double> rate_hz;  // how often USB asks the device; none where it is not on USB
};

// The pen tablets and touch surfaces that are plugged in, ordered by node. Errors: unsupported where udev
// does not run.
Result<std::vector<FoundDevice>> find_input_devices();

struct PlugEvent {
  bool plugged = false;
  std::filesystem::path node;
  std::optional<FoundDevice> device;  // when a pen tablet or a touch surface was plugged in
};

// Follows input devices. Events that happened before open() are not seen: open, then enumerate.
class PlugMonitor {
 public:
  static Result<std::unique_ptr<PlugMonitor>> open();

  // Blocks until an input device comes or goes, wake() was called, or the deadline has passed; the
  // latter two give none.
  std::optional<PlugEvent> next(std::optional<Timestamp> deadline);
  void wake() { waker_.wake(); }

 private:
  PlugMonitor(Udev udev, UdevMonitor monitor);

  Udev udev_;
  UdevMonitor monitor_;
  Waker waker_;
};

}  // namespace fude
