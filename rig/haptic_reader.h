// A force-feedback arm, read and driven a thousand times a second on a thread of its own.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <thread>

#include "drivers/falcon/falcon_decoder.h"
#include "drivers/falcon/haptic_loop.h"
#include "rig/device_reader.h"
#include "signal/result.h"

namespace fude {

struct HapticWish {
  falcon::HapticLoop::Feel feel;  // on the reading thread; empty: no force
  // The arm has no firmware, or will not take it: what to do. Once each absence, on the reading thread.
  std::function<void(const Error&)> refused;
  std::unique_ptr<falcon::LoopClock> clock = std::make_unique<falcon::MonotonicLoopClock>();
};

class HapticReader final : public Reader {
 public:
  // As DeviceReader; `decoder` does not poll.
  HapticReader(std::unique_ptr<ByteSource> source, FalconDecoder& decoder, Heard heard, HapticWish wish);
  ~HapticReader() override;  // stops
  HapticReader(const HapticReader&) = delete;
  HapticReader& operator=(const HapticReader&) = delete;

  bool stop() override;

  // After stop().
  falcon::HapticLoop::Counts counts() const { return loop_.counts(); }

 private:
  void serve();
  void say_what_is_missing();

  std::unique_ptr<ByteSource> source_;
  FalconDecoder& decoder_;
  HapticWish wish_;
  falcon::HapticLoop loop_;
  FalconDecoder::State state_ = FalconDecoder::State::unknown;  // at the last look
  std::atomic<bool> stopping_{false};
  std::atomic<bool> gone_{false};
  std::thread thread_;
};

}  // namespace fude
