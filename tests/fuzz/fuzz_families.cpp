// Any transfers to any family's driver: every sample is finite and in range, sequences never go back,
// and no more comes out than bytes went in.
#include <linux/input-event-codes.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "drivers/families.h"
#include "tests/fakes/sound_sample.h"

namespace {

using namespace fude;

// Family in the first byte, which of its rows in the second.
const FamilyRow* row_of(std::uint8_t family, std::uint8_t which) {
  const FamilyRow* row = nullptr;
  for (const FamilyRow& candidate : family_rows())
    if (static_cast<std::uint8_t>(candidate.family) == family && (row == nullptr || which-- > 0))
      row = &candidate;
  return row;
}

DeviceDescription described(const FamilyRow& row) {
  DeviceDescription device;
  device.transport = row.transport;
  device.keys = {BTN_TOOL_PEN, BTN_TOOL_RUBBER, BTN_TOUCH, BTN_STYLUS};
  for (int code : {ABS_X, ABS_Y, ABS_Z, ABS_WHEEL, ABS_PRESSURE, ABS_DISTANCE, ABS_TILT_X, ABS_TILT_Y,
                   ABS_MT_SLOT, ABS_MT_TOUCH_MAJOR, ABS_MT_TOUCH_MINOR, ABS_MT_ORIENTATION, ABS_MT_POSITION_X,
                   ABS_MT_POSITION_Y, ABS_MT_PRESSURE})
    device.axes.push_back(
        {.code = static_cast<std::uint16_t>(code), .maximum = code == ABS_MT_SLOT ? 9 : 1000});
  return device;
}

void expect(bool holds) {
  if (!holds) __builtin_trap();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  if (size < 2) return 0;
  const FamilyRow* row = row_of(bytes[0], bytes[1]);
  if (row == nullptr) return 0;
  const auto decoder = open_decoder(*row, described(*row));
  decoder->greeting();
  std::size_t at = 2;
  Timestamp now{};
  std::uint64_t sequence = 0;
  bool first = true;
  // Each transfer: kind, length, milliseconds since the last, payload.
  while (at + 3 <= size) {
    Transfer transfer;
    transfer.direction = bytes[at] & 0x80 ? Direction::to_device : Direction::from_device;
    transfer.kind = static_cast<TransferKind>((bytes[at] & 0x7f) % 13);
    const std::size_t length = std::min<std::size_t>(bytes[at + 1], size - at - 3);
    now += std::chrono::milliseconds(bytes[at + 2] == 255 ? 1'000'000 : bytes[at + 2]);
    transfer.time = now;
    at += 3;
    const auto* payload = reinterpret_cast<const std::byte*>(bytes + at);
    transfer.payload.assign(payload, payload + length);
    at += length;
    Decoded out;
    decoder->decode(transfer, out);
    expect(out.samples.size() <= 2 * length + 64 && out.replies.size() <= 16);
    for (const Sample& sample : out.samples) {
      expect(is_sound(sample));
      const std::uint64_t number = std::visit([](const auto& s) { return s.time.sequence; }, sample);
      expect(first || number >= sequence);
      sequence = number;
      first = false;
    }
  }
  return 0;
}
