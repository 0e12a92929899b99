#include "capture/import/evemu.h"

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "capture/import/evdev_description.h"
#include "capture/import/frame_assembler.h"
#include "capture/import/text_fields.h"

namespace fude {
namespace {

struct TimedEvent {
  Duration time{};
  EvdevEvent event;
};

// What follows "E:".
std::optional<TimedEvent> read_event(std::string_view fields) {
  const auto time = whole_seconds(take_field(fields));
  const auto type = whole_integer<std::uint16_t>(take_field(fields), 16);
  const auto code = whole_integer<std::uint16_t>(take_field(fields), 16);
  const auto value = whole_integer<std::int32_t>(take_field(fields));
  const std::string_view rest = take_field(fields);
  if (!time || !type || !code || !value || !(rest.empty() || rest.front() == '#')) return std::nullopt;
  return TimedEvent{*time, {*type, *code, *value}};
}

// A few bytes of a stranger's line, fit for a message.
std::string excerpt(std::string_view line) {
  std::string shown;
  for (char c : line.substr(0, 40)) shown += c >= ' ' && c <= '~' ? c : '?';
  return '"' + shown + '"';
}

}  // namespace

bool looks_like_evemu(std::string_view text) {
  while (!text.empty()) {
    const std::string_view line = take_line(text);
    if (line.starts_with("# EVEMU") || line.starts_with("N: ") || line.starts_with("E: ")) return true;
    if (!line.empty() && line.front() != '#') return false;
  }
  return false;
}

Result<RawRecording> import_evemu(std::string_view text) {
  DescriptionReader description;
  FrameAssembler frames;
  std::uint64_t ignored = 0;
  for (std::uint64_t number = 1; !text.empty(); ++number) {
    std::string_view line = take_line(text);
    const auto where = [number] { return "line " + std::to_string(number); };
    if (line.starts_with("E:")) {
      const auto event = read_event(line.substr(2));
      if (!event)
        return failure(Fault::malformed,
                       where() + ": " + excerpt(line) +
                           " is no event (seconds.microseconds, type, code, value); cut the file before it");
      if (auto added = frames.add(event->time, event->event, where()); !added)
        return tl::unexpected(added.error());
    } else if (line.empty() || line.front() == '#') {
      ++ignored;
      description.comment(line);
    } else {
      const auto taken = description.letter_line(line);
      if (!taken) return failure(taken.error().fault, where() + ": " + taken.error().message);
      if (!*taken)
        return failure(Fault::malformed,
                       where() + ": " + excerpt(line) + " is no line of an evemu recording; name its --from");
    }
  }

  std::optional<DeviceDescription> device;
  if (description.found()) {
    auto finished = std::move(description).finish();
    if (!finished) return tl::unexpected(finished.error());
    device = std::move(*finished);
  }
  auto recording = std::move(frames).finish(std::move(device));
  if (recording) recording->counts.ignored_lines = ignored;
  return recording;
}

Result<DeviceDescription> read_evemu_description(std::string_view text) {
  auto recording = import_evemu(text);
  if (!recording) return tl::unexpected(recording.error());
  if (!recording->device)
    return failure(Fault::not_found, "the file describes no device; make one with `evemu-describe`");
  return std::move(*recording->device);
}

}  // namespace fude
