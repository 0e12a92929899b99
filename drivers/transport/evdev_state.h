// Where a device stands after some frames: keys, axes, contacts. Evdev tells only what changes, so whoever
// begins in the middle must be told this first.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <vector>

#include "signal/device.h"
#include "signal/transfer.h"

namespace fude {

class EvdevState {
 public:
  // As the device was described: no key down, no contact.
  explicit EvdevState(const DeviceDescription& device);

  // A frame as it came; one with SYN_DROPPED too, whose events were the device's all the same.
  void apply(std::span<const EvdevEvent> events);

  // Back to the description: the device went away.
  void reset();

  // One frame that brings a device which stands as described to here, contacts slot by slot; empty where
  // there is nothing to tell.
  std::vector<EvdevEvent> frame() const;

 private:
  using Axes = std::map<std::uint16_t, std::int32_t>;

  Axes described_;
  Axes axes_;
  std::map<std::int32_t, Axes> slots_;  // by slot: what ABS_MT_* said last
  std::int32_t slot_ = 0;
  std::set<std::uint16_t> down_;
  std::int32_t tool_serial_ = 0;
};

}  // namespace fude
