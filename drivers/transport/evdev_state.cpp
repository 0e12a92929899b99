#include "drivers/transport/evdev_state.h"

#include <linux/input-event-codes.h>

namespace fude {
namespace {

// A tablet's own keys and rings speak under this serial, on older kernels through the pen's device.
constexpr std::int32_t pad_serial = -1;

// Said once for each contact.
bool of_contact(std::uint16_t code) { return code > ABS_MT_SLOT && code <= ABS_MT_TOOL_Y; }

}  // namespace

EvdevState::EvdevState(const DeviceDescription& device) {
  for (const AxisRange& axis : device.axes)
    if (!of_contact(axis.code)) described_[axis.code] = axis.value;
  reset();
}

void EvdevState::reset() {
  axes_ = described_;
  const auto slot = described_.find(ABS_MT_SLOT);
  slot_ = slot == described_.end() ? 0 : slot->second;
  slots_.clear();
  down_.clear();
  tool_serial_ = 0;
}

void EvdevState::apply(std::span<const EvdevEvent> events) {
  for (const EvdevEvent& event : events) {
    if (event.type == EV_KEY) {
      if (event.value == 0)
        down_.erase(event.code);
      else
        down_.insert(event.code);
    } else if (event.type == EV_MSC && event.code == MSC_SERIAL && event.value != pad_serial) {
      tool_serial_ = event.value;
    } else if (event.type == EV_ABS && of_contact(event.code)) {
      slots_[slot_][event.code] = event.value;
    } else if (event.type == EV_ABS) {
      if (event.code == ABS_MT_SLOT) slot_ = event.value;
      axes_[event.code] = event.value;
    }
  }
}

std::vector<EvdevEvent> EvdevState::frame() const {
  std::vector<EvdevEvent> events;
  for (const std::uint16_t key : down_) events.push_back({EV_KEY, key, 1});
  for (const auto& [code, value] : axes_) {
    const auto described = described_.find(code);
    if (code != ABS_MT_SLOT && (described == described_.end() || described->second != value))
      events.push_back({EV_ABS, code, value});
  }
  const auto put_slot = [&](std::int32_t slot) { events.push_back({EV_ABS, ABS_MT_SLOT, slot}); };
  for (const auto& [slot, axes] : slots_) {
    const auto contact = axes.find(ABS_MT_TRACKING_ID);
    if (contact == axes.end() || contact->second < 0) continue;
    put_slot(slot);
    for (const auto& [code, value] : axes) events.push_back({EV_ABS, code, value});
  }
  const auto described = described_.find(ABS_MT_SLOT);
  if (described != described_.end() && (slot_ != described->second || !slots_.empty())) put_slot(slot_);
  if (events.empty()) return events;
  if (tool_serial_ != 0) events.push_back({EV_MSC, MSC_SERIAL, tool_serial_});
  events.push_back({EV_SYN, SYN_REPORT, 0});
  return events;
}

}  // namespace fude
