#include "drivers/transport/evdev_devices.h"

#include <linux/input.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <string_view>
#include <utility>

#include "drivers/tablet/identify.h"
#include "drivers/touch/touch_decoder.h"
#include "drivers/transport/evdev_source.h"
#include "drivers/transport/udev_device.h"

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

std::optional<FoundDevice> known_device(udev_device* event) {
  const char* node = udev_device_get_devnode(event);
  udev_device* input = udev_device_get_parent_with_subsystem_devtype(event, "input", nullptr);
  if (node == nullptr || input == nullptr) return std::nullopt;
  FoundDevice found;
  found.node = node;
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

bool is_event_node(udev_device* device) {
  return std::string_view(text(udev_device_get_sysname(device))).starts_with("event");
}

constexpr const char* no_udev = "udev does not answer; devices can only be found where it runs";

}  // namespace

Result<std::vector<FoundDevice>> find_input_devices() {
  const std::unique_ptr<udev, decltype(&udev_unref)> context(udev_new(), udev_unref);
  if (!context) return failure(Fault::unsupported, no_udev);
  const std::unique_ptr<udev_enumerate, decltype(&udev_enumerate_unref)> list(
      udev_enumerate_new(context.get()), udev_enumerate_unref);
  if (!list || udev_enumerate_add_match_subsystem(list.get(), "input") < 0 ||
      udev_enumerate_scan_devices(list.get()) < 0)
    return failure(Fault::unsupported, no_udev);

  std::vector<FoundDevice> devices;
  udev_list_entry* entry = nullptr;
  udev_list_entry_foreach(entry, udev_enumerate_get_list_entry(list.get())) {
    const UdevDevice device(udev_device_new_from_syspath(context.get(), udev_list_entry_get_name(entry)),
                            udev_device_unref);
    if (!device || !is_event_node(device.get())) continue;
    if (auto known = known_device(device.get())) devices.push_back(std::move(*known));
  }
  std::sort(devices.begin(), devices.end(),
            [](const FoundDevice& a, const FoundDevice& b) { return a.node < b.node; });
  return devices;
}

Result<std::unique_ptr<PlugMonitor>> PlugMonitor::open() {
  Udev context(udev_new(), udev_unref);
  UdevMonitor monitor(context ? udev_monitor_new_from_netlink(context.get(), "udev") : nullptr,
                      udev_monitor_unref);
  if (!monitor || udev_monitor_filter_add_match_subsystem_devtype(monitor.get(), "input", nullptr) < 0 ||
      udev_monitor_enable_receiving(monitor.get()) < 0)
    return failure(Fault::unsupported, no_udev);
  return std::unique_ptr<PlugMonitor>(new PlugMonitor(std::move(context), std::move(monitor)));
}

PlugMonitor::PlugMonitor(Udev udev, UdevMonitor monitor)
    : udev_(std::move(udev)), monitor_(std::move(monitor)) {}

std::optional<PlugEvent> PlugMonitor::next(std::optional<Timestamp> deadline) {
  for (;;) {
    if (!waker_.wait(udev_monitor_get_fd(monitor_.get()), deadline).ready) return std::nullopt;
    const UdevDevice device(udev_monitor_receive_device(monitor_.get()), udev_device_unref);
    if (!device || !is_event_node(device.get())) continue;
    const std::string action = text(udev_device_get_action(device.get()));
    const char* node = udev_device_get_devnode(device.get());
    if (node == nullptr || (action != "add" && action != "remove")) continue;
    PlugEvent event{.plugged = action == "add", .node = node, .device = std::nullopt};
    if (event.plugged) event.device = known_device(device.get());
    return event;
  }
}

}  // namespace fude
