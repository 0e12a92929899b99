#include "drivers/touch/touch_decoder.h"

#include <linux/input-event-codes.h>
#include <linux/input.h>

#include <algorithm>
#include <numbers>
#include <utility>

#include "drivers/tablet/identify.h"
#include "drivers/tablet/pen_axes.h"

namespace fude {
namespace {

constexpr std::int32_t most_slots = 64;

std::optional<AxisRange> usable_axis(const DeviceDescription& device, std::uint16_t code) {
  const AxisRange* axis = find_axis(device, code);
  return usable(axis) ? std::optional(*axis) : std::nullopt;
}

double held(const std::optional<AxisRange>& axis, std::int32_t value) {
  if (!axis) return value;
  const double range = static_cast<double>(axis->maximum) - axis->minimum;
  return std::clamp(static_cast<double>(value), axis->minimum - range, axis->maximum + range);
}

}  // namespace

bool is_touch_surface(const DeviceDescription& device) {
  return find_axis(device, ABS_MT_SLOT) != nullptr && usable(find_axis(device, ABS_MT_POSITION_X)) &&
         usable(find_axis(device, ABS_MT_POSITION_Y)) && !is_pen_tablet(device);
}

TouchDecoder::TouchDecoder(const DeviceDescription& device)
    : axes_{.x = usable_axis(device, ABS_MT_POSITION_X),
            .y = usable_axis(device, ABS_MT_POSITION_Y),
            .major = usable_axis(device, ABS_MT_TOUCH_MAJOR),
            .minor = usable_axis(device, ABS_MT_TOUCH_MINOR),
            .orientation = usable_axis(device, ABS_MT_ORIENTATION),
            .pressure = usable_axis(device, ABS_MT_PRESSURE)} {
  const AxisRange* slot = find_axis(device, ABS_MT_SLOT);
  const std::int32_t last = slot == nullptr ? 0 : std::clamp(slot->maximum, 0, most_slots - 1);
  slots_.resize(static_cast<std::size_t>(last) + 1);
  if (slot != nullptr && slot->value >= 0) slot_ = static_cast<std::size_t>(slot->value);
}

void TouchDecoder::decode(const Transfer& transfer, Decoded& out) {
  if (transfer.direction != Direction::from_device) return;
  if (transfer.kind == TransferKind::unplugged || transfer.kind == TransferKind::suspended) {
    for (Slot& slot : slots_) lift(slot);
    if (!lifted_.empty()) emit(transfer, out);
    std::fill(slots_.begin(), slots_.end(), Slot{});
    slot_ = 0;
    stale_ = false;
    begin_gap();
    return;
  }
  if (transfer.kind != TransferKind::evdev_frame) return;
  const auto events = unpack_events(transfer.payload);
  if (!events) {
    ++counts_.malformed;
    ++counts_.lost;
    stale_ = false;
    return begin_gap();
  }
  decode_frame(*events, transfer, out);
}

void TouchDecoder::decode_frame(std::span<const EvdevEvent> events, const Transfer& transfer, Decoded& out) {
  const std::vector<Slot> before = slots_;
  const std::size_t slot_before = slot_;
  for (const EvdevEvent& event : events) {
    if (event.type == EV_SYN && event.code == SYN_DROPPED) {
      slots_ = before;
      slot_ = slot_before;
      lifted_.clear();
      if (!stale_) begin_gap();
      stale_ = true;
    } else if (event.type == EV_SYN && event.code == SYN_REPORT) {
      if (std::exchange(stale_, false)) {
        ++counts_.lost;
        return;
      }
      ++counts_.reports;
      emit(transfer, out);
    } else if (!stale_ && event.type == EV_ABS) {
      apply(event);
    }
  }
}

void TouchDecoder::apply(const EvdevEvent& event) {
  if (event.code == ABS_MT_SLOT) {
    slot_ = event.value < 0 ? slots_.size() : static_cast<std::size_t>(event.value);
    return;
  }
  if (slot_ >= slots_.size()) return;
  Slot& slot = slots_[slot_];
  switch (event.code) {
    case ABS_MT_TRACKING_ID:
      if (event.value == slot.contact) return;
      lift(slot);
      slot.contact = std::max(event.value, -1);
      slot.palm = false;
      return;
    case ABS_MT_POSITION_X:
      slot.x = event.value;
      return;
    case ABS_MT_POSITION_Y:
      slot.y = event.value;
      return;
    case ABS_MT_TOUCH_MAJOR:
      slot.major = event.value;
      return;
    case ABS_MT_TOUCH_MINOR:
      slot.minor = event.value;
      return;
    case ABS_MT_ORIENTATION:
      slot.orientation = event.value;
      return;
    case ABS_MT_PRESSURE:
      slot.pressure = event.value;
      return;
    case ABS_MT_TOOL_TYPE:
      slot.palm = event.value == MT_TOOL_PALM;
      return;
    default:
      return;
  }
}

void TouchDecoder::lift(Slot& slot) {
  if (slot.contact < 0) return;
  lifted_.push_back(slot);
  slot.contact = -1;
}

void TouchDecoder::begin_gap() {
  ++sequence_;
  after_gap_ = true;
  lifted_.clear();
}

TouchSample TouchDecoder::sample_of(const Slot& slot, bool down) const {
  TouchSample sample;
  sample.contact = slot.contact;
  sample.down = down;
  sample.x_counts = held(axes_.x, slot.x);
  sample.y_counts = held(axes_.y, slot.y);
  if (axes_.major) sample.major_counts = std::max(slot.major, 0);
  if (axes_.minor) sample.minor_counts = std::max(slot.minor, 0);
  // The range's end is a quarter turn, clockwise from the direction away from the painter.
  if (axes_.orientation && axes_.orientation->maximum > 0) {
    const double quarters = static_cast<double>(slot.orientation) / axes_.orientation->maximum;
    sample.orientation = Radians(std::clamp(quarters, -2.0, 2.0) * (std::numbers::pi / 2));
  }
  if (axes_.pressure) sample.pressure = share_of_range(*axes_.pressure, slot.pressure);
  sample.palm = slot.palm;
  return sample;
}

void TouchDecoder::emit(const Transfer& transfer, Decoded& out) {
  const SampleTime time{transfer.time, transfer.stamped_by, sequence_++, std::nullopt};
  const auto add = [&](const Slot& slot, bool down) {
    TouchSample sample = sample_of(slot, down);
    sample.time = time;
    sample.after_gap = after_gap_;
    ++counts_.samples;
    out.samples.emplace_back(sample);
  };
  const bool any = !lifted_.empty() || std::any_of(slots_.begin(), slots_.end(),
                                                   [](const Slot& slot) { return slot.contact >= 0; });
  for (const Slot& slot : lifted_) add(slot, false);
  for (const Slot& slot : slots_)
    if (slot.contact >= 0) add(slot, true);
  lifted_.clear();
  if (any) after_gap_ = false;
}

}  // namespace fude
