// How well a stream comes: how many, how evenly, what was lost, and how its clock lies on the host's.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "signal/clock_fit.h"
#include "signal/device.h"
#include "signal/sample.h"

namespace fude {

// The last bin of a histogram is for what is longer than all of these.
inline constexpr std::array jitter_bins_us{50, 100, 200, 500, 1000, 2000, 5000};

struct StreamFigures {
  std::int64_t received = 0;
  std::int64_t gaps = 0;  // samples after a loss or an absence
  double rate_hz = 0;     // of reports: one over the median interval between host times; 0 below two
  struct Spread {         // microseconds
    double p50 = 0;
    double p99 = 0;
    double largest = 0;
  };
  Spread jitter_us;  // of the intervals about their median
  std::array<std::int64_t, jitter_bins_us.size() + 1> jitter_histogram{};
  Spread delay_us;               // from the transfer's stamp to the sample
  std::vector<ClockLine> clock;  // none where the device states no ticks
};

// One stream of one device, in bounded memory: the quantiles are those of the last 65 536 intervals
// and delays. Samples
// of one report share its host time and count as one for rate and jitter; intervals across a gap do not
// count.
class StreamMeter {
 public:
  explicit StreamMeter(std::optional<DeviceClock> clock);

  void add(const SampleTime& time, bool after_gap);
  // How long after its stamp a transfer had become samples.
  void decoded_after(Duration delay);

  StreamFigures figures() const;

 private:
  std::optional<ClockFitter> fitter_;
  std::int64_t received_ = 0;
  std::int64_t gaps_ = 0;
  std::optional<Timestamp> last_;
  // Each a ring.
  std::vector<std::int64_t> intervals_ns_;
  std::size_t next_interval_ = 0;
  std::vector<std::int64_t> delays_ns_;
  std::size_t next_delay_ = 0;
};

}  // namespace fude
