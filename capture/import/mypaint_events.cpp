#include "capture/import/mypaint_events.h"

#include <cmath>
#include <optional>
#include <string>

#include "capture/import/text_fields.h"

namespace fude {
namespace {

constexpr double farthest_pixel = 1e6;

struct Row {
  double time_s = 0;
  double x = 0;
  double y = 0;
  double pressure = 0;
};

std::optional<Row> read_row(std::string_view line) {
  Row row;
  for (double* field : {&row.time_s, &row.x, &row.y, &row.pressure}) {
    const auto value = whole_real(take_field(line));
    if (!value) return std::nullopt;
    *field = *value;
  }
  return take_field(line).empty() ? std::optional(row) : std::nullopt;
}

// What a row may not be; empty when it is sound. Not-a-number fails every comparison.
std::string complaint(const Row& row) {
  if (!(row.time_s >= 0 && row.time_s < longest_time_s)) return "the time is not between 0 and 136 years";
  if (!(std::abs(row.x) <= farthest_pixel && std::abs(row.y) <= farthest_pixel))
    return "the position is not within a million pixels";
  if (!(row.pressure >= 0 && row.pressure <= 1)) return "the pressure is not between 0 and 1";
  return {};
}

bool without_content(std::string_view line) {
  const std::string_view first = take_field(line);
  return first.empty() || first.front() == '#';
}

}  // namespace

bool looks_like_mypaint_events(std::string_view text) {
  while (!text.empty()) {
    const std::string_view line = take_line(text);
    if (!without_content(line)) return read_row(line).has_value();
  }
  return false;
}

Result<RawRecording> import_mypaint_events(std::string_view text, Millimetres per_pixel) {
  if (!(per_pixel.value >= 0.001 && per_pixel.value <= 100))
    return failure(Fault::usage, "--mm-per-pixel takes 0.001 to 100");
  RawRecording recording;
  DeviceDescription& device = recording.device.emplace();
  device.id = "text:mypaint-events";
  device.name = "strokes in pixels";
  device.kind = DeviceKind::pen_tablet;
  device.transport = "text";
  device.mm_per_count = per_pixel.value;
  for (std::uint64_t number = 1; !text.empty(); ++number) {
    const std::string_view line = take_line(text);
    if (without_content(line)) {
      ++recording.counts.ignored_lines;
      continue;
    }
    const auto where = [number] { return "line " + std::to_string(number) + ": "; };
    const auto row = read_row(line);
    if (!row)
      return failure(Fault::malformed,
                     where() + "not the four numbers seconds, x, y, pressure; mend or remove the line");
    if (const std::string wrong = complaint(*row); !wrong.empty())
      return failure(Fault::malformed, where() + wrong + "; mend or remove the line");

    PenSample sample;
    sample.time = {Timestamp(Duration(std::llround(row->time_s * 1e9))), StampedBy::recording,
                   recording.samples.size(), std::nullopt};
    if (!recording.samples.empty()) {
      const Timestamp before = std::get<PenSample>(recording.samples.back()).time.host;
      if (sample.time.host < before)
        return failure(Fault::malformed, where() +
                                             "time runs backwards; cut the file there and import the "
                                             "parts one by one");
      if (sample.time.host == before) ++recording.counts.still_times;
    }
    sample.tool = PenTool::pen;
    sample.in_proximity = true;
    sample.in_contact = row->pressure > 0;
    sample.x_counts = row->x;
    sample.y_counts = row->y;
    sample.pressure = Fraction(row->pressure);
    recording.samples.emplace_back(sample);
    ++recording.counts.events;
  }
  const std::size_t rows = recording.samples.size();
  if (rows >= 3 && recording.counts.still_times == rows - 1)
    return failure(Fault::malformed, "all " + std::to_string(rows) +
                                         " rows carry the same time; the first field must be seconds");
  return recording;
}

}  // namespace fude
