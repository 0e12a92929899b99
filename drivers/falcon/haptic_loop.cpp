#include "drivers/falcon/haptic_loop.h"

#include <ctime>
#include <utility>
#include <variant>

#include "drivers/falcon/ftdi.h"
#include "drivers/transport/waker.h"

namespace fude::falcon {

Timestamp MonotonicLoopClock::now() { return monotonic_now(); }

void MonotonicLoopClock::sleep_until(Timestamp time) {
  const auto since = time.time_since_epoch();
  const auto whole = std::chrono::duration_cast<std::chrono::seconds>(since);
  const timespec until{static_cast<time_t>(whole.count()), static_cast<long>((since - whole).count())};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) != 0) continue;
}

HapticLoop::HapticLoop(ByteSource& source, LoopClock& clock, FalconDecoder& decoder, Feel feel, Hear hear,
                       ForceGuard guard, Duration period)
    : source_(source),
      clock_(clock),
      decoder_(decoder),
      feel_(std::move(feel)),
      hear_(std::move(hear)),
      guard_(guard),
      period_(period) {}

Result<void> HapticLoop::step() {
  if (due_) clock_.sleep_until(*due_);
  const Timestamp now = clock_.now();
  if (due_ && now - *due_ > period_ / 2) {
    ++counts_.late;
    due_ = now;
  }
  due_ = due_.value_or(now) + period_;
  ++counts_.periods;
  auto done = listen();
  if (done) done = speak();
  if (!done) guard_.release();
  return done;
}

Result<void> HapticLoop::listen() {
  for (;;) {
    auto read = source_.read(clock_.now());
    if (!read) return tl::unexpected(read.error());
    if (!*read) return {};
    Decoded out;
    decoder_.decode(**read, out);
    if (hear_) hear_(**read, out);
    for (const Transfer& reply : out.replies)
      if (auto written = source_.write(reply); !written) return written;
    for (const Sample& sample : out.samples) {
      const auto* haptic = std::get_if<HapticSample>(&sample);
      if (haptic == nullptr) continue;
      ++counts_.samples;
      last_ = *haptic;
      if (!haptic->homed) {
        guard_.release();
      } else if (const auto force = feel_(*haptic)) {
        guard_.command(*force, clock_.now());
      }
    }
    if ((*read)->kind == TransferKind::unplugged) {
      last_.reset();
      guard_.release();
    }
  }
}

Result<void> HapticLoop::speak() {
  if (decoder_.state() != FalconDecoder::State::running) return {};
  const bool homed = last_ && last_->homed;
  const Eigen::Vector3d force = guard_.force_at(clock_.now());
  const Eigen::Vector3d position = workspace_middle() + (homed ? last_->position_m : Eigen::Vector3d::Zero());
  Transfer transfer = bulk(
      write_to_arm(force_message(position, homed ? force : Eigen::Vector3d::Zero(), homed ? green : red)));
  transfer.time = clock_.now();
  Decoded none;
  decoder_.decode(transfer, none);
  if (hear_) hear_(transfer, none);
  return source_.write(transfer);
}

}  // namespace fude::falcon
