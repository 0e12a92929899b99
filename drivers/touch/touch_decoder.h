// From the events of a multi-touch surface to samples of its contacts.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "drivers/decoder.h"
#include "signal/device.h"

namespace fude {

// Contacts in slots (the kernel's protocol B) on a device that is no pen tablet.
bool is_touch_surface(const DeviceDescription& device);

// Reads evdev_frame transfers. At the end of each SYN_REPORT every contact that is down gives one sample, and
// one that has left gives one more, not `down`; all of a report have one time and sequence. `contact` is the
// kernel's tracking number. After SYN_DROPPED everything up to the next SYN_REPORT is stale; the samples
// of the report after it are marked. Positions may lie one range beyond the described area, never farther.
class TouchDecoder final : public Decoder {
 public:
  explicit TouchDecoder(const DeviceDescription& device);

  void decode(const Transfer& transfer, Decoded& out) override;

 private:
  struct Axes {
    std::optional<AxisRange> x, y, major, minor, orientation, pressure;
  };
  struct Slot {
    std::int32_t contact = -1;  // none
    std::int32_t x = 0, y = 0, major = 0, minor = 0, orientation = 0, pressure = 0;
    bool palm = false;
  };

  void decode_frame(std::span<const EvdevEvent> events, const Transfer& transfer, Decoded& out);
  void apply(const EvdevEvent& event);
  void lift(Slot& slot);
  void emit(const Transfer& transfer, Decoded& out);
  void begin_gap();
  TouchSample sample_of(const Slot& slot, bool down) const;

  Axes axes_;
  std::vector<Slot> slots_;
  std::size_t slot_ = 0;      // events are about this one; past the last: about none
  std::vector<Slot> lifted_;  // in this frame
  std::uint64_t sequence_ = 0;
  bool stale_ = false;
  bool after_gap_ = false;
};

}  // namespace fude
