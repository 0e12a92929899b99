// Any readings of any clock: every one is answered, and no line is other than finite.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "signal/clock_fit.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fude;
  if (size < 2) return 0;
  constexpr int widths[] = {8, 16, 32, 64};
  ClockFitOptions options{.clock = {.counter_bits = widths[data[0] % 4]}};
  if (data[0] & 4) options.clock.nominal_tick = data[1] * 1e-4;
  const bool steps = data[0] & 8;  // small steps keep to a line, whole numbers leap about
  std::vector<ClockReading> readings;
  ClockReading last;
  for (std::size_t at = 2; at + 16 <= size && readings.size() < 3000; at += steps ? 3 : 16) {
    if (steps) {
      last.host += Duration(data[at] * 100'000 + data[at + 1]);
      last.tick += data[at + 2];
    } else {
      std::int64_t ns = 0;
      std::memcpy(&ns, data + at, 8);
      last.host = Timestamp(Duration(ns / 4));
      std::memcpy(&last.tick, data + at + 8, 8);
    }
    readings.push_back(last);
  }
  const ClockFit fit = fit_clock(readings, options);
  if (fit.readings.size() != readings.size()) __builtin_trap();
  for (const ClockLine& line : fit.lines)
    if (!std::isfinite(line.tick_s) || !std::isfinite(line.residual_s.largest)) __builtin_trap();
  return 0;
}
