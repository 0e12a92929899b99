#include "capture/import/row_clock.h"

#include <cmath>

#include "capture/import/text_fields.h"

namespace fude {

RowClock::RowClock(const CsvRows& rows, std::optional<double> rate_hz)
    : seconds_(rows.column("t_s")), tick_(rows.column("frame_number")), rate_hz_(rate_hz) {
  if (!tick_) tick_ = rows.column("FrameNumber");
  counter_ = tick_ ? tick_ : rows.column("frame");
}

Result<void> RowClock::check() const {
  if (seconds_) return {};
  if (!rate_hz_)
    return failure(Fault::malformed, "the table has no column t_s; give its rate with --rate-hz");
  if (!(*rate_hz_ >= 0.001 && *rate_hz_ <= 1e6))
    return failure(Fault::usage, "--rate-hz takes 0.001 to 1000000");
  return {};
}

std::optional<SampleTime> RowClock::time(const CsvRows& rows, RawRecording& recording) {
  const std::uint64_t row = row_++;
  std::optional<Duration> since;
  if (seconds_) {
    since = rows.seconds(*seconds_);
  } else {
    const auto count = counter_ ? rows.finite(*counter_) : std::optional(static_cast<double>(row));
    if (count && !first_count_) first_count_ = *count;
    const double s = count ? (*count - *first_count_) / *rate_hz_ : -1;
    if (s >= 0 && s < longest_time_s) since = Duration(std::llround(s * 1e9));
  }
  if (!since) {
    ++recording.passed_over["rows without a time"];
    return std::nullopt;
  }
  const Timestamp time{*since};
  if (last_ && time < *last_) {
    ++recording.passed_over["rows whose time runs backwards"];
    return std::nullopt;
  }
  if (last_ && time == *last_) ++recording.counts.still_times;
  last_ = time;
  SampleTime stamp{time, StampedBy::recording, row, std::nullopt};
  if (tick_)
    if (const auto field = rows.text(*tick_)) stamp.device_tick = whole_integer<std::uint64_t>(*field);
  return stamp;
}

}  // namespace fude
