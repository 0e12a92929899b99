// Everything that is plugged in here and that fude has a driver for.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "drivers/families.h"
#include "drivers/transport/device_nodes.h"
#include "drivers/transport/v4l2_source.h"
#include "signal/byte_source.h"
#include "signal/device.h"
#include "signal/result.h"

namespace fude {

struct AttachedDevice {
  std::filesystem::path node;
  DeviceDescription description;  // with its kind
  const FamilyRow* family = nullptr;
  bool access = false;
  std::optional<double> rate_hz;  // how often USB asks the device, where that is known
};

// What udev tells, as a device that a driver here reads; none where there is no driver.
std::optional<AttachedDevice> attached(const DeviceNode& node);

// Ordered by node. Errors: unsupported where udev does not run.
Result<std::vector<AttachedDevice>> attached_devices();

// Whether there is anything to read. Errors: not_found where nothing is plugged in, no_access where none may
// be read, each with what to do.
Result<void> something_attached();

// A device's driver as the rig runs it: a Falcon's has the user's firmware, and does not poll, for a haptic
// loop speaks.
std::unique_ptr<Decoder> open_driver(const FamilyRow& family, const DeviceDescription& device);

// `decoder`: the device's own; a camera's is told which source it watches. `camera` is what a camera is asked
// for; one that has not the format is opened in one that it has. Errors: those of the transport's open().
Result<std::unique_ptr<ByteSource>> open_source(const AttachedDevice& device, Decoder& decoder,
                                                const CameraSettings& camera);

}  // namespace fude
