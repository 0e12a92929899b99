#include "capture/import/timestamps_csv.h"

#include "capture/import/csv_rows.h"
#include "capture/import/text_fields.h"

namespace fude {
namespace {

std::optional<std::size_t> time_column(const CsvRows& rows) {
  const auto unfiltered = rows.column("timestamp_unfiltered_s");
  return unfiltered ? unfiltered : rows.column("t_s");
}

}  // namespace

bool looks_like_timestamps_csv(std::string_view text) {
  const CsvRows rows(text);
  return rows.has("frame_number") && time_column(rows);
}

Result<RawRecording> import_timestamps_csv(std::string_view text) {
  CsvRows rows(text);
  const auto number = rows.column("frame_number"), time = time_column(rows);
  if (!number || !time)
    return failure(
        Fault::malformed,
        "the table lacks frame_number, or timestamp_unfiltered_s and t_s; name them in its first row");
  RawRecording recording;
  recording.device = DeviceDescription{
      .id = "text:timestamps-csv", .name = "clock", .kind = DeviceKind::clock, .transport = "text"};
  recording.device->clock = DeviceClock{};
  Timestamp before{};
  while (rows.next()) {
    const std::uint64_t row = recording.counts.events++;
    const auto tick = whole_integer<std::uint64_t>(rows.text(*number).value_or(""));
    const auto since = rows.seconds(*time);
    if (!tick || !since) {
      ++recording.passed_over["rows without a frame number or a time"];
      continue;
    }
    TickSample sample{.time = {Timestamp(*since), StampedBy::recording, row, tick}};
    if (!recording.samples.empty() && sample.time.host == before) ++recording.counts.still_times;
    before = sample.time.host;
    recording.samples.emplace_back(sample);
  }
  recording.counts.ignored_lines = rows.ignored();
  if (recording.samples.empty())
    return failure(Fault::malformed, "no row of the table can be read; check its numbers and its time");
  return recording;
}

}  // namespace fude
