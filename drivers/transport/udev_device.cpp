#include "drivers/transport/udev_device.h"

#include <charconv>

namespace fude {

std::string attribute(udev_device* device, const char* name) {
  return text(udev_device_get_sysattr_value(device, name));
}

std::uint16_t hexadecimal(const std::string& digits) {
  std::uint16_t value = 0;
  std::from_chars(digits.data(), digits.data() + digits.size(), value, 16);
  return value;
}

}  // namespace fude
