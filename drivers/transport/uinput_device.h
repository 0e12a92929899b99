// An input device that the kernel makes at our word, for every program to read.
#pragma once

#include <filesystem>
#include <memory>
#include <span>

#include "drivers/transport/file_descriptor.h"
#include "signal/device.h"
#include "signal/result.h"
#include "signal/transfer.h"

namespace fude {

class UinputDevice {
 public:
  // With the name, bus, vendor, product, version, keys, properties and axes of the description, which stand
  // where it says. The kernel lets no serial be given, and the fuzz is left out: what is sent was smoothed
  // already. `also` names, by type and code, what the device will send that no description holds (EV_MSC,
  // EV_REL …). Errors, with the command that mends it: not_found where there is no /dev/uinput, no_access;
  // unsupported for a description that the kernel refuses.
  static Result<std::unique_ptr<UinputDevice>> create(const DeviceDescription& device,
                                                      std::span<const EvdevEvent> also = {});

  // The kernel stamps the events and keeps back those that change nothing. Errors: device_gone.
  Result<void> send(std::span<const EvdevEvent> events);

  // /dev/input/event5; empty where sysfs does not say.
  std::filesystem::path node() const;

 private:
  explicit UinputDevice(FileDescriptor file) : file_(std::move(file)) {}

  FileDescriptor file_;  // closing it unplugs the device
};

}  // namespace fude
