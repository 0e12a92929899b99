#include "signal/device.h"

#include <array>
#include <cstdio>

namespace fude {

std::string device_id(const DeviceDescription& device) {
  std::array<char, 16> usb;
  std::snprintf(usb.data(), usb.size(), "%04x:%04x:", unsigned{device.vendor}, unsigned{device.product});
  return usb.data() + device.serial;
}

}  // namespace fude
