#include "drivers/tablet/pen_decoder.h"

#include <linux/input-event-codes.h>

#include <algorithm>
#include <vector>

#include "drivers/tablet/pen_axes.h"

namespace fude {
namespace {

constexpr std::array<PenTool, 5> tools_by_key{PenTool::pen, PenTool::rubber, PenTool::brush, PenTool::pencil,
                                              PenTool::airbrush};
constexpr std::array<std::uint16_t, 3> button_keys{BTN_STYLUS, BTN_STYLUS2, BTN_STYLUS3};

// The tablet's own keys and rings speak under this serial, on older kernels through the same device.
constexpr std::int32_t pad_serial = -1;

std::optional<AxisRange> usable_axis(const DeviceDescription& device, std::uint16_t code) {
  const AxisRange* axis = find_axis(device, code);
  return usable(axis) ? std::optional(*axis) : std::nullopt;
}

// Holds a value within the described range, widened on both sides by `beyond` ranges.
std::int32_t held(const AxisRange& axis, std::int32_t value, int beyond, std::uint64_t& out_of_range) {
  const std::int64_t range = std::int64_t{axis.maximum} - axis.minimum;
  if (value < axis.minimum || value > axis.maximum) ++out_of_range;
  const std::int64_t low = std::max<std::int64_t>(axis.minimum - beyond * range, INT32_MIN);
  const std::int64_t high = std::min<std::int64_t>(axis.maximum + beyond * range, INT32_MAX);
  return static_cast<std::int32_t>(std::clamp<std::int64_t>(value, low, high));
}

}  // namespace

PenDecoder::PenDecoder(const DeviceDescription& device)
    : axes_{.x = usable_axis(device, ABS_X),
            .y = usable_axis(device, ABS_Y),
            .pressure = usable_axis(device, ABS_PRESSURE),
            .distance = usable_axis(device, ABS_DISTANCE),
            .tilt_x = usable_axis(device, ABS_TILT_X),
            .tilt_y = usable_axis(device, ABS_TILT_Y),
            .rotation = usable_axis(device, ABS_Z),
            .wheel = usable_axis(device, ABS_WHEEL)},
      has_tool_keys_(std::any_of(pen_tool_keys.begin(), pen_tool_keys.end(),
                                 [&](std::uint16_t key) { return has_key(device, key); })),
      has_touch_key_(has_key(device, BTN_TOUCH)) {
  for (const AxisRange& axis : device.axes) set_axis(axis.code, axis.value);
  counts_ = {};
  initial_ = state_;
}

std::optional<PenSample> PenDecoder::decode(const Transfer& transfer) {
  if (transfer.direction != Direction::from_device) return std::nullopt;
  if (transfer.kind == TransferKind::plugged) return std::nullopt;
  if (transfer.kind == TransferKind::unplugged || transfer.kind == TransferKind::suspended) {
    const bool was_present = was_present_;
    if (transfer.kind == TransferKind::unplugged)
      state_ = initial_;
    else
      let_go_of_keys();
    begin_gap();
    stale_ = false;
    if (!was_present) return std::nullopt;
    return leaving(transfer);
  }
  const auto events = unpack_events(transfer.payload);
  if (!events) {
    ++counts_.malformed;
    ++counts_.lost;
    begin_gap();
    stale_ = false;
    return std::nullopt;
  }
  return decode_frame(*events, transfer);
}

// As the kernel does when it is suspended. An axis it tells again only when that has moved.
void PenDecoder::let_go_of_keys() {
  state_.tools = {};
  state_.touching = false;
  state_.buttons = 0;
}

std::optional<PenSample> PenDecoder::decode_frame(std::span<const EvdevEvent> events,
                                                  const Transfer& transfer) {
  const bool from_pad = std::any_of(events.begin(), events.end(), [](const EvdevEvent& e) {
    return e.type == EV_MSC && e.code == MSC_SERIAL && e.value == pad_serial;
  });
  const State before = state_;
  bool reported = false;
  for (const EvdevEvent& event : events) {
    if (event.type == EV_SYN && event.code == SYN_DROPPED) {
      state_ = before;
      if (!stale_) begin_gap();
      stale_ = true;
    } else if (event.type == EV_SYN && event.code == SYN_REPORT) {
      ++counts_.frames;
      reported = true;
      if (stale_) {
        ++counts_.lost;
        stale_ = false;
        return std::nullopt;
      }
    } else if (!stale_) {
      apply(event, from_pad);
    }
  }
  if (!reported) return std::nullopt;
  if (tool() != PenTool::none) return present(transfer);
  if (was_present_) return leaving(transfer);
  return std::nullopt;
}

void PenDecoder::apply(const EvdevEvent& event, bool from_pad) {
  if (event.type == EV_KEY) {
    if (event.value != 0 && event.value != 1) return;  // 2 is a key's repetition
    const bool down = event.value == 1;
    for (std::size_t i = 0; i < pen_tool_keys.size(); ++i)
      if (event.code == pen_tool_keys[i]) state_.tools[i] = down;
    for (std::size_t i = 0; i < button_keys.size(); ++i)
      if (event.code == button_keys[i])
        state_.buttons = down ? state_.buttons | 1u << i : state_.buttons & ~(1u << i);
    if (event.code == BTN_TOUCH) state_.touching = down;
  } else if (event.type == EV_ABS && !from_pad) {
    set_axis(event.code, event.value);
  } else if (event.type == EV_MSC && event.code == MSC_SERIAL && !from_pad) {
    state_.tool_serial = static_cast<std::uint32_t>(event.value);
  }
}

void PenDecoder::set_axis(std::uint16_t code, std::int32_t value) {
  const auto set = [&](const std::optional<AxisRange>& axis, std::int32_t& counts, int beyond) {
    if (axis) counts = held(*axis, value, beyond, counts_.out_of_range);
  };
  switch (code) {
    case ABS_X:
      return set(axes_.x, state_.x, 1);
    case ABS_Y:
      return set(axes_.y, state_.y, 1);
    case ABS_PRESSURE:
      return set(axes_.pressure, state_.pressure, 0);
    case ABS_DISTANCE:
      return set(axes_.distance, state_.distance, 0);
    case ABS_TILT_X:
      return set(axes_.tilt_x, state_.tilt_x, 0);
    case ABS_TILT_Y:
      return set(axes_.tilt_y, state_.tilt_y, 0);
    case ABS_Z:
      return set(axes_.rotation, state_.rotation, 0);
    case ABS_WHEEL:
      return set(axes_.wheel, state_.wheel, 0);
    case ABS_MISC:
      state_.tool_id = static_cast<std::uint32_t>(value);
      return;
    default:
      return;
  }
}

void PenDecoder::begin_gap() {
  ++sequence_;
  after_gap_ = true;
}

// An inverted pen reports both its ends on some tablets: the last in the order of the keys counts.
PenTool PenDecoder::tool() const {
  if (!has_tool_keys_) return PenTool::pen;
  PenTool last = PenTool::none;
  for (std::size_t i = 0; i < state_.tools.size(); ++i)
    if (state_.tools[i]) last = tools_by_key[i];
  return last;
}

bool PenDecoder::in_contact() const {
  if (has_touch_key_) return state_.touching;
  return axes_.pressure && state_.pressure > axes_.pressure->minimum;
}

PenSample PenDecoder::stamped(const Transfer& transfer) {
  PenSample sample;
  sample.time = {transfer.time, transfer.stamped_by, sequence_++, std::nullopt};
  sample.tool_serial = state_.tool_serial;
  sample.tool_id = state_.tool_id;
  sample.x_counts = state_.x;
  sample.y_counts = state_.y;
  return sample;
}

PenSample PenDecoder::present(const Transfer& transfer) {
  PenSample sample = stamped(transfer);
  sample.tool = tool();
  sample.in_proximity = true;
  sample.in_contact = in_contact();
  sample.pressure_raw = state_.pressure;
  sample.pressure =
      axes_.pressure ? share_of_range(*axes_.pressure, state_.pressure) : Fraction(sample.in_contact ? 1 : 0);
  if (axes_.tilt_x) sample.tilt_x = lean(*axes_.tilt_x, state_.tilt_x);
  if (axes_.tilt_y) sample.tilt_y = lean(*axes_.tilt_y, state_.tilt_y);
  if (axes_.rotation) sample.rotation = turn(*axes_.rotation, state_.rotation);
  if (axes_.distance) sample.distance = share_of_range(*axes_.distance, state_.distance);
  if (axes_.wheel) sample.wheel = share_of_range(*axes_.wheel, state_.wheel);
  sample.buttons = state_.buttons;
  sample.after_gap = after_gap_;
  after_gap_ = false;

  ++counts_.samples;
  if (sample.in_contact && !was_touching_) ++counts_.strokes;
  was_present_ = true;
  was_touching_ = sample.in_contact;
  return sample;
}

PenSample PenDecoder::leaving(const Transfer& transfer) {
  was_present_ = false;
  was_touching_ = false;
  return stamped(transfer);
}

}  // namespace fude
