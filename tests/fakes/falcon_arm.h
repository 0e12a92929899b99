// A Novint Falcon on a clock that only the loop moves, with the faults that an arm or its wire may have.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <atomic>
#include <deque>
#include <functional>
#include <utility>
#include <vector>

#include "drivers/falcon/loop_clock.h"
#include "drivers/falcon/message.h"
#include "signal/byte_source.h"

namespace fude {

// Moved by sleeping alone. It may be read from other threads.
class ManualClock final : public falcon::LoopClock {
 public:
  Timestamp now() override { return Timestamp(Duration(now_ns_)); }
  void sleep_until(Timestamp time) override {
    now_ns_ =
        std::max(now(), time).time_since_epoch().count() + std::exchange(oversleep_, Duration(0)).count();
    if (woke) woke(now());
  }
  void oversleep(Duration by) { oversleep_ = by; }

  std::function<void(Timestamp)> woke;  // at each time that it comes to

 private:
  std::atomic<Duration::rep> now_ns_ = 1'000'000'000;
  Duration oversleep_{0};
};

// A Falcon after power-on, as the documents describe it.
class PowerOn {
 public:
  explicit PowerOn(std::vector<std::byte> image) : image_(std::move(image)) {}

  // What it sends back for what it got, without the chip's status.
  std::vector<std::byte> hear(const Transfer& sent);

  void spoil(int block) { spoil_ = block; }  // of the next image; comes back wrong
  bool loaded() const { return received_ == image_; }

 private:
  std::vector<std::byte> image_;
  std::vector<std::byte> received_;
  bool receiving_ = false;
  int spoil_ = 0;
};

// Answers each message a period later, from where the test says that it is. All but wake() on one thread.
class FalconArm final : public ByteSource {
 public:
  struct Sent {
    Timestamp time;
    falcon::ToArm message;
  };

  explicit FalconArm(ManualClock& clock) : clock_(clock) {}

  Result<std::optional<Transfer>> read(std::optional<Timestamp> deadline) override;
  Result<void> write(const Transfer& transfer) override;
  void wake() override {}

  falcon::FromArm state{.homed = 7};
  PowerOn firmware{{}};          // loaded from the start, unless an image is asked for
  bool muted = false;            // keeps what it would say to itself
  bool full = false;             // takes nothing
  bool gone = false;             // says so once, and is away
  bool flooding = false;         // garbage without end
  std::deque<Transfer> instead;  // what it says first, as it stands
  std::vector<Sent> sent;        // all messages to the running arm

 private:
  std::vector<std::byte> answer(const Transfer& transfer);
  Transfer packet(const std::vector<std::byte>& bytes) const;

  ManualClock& clock_;
  std::deque<std::vector<std::byte>> answers_;
  Timestamp next_status_{};
  bool told_gone_ = false;
};

}  // namespace fude
