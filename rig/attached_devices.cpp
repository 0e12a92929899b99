#include "rig/attached_devices.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "drivers/camera/camera_decoder.h"
#include "drivers/falcon/falcon_decoder.h"
#include "drivers/transport/device_node.h"
#include "drivers/transport/evdev_source.h"
#include "drivers/transport/hidraw_source.h"
#include "drivers/transport/serial_source.h"
#include "drivers/transport/usb_hid_source.h"
#include "drivers/transport/usb_source.h"
#include "rig/falcon_firmware.h"

namespace fude {
namespace {

// USB's own serial ports ignore the speed.
constexpr int baud = 115200;

template <class Source>
Result<std::unique_ptr<ByteSource>> as_bytes(Result<std::unique_ptr<Source>> source) {
  if (!source) return tl::unexpected(source.error());
  return std::unique_ptr<ByteSource>(std::move(*source));
}

Result<std::unique_ptr<ByteSource>> open_camera(const std::filesystem::path& node, CameraDecoder& decoder,
                                                CameraSettings wanted) {
  auto source = V4l2Source::open(node, wanted);
  if (!source && source.error().fault == Fault::unsupported && wanted.format) {
    wanted.format.reset();
    source = V4l2Source::open(node, wanted);
  }
  if (source) decoder.watch(source->get());
  return as_bytes(std::move(source));
}

}  // namespace

std::optional<AttachedDevice> attached(const DeviceNode& node) {
  const FamilyRow* family = find_family(node.description);
  if (family == nullptr) return std::nullopt;
  AttachedDevice device{node.path, node.description, family, node.access, node.rate_hz};
  device.description.kind = family->kind;
  if (node.kind == NodeKind::input) return device;
  // Every driver here tells ticks in microseconds, its counter's turns undone.
  device.description.clock = DeviceClock{.nominal_tick = 1e-6};
  if (device.description.name.empty()) device.description.name = family->model;
  return device;
}

Result<std::vector<AttachedDevice>> attached_devices() {
  std::vector<AttachedDevice> devices;
  for (const NodeKind kind : all_node_kinds) {
    const auto nodes = find_nodes(kind);
    if (!nodes) return tl::unexpected(nodes.error());
    for (const DeviceNode& node : *nodes)
      if (auto device = attached(node)) devices.push_back(std::move(*device));
  }
  std::ranges::sort(devices, {}, &AttachedDevice::node);
  return devices;
}

Result<void> something_attached() {
  const auto found = attached_devices();
  if (!found) return tl::unexpected(found.error());
  if (found->empty())
    return failure(Fault::not_found,
                   "no device that fude knows is plugged in; plug one in, or name one with --add");
  if (std::ranges::none_of(*found, &AttachedDevice::access))
    return failure(Fault::no_access, access_advice(found->front().node));
  return {};
}

std::unique_ptr<Decoder> open_driver(const FamilyRow& family, const DeviceDescription& device) {
  if (family.family == Family::falcon) return std::make_unique<FalconDecoder>(falcon_firmware(), false);
  return open_decoder(family, device);
}

Result<std::unique_ptr<ByteSource>> open_source(const AttachedDevice& device, Decoder& decoder,
                                                const CameraSettings& camera) {
  const std::string_view transport = device.description.transport;
  if (transport == "evdev") return as_bytes(EvdevSource::open(device.node));
  if (transport == "v4l2") return open_camera(device.node, dynamic_cast<CameraDecoder&>(decoder), camera);
  if (transport == "hidraw") return as_bytes(HidrawSource::open(device.node));
  // The kernel's HID driver leaves the glove alone.
  if (transport == "usb" && device.family->family == Family::p5glove)
    return as_bytes(UsbHidSource::open(device.node, 0, true));
  if (transport == "usb") return as_bytes(UsbSource::open(device.node, {0}));
  if (transport == "serial") return as_bytes(SerialSource::open(device.node, baud));
  return failure(Fault::unsupported,
                 device.node.string() + " is reached in a way that this build does not have");
}

}  // namespace fude
