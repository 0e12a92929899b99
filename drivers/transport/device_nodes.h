// The nodes of /dev through which devices are reached, as udev knows them, and their coming and going.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "drivers/transport/udev_device.h"
#include "drivers/transport/waker.h"
#include "signal/device.h"
#include "signal/result.h"

namespace fude {

enum class NodeKind : std::uint8_t {
  input,   // /dev/input/event5: a pen tablet or a touch surface; other input devices are passed over
  hidraw,  // /dev/hidraw0
  usb,     // /dev/bus/usb/001/004, a whole device
  serial,  // /dev/ttyACM0 or /dev/ttyUSB0: a port of a USB device
  video,   // /dev/video0: one that gives pictures; a camera's further node for their data is passed over
};

inline constexpr std::array all_node_kinds{NodeKind::input, NodeKind::hidraw, NodeKind::usb, NodeKind::serial,
                                           NodeKind::video};

struct DeviceNode {
  NodeKind kind = NodeKind::hidraw;
  std::filesystem::path path;
  // Of an input device as input_node() tells it. Else name, bus, vendor, product, version, serial, id and
  // transport, its `kind` is `other`; a serial port is known by the USB device that it belongs to, a camera
  // too where it has one.
  DeviceDescription description;
  std::string syspath;  // the same for all nodes of one USB device: its own; empty where there is none
  bool access = false;
  std::optional<double> rate_hz;  // how often USB asks an input device, where that is known
};

// Ordered by path. Errors: unsupported where udev does not run.
Result<std::vector<DeviceNode>> find_nodes(NodeKind kind);

struct NodeEvent {
  bool plugged = false;
  DeviceNode node;  // of one that went away: kind and path only
};

// Follows nodes of some kinds. What happened before open() is not seen: open, then find_nodes().
class NodeMonitor {
 public:
  static Result<std::unique_ptr<NodeMonitor>> open(std::span<const NodeKind> kinds);

  // Blocks until such a node comes or goes, wake() was called, or the deadline has passed; the latter two
  // give none.
  std::optional<NodeEvent> next(std::optional<Timestamp> deadline);
  void wake() { waker_.wake(); }

 private:
  NodeMonitor(Udev udev, UdevMonitor monitor);

  Udev udev_;
  UdevMonitor monitor_;
  Waker waker_;
};

}  // namespace fude
