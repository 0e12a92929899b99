// A tablet in a pretended /dev and /sys, for the unmodified libevdev and libudev: umockdev answers
// the ioctls from the description and carries the events. Needs umockdev-wrapper around the program.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "signal/device.h"
#include "signal/transfer.h"

typedef struct _UMockdevTestbed UMockdevTestbed;

namespace fude {

class MockTablet {
 public:
  // Appears as /dev/input/event<number>, announced to udev's monitors. `held` are keys that are down.
  MockTablet(UMockdevTestbed* testbed, const DeviceDescription& device, int number,
             const std::vector<std::uint16_t>& held = {});

  const std::filesystem::path& node() const { return node_; }
  const std::string& syspath() const { return syspath_; }
  void send(std::span<const EvdevEvent> events);
  void send_bytes(std::span<const std::byte> bytes);
  // The two halves of unplugging, which may come in either order. After hanging up, umockdev cannot add
  // another device.
  void hang_up();
  void announce_removal();

 private:
  UMockdevTestbed* testbed_;
  std::filesystem::path node_;
  std::string syspath_;
  int port_ = -1;
};

}  // namespace fude
