#include "capture/import/hid_recorder.h"

#include <array>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "capture/import/text_fields.h"

namespace fude {
namespace {

constexpr std::size_t most_devices = 256;
constexpr std::size_t longest_name = 256;

std::optional<std::vector<std::byte>> stated_bytes(std::string_view& fields) {
  const auto length = whole_integer<std::uint32_t>(take_field(fields));
  if (!length) return std::nullopt;
  std::vector<std::byte> bytes;
  for (std::string_view field = take_field(fields); !field.empty(); field = take_field(fields)) {
    const auto byte = hexadecimal_byte(field);
    if (!byte) return std::nullopt;
    bytes.push_back(*byte);
  }
  return bytes.size() == *length ? std::optional(std::move(bytes)) : std::nullopt;
}

struct Device {
  RawRecording recording;
  bool numbered = true;

  Device() {
    recording.device.emplace().transport = "hidraw";
    recording.device->name = "a HID device";
  }

  void pass_over(const char* what) { ++recording.passed_over[what]; }

  void identity(std::string_view fields) {
    DeviceDescription& d = *recording.device;
    std::array<std::uint16_t, 3> numbers{};
    for (std::uint16_t& number : numbers) {
      const auto value = whole_integer<std::uint16_t>(take_field(fields), 16);
      if (!value) return pass_over("I: lines that are not bus, vendor, product");
      number = *value;
    }
    d.bus = numbers[0];
    d.vendor = numbers[1];
    d.product = numbers[2];
  }

  void report(std::string_view fields) {
    ++recording.counts.events;
    const auto time = any_seconds(take_field(fields));
    auto bytes = time ? stated_bytes(fields) : std::nullopt;
    if (!bytes) return pass_over("reports that are cut off or no bytes");
    const Timestamp stamp{*time};
    if (!recording.transfers.empty()) {
      if (stamp < recording.transfers.back().time) return pass_over("reports whose time runs backwards");
      if (stamp == recording.transfers.back().time) ++recording.counts.still_times;
    }
    if (!numbered) bytes->insert(bytes->begin(), std::byte{0});
    ++recording.counts.frames;
    recording.transfers.push_back(
        {stamp, StampedBy::recording, Direction::from_device, TransferKind::hid_report, std::move(*bytes)});
  }

  void descriptor(std::string_view fields) {
    auto bytes = stated_bytes(fields);
    if (!bytes) return pass_over("report descriptors that are cut off or no bytes");
    recording.device->hid_descriptor = std::move(*bytes);
    numbered = numbers_reports(recording.device->hid_descriptor);
  }
};

bool letter(std::string_view line, char c) { return line.size() >= 2 && line[0] == c && line[1] == ':'; }

}  // namespace

bool numbers_reports(std::span<const std::byte> descriptor) {
  while (!descriptor.empty()) {
    const auto prefix = std::to_integer<unsigned>(descriptor[0]);
    if ((prefix & 0xfc) == 0x84) return true;
    std::size_t length = std::array<std::size_t, 4>{0, 1, 2, 4}[prefix & 3];
    if (prefix == 0xfe && descriptor.size() > 1) length = std::to_integer<std::size_t>(descriptor[1]) + 2;
    if (descriptor.size() <= length) return false;
    descriptor = descriptor.subspan(length + 1);
  }
  return false;
}

// Only here the first letters that are no comment are R: with a length or D:.
bool looks_like_hid_recorder(std::string_view text) {
  for (int lines = 0; lines < 1000 && !text.empty(); ++lines) {
    std::string_view line = take_line(text);
    if (line.empty() || line.front() == '#') continue;
    if (letter(line, 'D')) return true;
    if (letter(line, 'R')) {
      line.remove_prefix(2);
      return whole_integer<std::uint32_t>(take_field(line)).has_value();
    }
    if (!letter(line, 'N') && !letter(line, 'P') && !letter(line, 'I')) return false;
  }
  return false;
}

Result<std::vector<RawRecording>> import_hid_recorder(std::string_view text) {
  std::vector<Device> devices;
  std::map<std::string, std::size_t, std::less<>> numbers;
  std::size_t current = 0;
  std::uint64_t ignored = 0, understood = 0, strange = 0;
  const auto device = [&]() -> Device& {
    if (devices.empty()) devices.emplace_back();
    ++understood;
    return devices[current];
  };
  while (!text.empty()) {
    std::string_view line = take_line(text);
    if (line.empty() || line.front() == '#') {
      ++ignored;
      continue;
    }
    std::string_view fields = line.substr(std::min<std::size_t>(2, line.size()));
    if (letter(line, 'D')) {
      const std::string_view number = take_field(fields);
      const auto known = numbers.find(number);
      if (known != numbers.end()) {
        current = known->second;
      } else if (devices.size() < most_devices && number.size() <= longest_name) {
        // What came before the first D: belongs to the device it names.
        if (numbers.empty() && devices.size() == 1)
          current = 0;
        else {
          current = devices.size();
          devices.emplace_back();
        }
        numbers.emplace(number, current);
      } else {
        ++strange;
      }
    } else if (letter(line, 'R')) {
      device().descriptor(fields);
    } else if (letter(line, 'N')) {
      const std::size_t begin = fields.find_first_not_of(' ');
      if (begin != std::string_view::npos)
        device().recording.device->name = fields.substr(begin, longest_name);
    } else if (letter(line, 'P')) {
      (void)device();  // where it was plugged in: not kept
    } else if (letter(line, 'I')) {
      device().identity(fields);
    } else if (letter(line, 'E')) {
      if (take_field(fields).empty())
        ++ignored;  // the recording ended in the middle of a line
      else
        device().report(line.substr(2));
    } else {
      ++strange;
    }
  }
  if (understood == 0)
    return failure(Fault::malformed, "no line is one of hid-recorder's (R:, N:, I:, E:); name its --from");
  std::vector<RawRecording> recordings;
  for (Device& d : devices) {
    d.recording.device->id = device_id(*d.recording.device);
    recordings.push_back(std::move(d.recording));
  }
  recordings.front().counts.ignored_lines = ignored;
  if (strange > 0) recordings.front().passed_over["lines of no known kind"] = strange;
  return recordings;
}

}  // namespace fude
