// The loop that feels: a thousand times a second the arm's position in, and a guarded force out.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "drivers/falcon/falcon_decoder.h"
#include "drivers/falcon/force_guard.h"
#include "drivers/falcon/loop_clock.h"
#include "signal/byte_source.h"
#include "signal/haptic_sample.h"

namespace fude::falcon {

// It greets the arm, again each time that it is plugged in, and speaks for the decoder, which does not poll
// (see there).
class HapticLoop {
 public:
  // The force at the grip for this sample, newtons; it is asked once a sample, when the arm is homed, and may
  // not wait. None: no new command, and the last one fades.
  using Feel = std::function<std::optional<Eigen::Vector3d>(const HapticSample&)>;
  // All that crossed the wire, in its order, for a recorder.
  using Hear = std::function<void(const Transfer&, const Decoded&)>;

  struct Counts {
    Pace::Counts pace;
    std::uint64_t samples = 0;
    std::uint64_t unsent = 0;  // transfers that the arm would not take
  };

  HapticLoop(ByteSource& source, LoopClock& clock, FalconDecoder& decoder, Feel feel = {}, Hear hear = {},
             ForceGuard guard = ForceGuard());

  // One period: waits for its time, reads what there is, sends a force. Without a sample, a homed arm or a
  // fresh command the force is zero; a command counts from the stamp of the sample that it answers. What the
  // arm does not take releases the guard and ends nothing. Errors: those of the source's read().
  Result<void> step();

  // The last word: no force. Nobody knows how long an arm holds the one before.
  void part();

  Counts counts() const { return {pace_.counts(), samples_, unsent_}; }

 private:
  Result<void> listen();
  void answer(const HapticSample& sample);
  void speak();
  void send(const std::vector<Transfer>& transfers);
  void let_go();

  ByteSource& source_;
  LoopClock& clock_;
  FalconDecoder& decoder_;
  Feel feel_;
  Hear hear_;
  ForceGuard guard_;
  Pace pace_;
  bool greeted_ = false;
  std::optional<HapticSample> last_;
  std::uint64_t samples_ = 0;
  std::uint64_t unsent_ = 0;
};

}  // namespace fude::falcon
