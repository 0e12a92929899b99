#include "drivers/transport/input_node.h"

#include <linux/input.h>

#include <charconv>
#include <cstdint>
#include <string_view>
#include <utility>

#include "drivers/tablet/identify.h"
#include "drivers/touch/touch_decoder.h"
#include "drivers/transport/evdev_source.h"

namespace fude {
namespace {

// "1f 0 1000003": words of 64 bits in hexadecimal, the highest first.
std::vector<std::uint16_t> set_bits(std::string_view words) {
  std::vector<std::uint16_t> bits;
  for (unsigned base = 0; !words.empty(); base += 64) {
    const std::size_t blank = words.find_last_of(' ');
    const std::string_view word = words.substr(blank == std::string_view::npos ? 0 : blank + 1);
    std::uint64_t mask = 0;
    std::from_chars(word.data(), word.data() + word.size(), mask, 16);
    for (unsigned bit = 0; bit < 64; ++bit)
      if (mask >> bit & 1) bits.push_back(static_cast<std::uint16_t>(base + bit));
    words = words.substr(0, blank == std::string_view::npos ? 0 : blank);
  }
  return bits;
}

// What may be read without opening the node.
DeviceDescription described_by_sysfs(udev_device* input) {
  DeviceDescription device;
  device.transport = "evdev";
  device.name = attribute(input, "name");
  device.serial = attribute(input, "uniq");
  device.bus = hexadecimal(attribute(input, "id/bustype"));
  device.vendor = hexadecimal(attribute(input, "id/vendor"));
  device.product = hexadecimal(attribute(input, "id/product"));
  device.version = hexadecimal(attribute(input, "id/version"));
  device.keys = set_bits(attribute(input, "capabilities/key"));
  for (std::uint16_t code : set_bits(attribute(input, "capabilities/abs"))) {
    AxisRange axis;
    axis.code = code;
    device.axes.push_back(axis);
  }
  return device;
}

// "4ms" or "125us" of the interrupt endpoint that brings the reports.
std::optional<double> polling_rate(udev_device* device) {
  udev_device* interface = udev_device_get_parent_with_subsystem_devtype(device, "usb", "usb_interface");
  if (interface == nullptr) return std::nullopt;
  for (const char* endpoint : {"ep_81", "ep_82", "ep_83", "ep_84"}) {
    const std::string interval = attribute(interface, (std::string(endpoint) + "/interval").c_str());
    double period = 0;
    const auto [end, error] = std::from_chars(interval.data(), interval.data() + interval.size(), period);
    if (error != std::errc{} || period <= 0) continue;
    return (*end == 'u' ? 1e6 : 1e3) / period;
  }
  return std::nullopt;
}

}  // namespace

std::optional<InputNode> input_node(udev_device* event) {
  const char* node = udev_device_get_devnode(event);
  udev_device* input = udev_device_get_parent_with_subsystem_devtype(event, "input", nullptr);
  if (node == nullptr || input == nullptr) return std::nullopt;
  InputNode found;
  if (const auto source = EvdevSource::open(node)) {
    found.access = true;
    found.description = (*source)->description();
  } else if (source.error().fault == Fault::no_access) {
    found.description = described_by_sysfs(input);
  } else {
    return std::nullopt;
  }
  if (!is_pen_tablet(found.description) && !is_touch_surface(found.description)) return std::nullopt;
  if (found.description.serial.empty())
    found.description.serial = text(udev_device_get_property_value(event, "ID_SERIAL_SHORT"));
  found.description.id = device_id(found.description);
  found.description = identified(std::move(found.description));
  found.rate_hz = polling_rate(event);
  return found;
}

}  // namespace fude
