// From the events of a tablet to samples of its pen.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "signal/device.h"
#include "signal/pen_sample.h"
#include "signal/transfer.h"

namespace fude {

// What the decoding met; nothing is lost without a count.
struct DecodeCounts {
  std::uint64_t frames = 0;        // closed by a SYN_REPORT
  std::uint64_t samples = 0;       // of a pen in proximity; the sample that says it left is none of them
  std::uint64_t strokes = 0;       // runs of contact
  std::uint64_t lost = 0;          // frames that the kernel or the wire dropped, at least one a gap
  std::uint64_t out_of_range = 0;  // axis values beyond the described range, held at its ends
  std::uint64_t malformed = 0;     // transfers that are no events; each is a gap
  bool operator==(const DecodeCounts&) const = default;
};

// Evdev tells only what changed, so the state of the pen stands here between frames; it starts at the
// values of the description. A device without tool keys always has its pen in proximity; one with
// them is heard only while a pen, rubber, brush, pencil or airbrush is down (a puck is no pen).
// Contact is BTN_TOUCH where the device has it, else pressure.
class PenDecoder {
 public:
  explicit PenDecoder(const DeviceDescription& device);

  // At most one sample a transfer: the state at the end of a SYN_REPORT frame. When the pen leaves
  // (or the device is unplugged or suspended) one sample of tool `none` says so. After SYN_DROPPED everything up
  // to the next SYN_REPORT is stale and discarded; the sample after it is marked `after_gap`.
  // Positions may lie one range beyond the described area (the pen at its edge), never farther.
  std::optional<PenSample> decode(const Transfer& transfer);

  const DecodeCounts& counts() const { return counts_; }

 private:
  struct Axes {
    std::optional<AxisRange> x, y, pressure, distance, tilt_x, tilt_y, rotation, wheel;
  };
  struct State {
    std::int32_t x = 0, y = 0, pressure = 0, distance = 0, tilt_x = 0, tilt_y = 0, rotation = 0, wheel = 0;
    std::uint32_t tool_id = 0, tool_serial = 0;
    std::uint32_t buttons = 0;
    std::array<bool, 5> tools{};  // by key: BTN_TOOL_PEN, RUBBER, BRUSH, PENCIL, AIRBRUSH
    bool touching = false;
  };

  std::optional<PenSample> decode_frame(std::span<const EvdevEvent> events, const Transfer& transfer);
  void apply(const EvdevEvent& event, bool from_pad);
  void set_axis(std::uint16_t code, std::int32_t value);
  void begin_gap();
  void let_go_of_keys();
  PenTool tool() const;
  bool in_contact() const;
  PenSample stamped(const Transfer& transfer);
  PenSample present(const Transfer& transfer);
  PenSample leaving(const Transfer& transfer);

  Axes axes_;
  bool has_tool_keys_ = false;
  bool has_touch_key_ = false;
  State initial_;
  State state_;
  DecodeCounts counts_;
  std::uint64_t sequence_ = 0;
  bool stale_ = false;      // between SYN_DROPPED and the next SYN_REPORT
  bool after_gap_ = false;  // the next sample follows a loss
  bool was_present_ = false;
  bool was_touching_ = false;
};

}  // namespace fude
