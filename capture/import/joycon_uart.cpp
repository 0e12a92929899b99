#include "capture/import/joycon_uart.h"

#include <optional>
#include <utility>

#include "capture/import/text_fields.h"

namespace fude {
namespace {

constexpr std::byte first_byte{0x19};
constexpr std::size_t longest_packet = 4096;
constexpr std::size_t report_at = 12;  // after the rail's head
constexpr std::size_t packet_with_report = report_at + 49;
constexpr std::byte full_report{0x30};
constexpr Duration timer_count = std::chrono::milliseconds(5);

std::optional<std::vector<std::byte>> packet_from(std::string_view line) {
  std::vector<std::byte> bytes;
  for (std::string_view field = take_field(line); !field.empty(); field = take_field(line)) {
    const auto byte = field.starts_with("0x") ? hexadecimal_byte(field) : std::nullopt;
    if (!byte || bytes.size() == longest_packet) return std::nullopt;
    bytes.push_back(*byte);
  }
  return bytes;
}

}  // namespace

bool looks_like_joycon_uart(std::string_view text) {
  while (!text.empty()) {
    const auto packet = packet_from(take_line(text));
    if (!packet) return false;
    if (!packet->empty()) return packet->front() == first_byte && packet->size() >= 5;
  }
  return false;
}

Result<RawRecording> import_joycon_uart(std::string_view text) {
  RawRecording recording;
  DeviceDescription& device = recording.device.emplace();
  device.name = "Joy-Con";
  device.kind = DeviceKind::imu;
  device.transport = "serial";
  device.vendor = 0x057e;
  device.id = device_id(device);
  device.clock = DeviceClock{64, 1e-6};  // of the samples: the decoder counts microseconds
  Timestamp time{};
  std::optional<std::uint8_t> timer;
  while (!text.empty()) {
    const std::string_view line = take_line(text);
    auto packet = packet_from(line);
    if (packet && packet->empty()) {
      ++recording.counts.ignored_lines;
      continue;
    }
    ++recording.counts.events;
    if (!packet || packet->front() != first_byte) {
      ++recording.passed_over["lines that are no packets"];
      continue;
    }
    if (packet->size() == packet_with_report && (*packet)[report_at] == full_report) {
      const auto count = std::to_integer<std::uint8_t>((*packet)[report_at + 1]);
      if (timer) time += static_cast<std::uint8_t>(count - *timer) * timer_count;
      timer = count;
    }
    ++recording.counts.frames;
    recording.transfers.push_back(
        {time, StampedBy::recording, Direction::from_device, TransferKind::serial, std::move(*packet)});
  }
  if (recording.transfers.empty())
    return failure(Fault::malformed, "no line is a packet of a Joy-Con's rail (0x19 …); name its --from");
  return recording;
}

}  // namespace fude
