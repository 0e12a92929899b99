// The loop that feels: a thousand times a second the arm's position in, and a guarded force out.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>

#include "drivers/falcon/falcon_decoder.h"
#include "drivers/falcon/force_guard.h"
#include "signal/byte_source.h"
#include "signal/haptic_sample.h"

namespace fude::falcon {

// The clock that a loop lives by; tests move it by hand.
class LoopClock {
 public:
  virtual ~LoopClock() = default;
  virtual Timestamp now() = 0;
  virtual void sleep_until(Timestamp time) = 0;
};

class MonotonicLoopClock final : public LoopClock {
 public:
  Timestamp now() override;
  void sleep_until(Timestamp time) override;
};

// The decoder does not poll (see there), and its greeting has been sent.
class HapticLoop {
 public:
  // The force at the grip for this sample, newtons; it is asked once a sample, when the arm is homed, and may
  // not wait. None: no new command, and the last one fades.
  using Feel = std::function<std::optional<Eigen::Vector3d>(const HapticSample&)>;
  using Hear =
      std::function<void(const Transfer&, const Decoded&)>;  // all that crossed the wire, for a recorder

  struct Counts {
    std::uint64_t periods = 0;
    std::uint64_t late =
        0;  // begun more than half a period after their time; those missed are not made up for
    std::uint64_t samples = 0;
  };

  HapticLoop(ByteSource& source, LoopClock& clock, FalconDecoder& decoder, Feel feel, Hear hear = {},
             ForceGuard guard = ForceGuard(), Duration period = std::chrono::milliseconds(1));

  // One period: waits for its time, reads what there is, sends a force. Without a sample, a homed arm or a
  // fresh command the force is zero. Errors as of the source; the guard is released then.
  Result<void> step();

  const Counts& counts() const { return counts_; }

 private:
  Result<void> listen();
  Result<void> speak();

  ByteSource& source_;
  LoopClock& clock_;
  FalconDecoder& decoder_;
  Feel feel_;
  Hear hear_;
  ForceGuard guard_;
  Duration period_;
  std::optional<Timestamp> due_;
  std::optional<HapticSample> last_;
  Counts counts_;
};

}  // namespace fude::falcon
