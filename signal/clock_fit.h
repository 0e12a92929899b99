// A device's own ticks on the host's clock: one robust line for every run of the device's clock. Nothing is
// stamped again: host time and tick stay as they are, the line stands beside them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "signal/device.h"
#include "signal/timestamp.h"

namespace fude {

struct ClockReading {
  Timestamp host{};
  std::uint64_t tick = 0;
};

struct ClockFitOptions {
  DeviceClock clock;
  // Readings off the line by more than this, and by more than ten times the spread, are taken for a restart
  // once four or more in a row, over twice this time, agree with each other on another line.
  Duration smallest_jump = std::chrono::milliseconds(50);
};

// Of the distances from the line, seconds.
struct ResidualQuantiles {
  double p50 = 0;
  double p99 = 0;
  double largest = 0;
  bool operator==(const ResidualQuantiles&) const = default;
};

// host = offset + tick_s · (ticks since first_tick). Delays that only ever add (a bus, a busy host) move the
// offset by their middle: a constant delay cannot be told from it.
struct ClockLine {
  std::size_t first_reading = 0;  // counted over the whole stream
  Timestamp since{};              // host time of that reading
  std::uint64_t first_tick = 0;   // the counter then
  int counter_bits = 64;
  Timestamp offset{};  // where the line has first_tick
  double tick_s = 0;   // 0 where fewer than two ticks were seen and no maker states it
  std::optional<double> nominal_tick;
  std::uint64_t readings = 0;
  std::uint64_t outliers = 0;
  ResidualQuantiles residual_s;
  bool operator==(const ClockLine&) const = default;

  // Ticks since first_tick, the counter's wraps undone so that the line comes nearest to `near`.
  std::int64_t ticks(std::uint64_t tick, Timestamp near) const;
  Timestamp host(std::uint64_t tick, Timestamp near) const;
  // Parts per million by which the device's clock is slow; none without the maker's figure.
  std::optional<double> drift_ppm() const;
};

struct FittedReading {
  std::size_t line = 0;
  Timestamp fitted{};
  bool outlier = false;
};

// One reading at a time, in bounded memory. The first 64 readings of a line are fitted anew each time, later
// ones move it by their weight (Tukey's biweight at six times the spread).
class ClockFitter {
 public:
  explicit ClockFitter(ClockFitOptions options) : options_(options) {}

  // An outlier may turn out later to have been the first of a restarted clock: its line then says so by its
  // `first_reading`.
  FittedReading add(const ClockReading& reading);

  // The latest is still moving; quantiles are those of its last 1024 readings.
  std::vector<ClockLine> lines() const;

 private:
  void restart(std::span<const ClockReading> readings);
  void refit();
  void move_line(double ticks, double host_s, double residual_s);
  void remember(double residual_s);
  bool strange(const ClockReading& reading) const;
  bool restarted() const;
  double jump_s() const;

  ClockFitOptions options_;
  std::vector<ClockLine> closed_;
  ClockLine line_;
  std::vector<ClockReading> young_;
  std::deque<ClockReading> doubtful_;
  std::vector<double> residuals_;  // a ring of absolute values
  std::size_t next_residual_ = 0;
  std::size_t seen_ = 0;
  double spread_s_ = 0;
  double weight_ = 0, mean_tick_ = 0, mean_host_s_ = 0, tick_tick_ = 0, tick_host_ = 0;
};

// A whole stream.
struct ClockFit {
  std::vector<ClockLine> lines;
  std::vector<FittedReading> readings;  // one for each given
};
ClockFit fit_clock(std::span<const ClockReading> readings, const ClockFitOptions& options);

}  // namespace fude
