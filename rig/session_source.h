// A device made of its recording: the transfers of a session at their recorded distances, for whatever reads
// a live device.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "capture/session.h"
#include "rig/clock.h"
#include "signal/byte_source.h"

namespace fude {

// How a recording's time runs on a clock.
struct PlayTime {
  double speed = 1;      // times the recorded pace; above 0
  Timestamp recorded{};  // this time of the recording
  Timestamp played{};    // falls on this one of the clock

  // When what was recorded at `time` comes; to the nanosecond for times below a hundred days.
  Timestamp due(Timestamp time) const;
};

// Of one device, in their order.
std::vector<Transfer> transfers_of(const Session& session, DeviceNumber device);

// Transfers keep the stamps of the recording, so that a driver makes the same samples at every speed. One
// thread reads; any thread wakes.
class SessionSource final : public ByteSource {
 public:
  // `speed` times the recorded pace, on `clock`; 0: as fast as it is read, on a manual clock of its own.
  // Stands before the first transfer. Throws std::invalid_argument for a speed below 0 or not finite.
  SessionSource(std::vector<Transfer> transfers, double speed, std::shared_ptr<Clock> clock);

  // What was recorded at `recorded` comes at `played` on the clock. All that came before it is given first
  // and without waiting, for a fresh driver to stand as it stood then; see leading().
  void seek(Timestamp recorded, Timestamp played);

  // Whether the next transfer comes before the time that was sought: what the driver makes of it is no input.
  bool leading() const { return next_ < sought_; }

  // The recorded time of the next transfer; none at the end.
  std::optional<Timestamp> next_time() const;

  // `deadline` is on the source's clock. At the end of the recording: device_gone.
  Result<std::optional<Transfer>> read(std::optional<Timestamp> deadline) override;

  // Taken and forgotten: what the device answered stands in the recording.
  Result<void> write(const Transfer&) override { return {}; }

  void wake() override { waker_.wake(); }

 private:
  std::vector<Transfer> transfers_;
  std::shared_ptr<Clock> clock_;
  PlayTime time_;
  Waker waker_;
  std::size_t next_ = 0;
  std::size_t sought_ = 0;  // the first transfer that is not before the time sought
};

}  // namespace fude
