// Any description and any events: every sample is finite and in range.
#include <linux/input-event-codes.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>

#include "drivers/tablet/pen_decoder.h"

namespace {

// Takes values off the front of the input; zeros when it is used up.
struct Input {
  const std::uint8_t* at;
  std::size_t left;
  template <class T>
  T take() {
    T value{};
    const std::size_t size = left < sizeof value ? left : sizeof value;
    std::memcpy(&value, at, size);
    at += size;
    left -= size;
    return value;
  }
};

void expect(bool holds) {
  if (!holds) __builtin_trap();
}

void expect_share(double value) { expect(value >= 0 && value <= 1); }

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace fude;
  Input input{bytes, size};
  DeviceDescription device;
  const auto keys = input.take<std::uint16_t>();
  for (std::uint16_t key = 0; key < 16; ++key)
    if (keys >> key & 1) device.keys.push_back(static_cast<std::uint16_t>(BTN_TOOL_PEN + key));
  for (int axes = input.take<std::uint8_t>() % 12; axes > 0; --axes) {
    AxisRange axis;
    axis.code = input.take<std::uint8_t>() % ABS_CNT;
    axis.minimum = input.take<std::int32_t>();
    axis.maximum = input.take<std::int32_t>();
    axis.resolution = input.take<std::int16_t>();
    axis.value = input.take<std::int32_t>();
    device.axes.push_back(axis);
  }
  PenDecoder decoder(device);
  std::uint64_t sequence = 0;
  bool first = true;
  while (input.left > 0) {
    Transfer transfer;
    const auto head = input.take<std::uint8_t>();
    transfer.kind = head % 16 == 0   ? TransferKind::unplugged
                    : head % 16 == 1 ? TransferKind::plugged
                                     : TransferKind::evdev_frame;
    std::size_t length = head % 16 == 2 ? head / 16 : std::size_t{8} * (head / 16);
    if (length > input.left) length = input.left;
    const auto* payload = reinterpret_cast<const std::byte*>(input.at);
    transfer.payload.assign(payload, payload + length);
    input.at += length;
    input.left -= length;
    if (head % 2 == 1 && length % 8 == 0) transfer.payload.resize(length + 8);  // zeros are a SYN_REPORT

    const auto sample = decoder.decode(transfer);
    if (!sample) continue;
    expect(first || sample->time.sequence > sequence);
    first = false;
    sequence = sample->time.sequence;
    expect(std::isfinite(sample->x_counts) && std::isfinite(sample->y_counts));
    expect_share(sample->pressure.value);
    if (sample->distance) expect_share(sample->distance->value);
    if (sample->wheel) expect_share(sample->wheel->value);
    for (const auto& angle : {sample->tilt_x, sample->tilt_y, sample->rotation})
      if (angle) expect(std::abs(angle->value) < 3.2);
    expect(sample->in_proximity == (sample->tool != PenTool::none));
    expect(sample->in_proximity || !sample->in_contact);
  }
  return 0;
}
