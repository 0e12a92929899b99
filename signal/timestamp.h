// Time: nanoseconds on CLOCK_MONOTONIC, or on the clock of the recording that a sample came from.
// No conversion from wall time exists, and nothing is ever stamped again.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

namespace fude {

using Duration = std::chrono::nanoseconds;

// Names CLOCK_MONOTONIC in the type. It has no now(): only transports and the rig's clock read it.
struct MonotonicClock {
  using rep = Duration::rep;
  using period = Duration::period;
  using duration = Duration;
  using time_point = std::chrono::time_point<MonotonicClock>;
  static constexpr bool is_steady = true;
};
using Timestamp = MonotonicClock::time_point;

// Who put the time on a sample.
enum class StampedBy : std::uint8_t {
  kernel,     // EVIOCSCLOCKID, V4L2 buffer time
  arrival,    // read on return from the transport
  recording,  // the file it was imported from
};

// Host time, device tick and sequence number travel together; a gap in the sequence is a loss.
struct SampleTime {
  Timestamp host{};
  StampedBy stamped_by = StampedBy::kernel;
  std::uint64_t sequence = 0;
  std::optional<std::uint64_t> device_tick;
  bool operator==(const SampleTime&) const = default;
};

inline double seconds(Duration d) { return std::chrono::duration<double>(d).count(); }

}  // namespace fude
