#include "capture/import/libinput_record.h"

#include <linux/input-event-codes.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "capture/import/evdev_description.h"
#include "capture/import/frame_assembler.h"
#include "capture/import/text_fields.h"

namespace fude {
namespace {

// Thrown inside this file only, as yaml-cpp reports its own errors that way.
struct Malformed {
  std::string message;
};

std::string where(const YAML::Node& node) { return "line " + std::to_string(node.Mark().line + 1); }

template <class T>
T integer(const YAML::Node& node) {
  const auto value = node.IsScalar() ? whole_integer<T>(node.Scalar()) : std::nullopt;
  if (!value) throw Malformed{where(node) + ": not a whole number of the expected size; record again"};
  return *value;
}

template <class T, std::size_t count>
std::array<T, count> integers(const YAML::Node& node) {
  if (!node.IsSequence() || node.size() != count)
    throw Malformed{where(node) + ": not a list of " + std::to_string(count) + " numbers; record again"};
  std::array<T, count> values{};
  for (std::size_t i = 0; i < count; ++i) values[i] = integer<T>(node[i]);
  return values;
}

DeviceDescription describe(const YAML::Node& evdev) {
  if (!evdev.IsMap()) throw Malformed{where(evdev) + ": the device has no description; record again"};
  DeviceDescription device;
  device.transport = "evdev";
  if (const YAML::Node name = evdev["name"]; name && name.IsScalar()) device.name = name.Scalar();
  if (const YAML::Node id = evdev["id"]) {
    const auto numbers = integers<std::uint16_t, 4>(id);
    device.bus = numbers[0];
    device.vendor = numbers[1];
    device.product = numbers[2];
    device.version = numbers[3];
  }
  if (const YAML::Node codes = evdev["codes"]; codes && codes.IsMap())
    for (const auto& type : codes)
      if (integer<int>(type.first) == EV_KEY)
        for (const YAML::Node& key : type.second) device.keys.push_back(integer<std::uint16_t>(key));
  if (const YAML::Node axes = evdev["absinfo"]; axes && axes.IsMap())
    for (const auto& axis : axes) {
      const auto [minimum, maximum, fuzz, flat, resolution] = integers<std::int32_t, 5>(axis.second);
      if (maximum < minimum) throw Malformed{where(axis.second) + ": the axis ends below its beginning"};
      device.axes.push_back(
          {integer<std::uint16_t>(axis.first), minimum, maximum, fuzz, flat, resolution, 0});
    }
  if (const YAML::Node properties = evdev["properties"]; properties && properties.IsSequence())
    for (const YAML::Node& property : properties)
      device.properties.push_back(integer<std::uint16_t>(property));
  std::sort(device.keys.begin(), device.keys.end());
  std::sort(device.axes.begin(), device.axes.end(),
            [](const AxisRange& a, const AxisRange& b) { return a.code < b.code; });
  device.id = device_id(device);
  return device;
}

// Where the axes stood at the start is only said in comments, which YAML drops: one list of values
// for each device, in the order of the file.
std::vector<std::map<std::uint16_t, std::int32_t>> axis_values_in_comments(std::string_view text) {
  std::vector<std::map<std::uint16_t, std::int32_t>> devices;
  DescriptionReader reader;
  const auto close = [&] {
    if (devices.empty()) return;
    if (const auto described = std::move(reader).finish())
      for (const AxisRange& axis : described->axes) devices.back()[axis.code] = axis.value;
    reader = DescriptionReader();
  };
  while (!text.empty()) {
    std::string_view line = take_line(text);
    const std::string_view first = take_field(line);
    if (first == "-" && take_field(line) == "node:") {
      close();
      devices.emplace_back();
    } else if (first == "#") {
      reader.comment(line);
    }
  }
  close();
  return devices;
}

void add_events(const YAML::Node& list, FrameAssembler& frames) {
  for (const YAML::Node& event : list) {
    const auto fields = integers<std::int64_t, 5>(event);
    const auto within = [](std::int64_t value, std::int64_t low, std::int64_t high) {
      return value >= low && value <= high;
    };
    if (!within(fields[0], 0, static_cast<std::int64_t>(longest_time_s) - 1) ||
        !within(fields[1], 0, 999'999) || !within(fields[2], 0, UINT16_MAX) ||
        !within(fields[3], 0, UINT16_MAX) || !within(fields[4], INT32_MIN, INT32_MAX))
      throw Malformed{where(event) + ": the event is out of range; cut the file before it"};
    const Duration time = std::chrono::seconds(fields[0]) + std::chrono::microseconds(fields[1]);
    const auto added =
        frames.add(time,
                   {static_cast<std::uint16_t>(fields[2]), static_cast<std::uint16_t>(fields[3]),
                    static_cast<std::int32_t>(fields[4])},
                   where(event));
    if (!added) throw Malformed{added.error().message};
  }
}

RawRecording read_device(const YAML::Node& node) {
  if (!node.IsMap()) throw Malformed{where(node) + ": not a device; record again"};
  const YAML::Node evdev = node["evdev"];
  if (!evdev) throw Malformed{where(node) + ": the device has no description; record again"};
  FrameAssembler frames;
  if (const YAML::Node events = node["events"]; events && events.IsSequence())
    for (const YAML::Node& item : events)
      if (item.IsMap())
        for (const auto& source : item)
          if (source.first.IsScalar() && source.first.Scalar() == "evdev" && source.second.IsSequence())
            add_events(source.second, frames);
  auto recording = std::move(frames).finish(describe(evdev));
  if (!recording) throw Malformed{where(node) + ": " + recording.error().message};
  return std::move(*recording);
}

}  // namespace

bool looks_like_libinput_record(std::string_view text) {
  bool version = false;
  for (int lines = 0; lines < 40 && !text.empty(); ++lines) {
    const std::string_view line = take_line(text);
    if (line.starts_with("# libinput record") || line.starts_with("libinput:")) return true;
    version = version || line.starts_with("version:");
    if (version && line.starts_with("ndevices:")) return true;
  }
  return false;
}

Result<std::vector<RawRecording>> import_libinput_record(std::string_view text) {
  try {
    const YAML::Node root = YAML::Load(std::string(text));
    const YAML::Node version = root.IsMap() ? root["version"] : YAML::Node();
    if (!version || !version.IsScalar())
      return failure(Fault::malformed, "not a `libinput record` file: it has no version; name its --from");
    if (version.Scalar() != "1")
      return failure(Fault::unsupported, "the file has version " + version.Scalar().substr(0, 20) +
                                             "; this program reads version 1 of `libinput record`");
    std::vector<RawRecording> recordings;
    if (const YAML::Node devices = root["devices"]; devices && devices.IsSequence())
      for (const YAML::Node& device : devices) recordings.push_back(read_device(device));
    if (recordings.empty())
      return failure(Fault::malformed, "the file lists no devices; record again with `libinput record`");

    const auto values = axis_values_in_comments(text);
    if (values.size() == recordings.size())
      for (std::size_t i = 0; i < recordings.size(); ++i)
        for (AxisRange& axis : recordings[i].device->axes)
          if (const auto value = values[i].find(axis.code); value != values[i].end())
            axis.value = value->second;
    return recordings;
  } catch (const Malformed& wrong) {
    return failure(Fault::malformed, wrong.message);
  } catch (const YAML::Exception& wrong) {
    return failure(Fault::malformed, "line " + std::to_string(wrong.mark.line + 1) + ": " + wrong.msg +
                                         "; cut the file before it or record again");
  }
}

}  // namespace fude
