#include "capture/import/usbhid_dump.h"

#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "capture/import/hid_recorder.h"
#include "capture/import/text_fields.h"

namespace fude {
namespace {

constexpr std::size_t most_devices = 256;
constexpr std::size_t longest_block = 65536;
constexpr double millimetres_per_inch = 25.4;

struct Head {
  std::string interface;  // "003:007:000"
  bool descriptor = false;
  Timestamp time{};
};

std::optional<Head> read_head(std::string_view line) {
  const std::string_view name = take_field(line);
  const auto time = any_seconds(take_field(line));
  const std::size_t end = name.rfind(':');
  if (!time || end == std::string_view::npos || end == 0 || end > 64 || !take_field(line).empty())
    return std::nullopt;
  const std::string_view kind = name.substr(end + 1);
  if (kind != "STREAM" && kind != "DESCRIPTOR") return std::nullopt;
  return Head{std::string(name.substr(0, end)), kind == "DESCRIPTOR", Timestamp(*time)};
}

bool blank(std::string_view line) { return line.find_first_not_of(" \t") == std::string_view::npos; }

// Adds a line of bytes; false where it holds something else.
bool add_bytes(std::string_view line, std::vector<std::byte>& bytes) {
  for (std::string_view field = take_field(line); !field.empty(); field = take_field(line)) {
    const auto byte = hexadecimal_byte(field);
    if (!byte || field.size() != 2 || bytes.size() >= longest_block) return false;
    bytes.push_back(*byte);
  }
  return true;
}

// "5080" of `    resolution: 5080`, "256c" of `VID: "256c"`.
std::optional<std::string> value_after(std::string_view line, std::string_view key) {
  const std::size_t begin = line.find_first_not_of(" \t");
  if (begin == std::string_view::npos || !line.substr(begin).starts_with(key)) return std::nullopt;
  std::string value;
  for (const char c : line.substr(begin + key.size()))
    if (c != '"' && value.size() < 256) value += c;
  const std::size_t from = value.find_first_not_of(" \t");
  return from == std::string::npos ? std::string() : value.substr(from);
}

}  // namespace

bool looks_like_usbhid_dump(std::string_view text) {
  while (!text.empty()) {
    const std::string_view line = take_line(text);
    if (!blank(line)) return read_head(line).has_value();
  }
  return false;
}

Result<std::vector<RawRecording>> import_usbhid_dump(std::string_view text) {
  std::vector<RawRecording> recordings;
  std::map<std::string, std::size_t> interfaces;
  std::uint64_t stray = 0;
  const auto take_block = [&](const Head& head, std::vector<std::byte> bytes, bool sound) {
    if (!interfaces.contains(head.interface) && recordings.size() == most_devices) {
      ++stray;
      return;
    }
    const auto [at, added] = interfaces.emplace(head.interface, recordings.size());
    if (added) {
      DeviceDescription& device = recordings.emplace_back().device.emplace();
      device.transport = "usb";
      device.name = "USB interface " + head.interface;
    }
    RawRecording& recording = recordings[at->second];
    if (!sound || bytes.empty()) {
      ++recording.passed_over["blocks that are no bytes"];
    } else if (head.descriptor) {
      recording.device->hid_descriptor = std::move(bytes);
    } else {
      ++recording.counts.events;
      if (!recording.transfers.empty() && head.time < recording.transfers.back().time) {
        ++recording.passed_over["reports whose time runs backwards"];
        return;
      }
      if (!recording.transfers.empty() && head.time == recording.transfers.back().time)
        ++recording.counts.still_times;
      const auto& descriptor = recording.device->hid_descriptor;
      if (!descriptor.empty() && !numbers_reports(descriptor)) bytes.insert(bytes.begin(), std::byte{0});
      ++recording.counts.frames;
      recording.transfers.push_back({head.time, StampedBy::recording, Direction::from_device,
                                     TransferKind::hid_report, std::move(bytes)});
    }
  };

  Head head;  // without a name: no block is open
  std::vector<std::byte> bytes;
  bool sound = true;
  const auto close = [&] {
    if (!head.interface.empty()) take_block(head, std::exchange(bytes, {}), std::exchange(sound, true));
    head = {};
  };
  while (!text.empty()) {
    const std::string_view line = take_line(text);
    if (blank(line)) {
      close();
    } else if (auto next = read_head(line)) {
      close();
      head = std::move(*next);
    } else if (!head.interface.empty()) {
      sound = add_bytes(line, bytes) && sound;
    } else {
      ++stray;
    }
  }
  close();
  if (recordings.empty())
    return failure(Fault::malformed,
                   "no block is one of usbhid-dump's (bus:device:interface:STREAM); name its --from");
  if (stray > 0) recordings.front().passed_over["lines outside of blocks"] = stray;
  for (RawRecording& recording : recordings) recording.device->id = device_id(*recording.device);
  return recordings;
}

std::optional<DeviceDescription> read_tablet_page(std::string_view text) {
  DeviceDescription device;
  std::string maker, product;
  double width = 0, height = 0, resolution = 0, levels = 0;
  const auto number = [](const std::string& value) { return whole_real(value).value_or(0); };
  while (!text.empty()) {
    const std::string_view line = take_line(text);
    if (const auto v = value_after(line, "VID:"))
      device.vendor = whole_integer<std::uint16_t>(*v, 16).value_or(0);
    if (const auto v = value_after(line, "PID:"))
      device.product = whole_integer<std::uint16_t>(*v, 16).value_or(0);
    if (const auto v = value_after(line, "vendor:")) maker = *v;
    if (const auto v = value_after(line, "product:")) product = *v;
    if (const auto v = value_after(line, "width:")) width = number(*v);
    if (const auto v = value_after(line, "height:")) height = number(*v);
    if (const auto v = value_after(line, "resolution:")) resolution = number(*v);
    if (const auto v = value_after(line, "pressure_levels:")) levels = number(*v);
  }
  if (device.vendor == 0 || device.product == 0) return std::nullopt;
  device.name = maker.empty() ? product : product.empty() ? maker : maker + ' ' + product;
  const double across = width * resolution, down = height * resolution;
  if (across >= 1 && across < 1e7 && down >= 1 && down < 1e7) {
    device.width = Millimetres(width * millimetres_per_inch);
    device.height = Millimetres(height * millimetres_per_inch);
    device.axes.push_back({.code = 0, .maximum = static_cast<std::int32_t>(std::lround(across))});
    device.axes.push_back({.code = 1, .maximum = static_cast<std::int32_t>(std::lround(down))});
  }
  if (levels >= 2 && levels <= 65536)
    device.axes.push_back({.code = 0x18, .maximum = static_cast<std::int32_t>(levels) - 1});
  return device;
}

}  // namespace fude
