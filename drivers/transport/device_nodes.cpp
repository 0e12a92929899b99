#include "drivers/transport/device_nodes.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "drivers/transport/input_node.h"

namespace fude {
namespace {

struct Kind {
  NodeKind kind;
  const char* subsystem;
  const char* type;  // udev's DEVTYPE, or null
  const char* transport;
};
constexpr std::array<Kind, all_node_kinds.size()> kinds{{{NodeKind::input, "input", nullptr, "evdev"},
                                                         {NodeKind::hidraw, "hidraw", nullptr, "hidraw"},
                                                         {NodeKind::usb, "usb", "usb_device", "usb"},
                                                         {NodeKind::serial, "tty", nullptr, "serial"},
                                                         {NodeKind::video, "video4linux", nullptr, "v4l2"}}};

constexpr std::uint16_t bus_usb = 3;  // BUS_USB of linux/input.h

constexpr const char* no_udev = "udev does not answer; devices can only be found where it runs";

const Kind& row(NodeKind kind) { return kinds.at(static_cast<std::size_t>(kind)); }

void describe_usb(udev_device* usb, DeviceDescription& device) {
  device.bus = bus_usb;
  device.vendor = hexadecimal(attribute(usb, "idVendor"));
  device.product = hexadecimal(attribute(usb, "idProduct"));
  device.version = hexadecimal(attribute(usb, "bcdDevice"));
  device.serial = attribute(usb, "serial");
  const std::string maker = attribute(usb, "manufacturer");
  const std::string product = attribute(usb, "product");
  device.name = maker.empty() || product.empty() ? maker + product : maker + " " + product;
}

// HID_ID of a HID device: "0003:0000056A:00000350", bus, vendor and product.
void describe_hid(udev_device* hid, DeviceDescription& device) {
  const std::string id = text(udev_device_get_property_value(hid, "HID_ID"));
  if (id.size() == 22) {
    device.bus = hexadecimal(id.substr(0, 4));
    device.vendor = hexadecimal(id.substr(9, 4));
    device.product = hexadecimal(id.substr(18, 4));
  }
  device.name = text(udev_device_get_property_value(hid, "HID_NAME"));
  device.serial = text(udev_device_get_property_value(hid, "HID_UNIQ"));
}

// A camera's second node, for data about its pictures, has the camera's name. Where udev does not say what a
// node gives, it counts as a camera.
bool gives_no_pictures(udev_device* video) {
  const std::string gives = text(udev_device_get_property_value(video, "ID_V4L_CAPABILITIES"));
  return !gives.empty() && gives.find(":capture:") == std::string::npos;
}

std::optional<DeviceNode> known_node(udev_device* device, const Kind& kind) {
  const char* path = udev_device_get_devnode(device);
  if (path == nullptr) return std::nullopt;
  udev_device* usb = kind.kind == NodeKind::usb
                         ? device
                         : udev_device_get_parent_with_subsystem_devtype(device, "usb", "usb_device");
  udev_device* hid = udev_device_get_parent_with_subsystem_devtype(device, "hid", nullptr);
  if (kind.kind == NodeKind::serial && usb == nullptr) return std::nullopt;
  if (kind.kind == NodeKind::video && gives_no_pictures(device)) return std::nullopt;
  DeviceNode node;
  node.kind = kind.kind;
  node.path = path;
  if (usb != nullptr) node.syspath = text(udev_device_get_syspath(usb));
  if (kind.kind == NodeKind::input) {
    auto input = input_node(device);
    if (!input) return std::nullopt;
    node.description = std::move(input->description);
    node.access = input->access;
    node.rate_hz = input->rate_hz;
    return node;
  }
  DeviceDescription& description = node.description;
  if (usb != nullptr) describe_usb(usb, description);
  if (kind.kind == NodeKind::hidraw && hid != nullptr) describe_hid(hid, description);
  if (kind.kind == NodeKind::video) description.name = attribute(device, "name");
  description.transport = kind.transport;
  description.id = device_id(description);
  node.access = access(path, R_OK | W_OK) == 0;
  return node;
}

// The kernel also gives input devices nodes in older ways (mouse0, js0).
bool is_event_node(udev_device* device) { return text(udev_device_get_sysname(device)).starts_with("event"); }

const Kind* kind_of(udev_device* device) {
  const std::string subsystem = text(udev_device_get_subsystem(device));
  const std::string type = text(udev_device_get_devtype(device));
  for (const Kind& kind : kinds)
    if (subsystem == kind.subsystem && (kind.type == nullptr || type == kind.type))
      return kind.kind != NodeKind::input || is_event_node(device) ? &kind : nullptr;
  return nullptr;
}

}  // namespace

Result<std::vector<DeviceNode>> find_nodes(NodeKind kind) {
  const Udev context(udev_new(), udev_unref);
  if (!context) return failure(Fault::unsupported, no_udev);
  const std::unique_ptr<udev_enumerate, decltype(&udev_enumerate_unref)> list(
      udev_enumerate_new(context.get()), udev_enumerate_unref);
  if (!list || udev_enumerate_add_match_subsystem(list.get(), row(kind).subsystem) < 0 ||
      udev_enumerate_scan_devices(list.get()) < 0)
    return failure(Fault::unsupported, no_udev);
  std::vector<DeviceNode> nodes;
  udev_list_entry* entry = nullptr;
  udev_list_entry_foreach(entry, udev_enumerate_get_list_entry(list.get())) {
    const UdevDevice device(udev_device_new_from_syspath(context.get(), udev_list_entry_get_name(entry)),
                            udev_device_unref);
    if (!device || kind_of(device.get()) == nullptr) continue;
    // One that udev has not handled yet may lack its rights, and a USB device its interfaces; it is announced
    // again. An input device tells all there is before.
    if (kind != NodeKind::input && udev_device_get_is_initialized(device.get()) <= 0) continue;
    if (auto node = known_node(device.get(), row(kind))) nodes.push_back(std::move(*node));
  }
  std::sort(nodes.begin(), nodes.end(),
            [](const DeviceNode& a, const DeviceNode& b) { return a.path < b.path; });
  return nodes;
}

Result<std::unique_ptr<NodeMonitor>> NodeMonitor::open(std::span<const NodeKind> wanted) {
  Udev context(udev_new(), udev_unref);
  UdevMonitor monitor(context ? udev_monitor_new_from_netlink(context.get(), "udev") : nullptr,
                      udev_monitor_unref);
  bool good = monitor != nullptr;
  for (const NodeKind kind : wanted)
    good = good && udev_monitor_filter_add_match_subsystem_devtype(monitor.get(), row(kind).subsystem,
                                                                   row(kind).type) >= 0;
  if (!good || udev_monitor_enable_receiving(monitor.get()) < 0) return failure(Fault::unsupported, no_udev);
  return std::unique_ptr<NodeMonitor>(new NodeMonitor(std::move(context), std::move(monitor)));
}

NodeMonitor::NodeMonitor(Udev udev, UdevMonitor monitor)
    : udev_(std::move(udev)), monitor_(std::move(monitor)) {}

std::optional<NodeEvent> NodeMonitor::next(std::optional<Timestamp> deadline) {
  for (;;) {
    if (!waker_.wait(udev_monitor_get_fd(monitor_.get()), deadline).ready) return std::nullopt;
    const UdevDevice device(udev_monitor_receive_device(monitor_.get()), udev_device_unref);
    const Kind* kind = device ? kind_of(device.get()) : nullptr;
    if (kind == nullptr) continue;
    const std::string action = text(udev_device_get_action(device.get()));
    const char* path = udev_device_get_devnode(device.get());
    if (path == nullptr || (action != "add" && action != "remove")) continue;
    NodeEvent event{.plugged = action == "add", .node = {}};
    event.node.kind = kind->kind;
    event.node.path = path;
    if (event.plugged) {
      auto node = known_node(device.get(), *kind);
      if (!node) continue;
      event.node = std::move(*node);
    }
    return event;
  }
}

}  // namespace fude
