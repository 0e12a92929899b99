#include "drivers/falcon/haptic_loop.h"

#include <algorithm>
#include <utility>
#include <variant>

#include "drivers/falcon/ftdi.h"

namespace fude::falcon {
namespace {

// An arm sends one packet a period. Whoever floods must not keep the force from fading.
constexpr int most_heard = 64;

}  // namespace

HapticLoop::HapticLoop(ByteSource& source, LoopClock& clock, FalconDecoder& decoder, Feel feel, Hear hear,
                       ForceGuard guard)
    : source_(source),
      clock_(clock),
      decoder_(decoder),
      feel_(std::move(feel)),
      hear_(std::move(hear)),
      guard_(guard),
      pace_(clock) {}

Result<void> HapticLoop::step() {
  pace_.wait();
  if (!std::exchange(greeted_, true)) send(decoder_.greeting());
  auto heard = listen();
  if (!heard) {
    let_go();
    return heard;
  }
  speak();
  return {};
}

void HapticLoop::part() {
  let_go();
  speak();
}

void HapticLoop::let_go() {
  last_.reset();
  guard_.release();
}

Result<void> HapticLoop::listen() {
  for (int i = 0; i < most_heard; ++i) {
    auto read = source_.read(clock_.now());
    if (!read) return tl::unexpected(read.error());
    if (!*read) return {};
    const TransferKind kind = (*read)->kind;
    Decoded out;
    decoder_.decode(**read, out);
    if (hear_) hear_(**read, out);
    send(out.replies);
    for (const Sample& sample : out.samples)
      if (const auto* haptic = std::get_if<HapticSample>(&sample)) answer(*haptic);
    if (kind == TransferKind::unplugged || kind == TransferKind::suspended) let_go();
    if (kind == TransferKind::plugged) send(decoder_.greeting());
  }
  return {};
}

void HapticLoop::answer(const HapticSample& sample) {
  ++samples_;
  last_ = sample;
  if (!sample.homed)
    guard_.release();
  else if (const auto force = feel_ ? feel_(sample) : std::nullopt)
    guard_.command(*force, std::min(sample.time.host, clock_.now()));
}

void HapticLoop::speak() {
  if (decoder_.state() != FalconDecoder::State::running) return;
  const bool homed = last_ && last_->homed;
  const Eigen::Vector3d force = guard_.force_at(clock_.now());
  const Eigen::Vector3d position = workspace_middle() + (homed ? last_->position_m : Eigen::Vector3d::Zero());
  send({bulk(
      write_to_arm(force_message(position, homed ? force : Eigen::Vector3d::Zero(), homed ? green : red)))});
}

void HapticLoop::send(const std::vector<Transfer>& transfers) {
  for (Transfer transfer : transfers) {
    transfer.direction = Direction::to_device;
    transfer.time = clock_.now();
    transfer.stamped_by = StampedBy::arrival;
    if (!source_.write(transfer)) {
      ++unsent_;
      let_go();
      continue;
    }
    Decoded none;
    decoder_.decode(transfer, none);
    if (hear_) hear_(transfer, none);
  }
}

}  // namespace fude::falcon
