// What udev knows of one device, as values.
#pragma once

#include <libudev.h>

#include <cstdint>
#include <memory>
#include <string>

namespace fude {

using Udev = std::unique_ptr<udev, decltype(&udev_unref)>;
using UdevDevice = std::unique_ptr<udev_device, decltype(&udev_device_unref)>;
using UdevMonitor = std::unique_ptr<udev_monitor, decltype(&udev_monitor_unref)>;

// Empty for what libudev gives as null.
inline std::string text(const char* value) { return value != nullptr ? value : ""; }

// A file in the device's folder of sysfs; empty where it is not there.
std::string attribute(udev_device* device, const char* name);

// "056a" is 0x056a; 0 for what is no hexadecimal number of sixteen bits.
std::uint16_t hexadecimal(const std::string& digits);

}  // namespace fude
