// When each row of a table was recorded: its t_s, or a stated rate.
#pragma once

#include <cstdint>
#include <optional>

#include "capture/import/csv_rows.h"
#include "capture/import/recording.h"
#include "signal/result.h"

namespace fude {

class RowClock {
 public:
  // By column t_s; without it by `rate_hz`, counted in the column frame_number, FrameNumber or frame where
  // there is one (which t_s does not need but which then becomes the samples' device_tick, `frame` excepted),
  // else in rows.
  RowClock(const CsvRows& rows, std::optional<double> rate_hz);

  // Errors: usage for a rate that is not between 0.001 and 1,000,000; malformed where there is neither t_s
  // nor a rate.
  Result<void> check() const;

  // Of the row, or none: then its reason has been counted. Time that stands still is counted in still_times.
  std::optional<SampleTime> time(const CsvRows& rows, RawRecording& recording);

  bool ticks() const { return tick_.has_value(); }

 private:
  std::optional<std::size_t> seconds_, tick_, counter_;
  std::optional<double> rate_hz_;
  std::optional<double> first_count_;
  std::uint64_t row_ = 0;
  std::optional<Timestamp> last_;
};

}  // namespace fude
