#include <gtest/gtest.h>

#include <cmath>
#include <deque>
#include <limits>
#include <random>

#include "drivers/falcon/force_guard.h"
#include "drivers/falcon/ftdi.h"
#include "drivers/falcon/haptic_loop.h"
#include "tests/fakes/transfers.h"

namespace fude {
namespace {

using namespace falcon;
using Eigen::Vector3d;

Timestamp at_us(std::int64_t microseconds) { return Timestamp(std::chrono::microseconds(microseconds)); }

TEST(ForceGuard, ACommandIsReachedAtTheSlewAndHeld) {
  ForceGuard guard;
  guard.force_at(at_us(0));
  for (int us = 0; us <= 4000; us += 1000) {
    guard.command({0, 4, 0}, at_us(us));
    EXPECT_NEAR(guard.force_at(at_us(us)).y(), std::min(2000e-6 * us, 4.0), 1e-9);
  }
}

TEST(ForceGuard, FadesFromTenMillisecondsAndIsNothingAtTwenty) {
  ForceGuard guard;
  for (int us = 0; us <= 50'000; us += 1000) {
    guard.command({8, 0, 0}, at_us(us));
    guard.force_at(at_us(us));
  }
  EXPECT_NEAR(guard.force_at(at_us(60'000)).x(), 8, 1e-9);
  EXPECT_NEAR(guard.force_at(at_us(65'000)).x(), 4, 1e-9);
  EXPECT_GT(guard.force_at(at_us(69'999)).x(), 0);
  EXPECT_EQ(guard.force_at(at_us(70'000)), Vector3d::Zero());
  EXPECT_EQ(guard.force_at(at_us(10'000'000)), Vector3d::Zero());
}

TEST(ForceGuard, IsHeldAtTheLimitWhateverIsAsked) {
  for (double huge : {9.0, 1e6, 1e200, std::numeric_limits<double>::max()}) {
    ForceGuard guard;
    double largest = 0;
    for (int us = 0; us < 100'000; us += 1000) {
      guard.command({huge, -huge, huge}, at_us(us));
      largest = std::max(largest, guard.force_at(at_us(us)).norm());
    }
    EXPECT_LE(largest, 8 + 1e-9);
    EXPECT_GT(largest, 7.9);
  }
}

TEST(ForceGuard, WhatIsNoNumberIsNoForce) {
  ForceGuard guard;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinite = std::numeric_limits<double>::infinity();
  guard.command({1, 0, 0}, at_us(0));
  guard.force_at(at_us(0));
  EXPECT_GT(guard.force_at(at_us(1000)).x(), 0.9);
  for (const Vector3d& force : {Vector3d(nan, 0, 0), Vector3d(0, infinite, 0), Vector3d(-infinite, nan, 1)}) {
    guard.command(force, at_us(2000));
    EXPECT_EQ(guard.force_at(at_us(4000)), Vector3d::Zero());
  }
  EXPECT_EQ(guard.refused(), 3u);
}

// Any commands at any times, the clock going back among them: the promises hold at every moment.
TEST(ForceGuard, HoldsItsPromisesWhateverComes) {
  std::mt19937 generator(20260701);
  std::uniform_real_distribution<double> part(-1, 1);
  std::uniform_int_distribution<int> pick(0, 99);
  ForceGuard guard;
  std::int64_t now = 1'000'000;
  std::int64_t commanded = -1'000'000'000;
  std::int64_t latest = now;
  Vector3d before = guard.force_at(at_us(now));
  for (int i = 0; i < 200'000; ++i) {
    now += pick(generator) == 0 ? pick(generator) * 1000 - 20'000 : pick(generator) * 20;
    if (pick(generator) < 40) {
      const int kind = pick(generator);
      Vector3d force =
          Vector3d(part(generator), part(generator), part(generator)) * std::pow(10, 4 * part(generator));
      if (kind == 0) force.x() = std::numeric_limits<double>::quiet_NaN();
      if (kind == 1) force.y() = std::numeric_limits<double>::infinity();
      guard.command(force, at_us(now));
      commanded = now;
    }
    const Vector3d force = guard.force_at(at_us(now));
    ASSERT_TRUE(force.allFinite());
    ASSERT_LE(force.norm(), 8 + 1e-9);
    if (now - commanded >= 20'000) {
      ASSERT_EQ(force, Vector3d::Zero());
    }
    // It may fade faster than the slew, but never grow faster.
    const double passed_s = static_cast<double>(std::max<std::int64_t>(0, now - latest)) * 1e-6;
    ASSERT_LE(force.norm(), before.norm() + 2000 * passed_s + 1e-9);
    latest = std::max(latest, now);
    before = force;
  }
}

// A clock that only the loop moves, by sleeping; it may oversleep.
class ManualClock final : public LoopClock {
 public:
  Timestamp now() override { return now_; }
  void sleep_until(Timestamp time) override {
    now_ = std::max(now_, time) + std::exchange(oversleep_, Duration(0));
  }
  void oversleep(Duration by) { oversleep_ = by; }

 private:
  Timestamp now_ = at_us(1'000'000);
  Duration oversleep_{0};
};

// An arm that answers each message a period later, from where the test says it is.
class FakeArm final : public ByteSource {
 public:
  explicit FakeArm(ManualClock& clock) : clock_(clock) {}

  Result<std::optional<Transfer>> read(std::optional<Timestamp>) override {
    if (gone) return failure(Fault::device_gone, "gone");
    if (answers_.empty() || muted) return std::nullopt;
    Transfer transfer = std::move(answers_.front());
    answers_.pop_front();
    transfer.time = clock_.now();
    return std::optional(transfer);
  }
  Result<void> write(const Transfer& transfer) override {
    const auto message = read_to_arm(transfer.payload);
    if (!message) return {};
    sent.push_back(*message);
    auto bytes = octets({0x01, 0x60});
    append(bytes, write_from_arm(state));
    answers_.push_back(from_device(TransferKind::usb_bulk, bytes));
    return {};
  }
  void wake() override {}

  FromArm state{.homed = 7};
  bool muted = false;
  bool gone = false;
  std::vector<ToArm> sent;

 private:
  ManualClock& clock_;
  std::deque<Transfer> answers_;
};

struct Rig {
  ManualClock clock;
  FakeArm arm{clock};
  FalconDecoder decoder{{}, false};
  std::optional<Vector3d> wish = Vector3d(0, 2, 0);
  HapticLoop loop{arm, clock, decoder, [this](const HapticSample&) { return wish; }};

  Rig() {
    for (const Transfer& t : decoder.greeting()) EXPECT_TRUE(arm.write(t));
  }
  void run(int periods) {
    for (int i = 0; i < periods; ++i) EXPECT_TRUE(loop.step());
  }
  bool forceless() const { return arm.sent.back().motors == std::array<std::int16_t, 3>{}; }
};

TEST(HapticLoop, APeriodIsOneSampleAndOneMessage) {
  Rig rig;
  rig.run(1000);
  EXPECT_EQ(rig.loop.counts().periods, 1000u);
  EXPECT_EQ(rig.loop.counts().samples, 1000u);
  EXPECT_EQ(rig.loop.counts().late, 0u);
  EXPECT_EQ(rig.arm.sent.size(), 1001u);
  EXPECT_EQ(rig.clock.now(), at_us(1'000'000 + 999'000));
  EXPECT_FALSE(rig.forceless());
}

TEST(HapticLoop, AnArmThatIsNotHomedFeelsNothing) {
  Rig rig;
  rig.arm.state.homed = 5;
  rig.run(50);
  for (const ToArm& message : rig.arm.sent) EXPECT_EQ(message.motors, (std::array<std::int16_t, 3>{}));
}

TEST(HapticLoop, WhenNobodyRenewsTheForceItIsGoneInTwentyMilliseconds) {
  Rig rig;
  rig.run(50);
  EXPECT_FALSE(rig.forceless());
  rig.wish.reset();
  rig.run(21);
  EXPECT_TRUE(rig.forceless());
}

TEST(HapticLoop, WhenTheArmFallsSilentTheForceIsGoneToo) {
  Rig rig;
  rig.run(50);
  rig.arm.muted = true;
  rig.run(21);
  EXPECT_TRUE(rig.forceless());
}

TEST(HapticLoop, AWishThatIsNoNumberIsNoForce) {
  Rig rig;
  rig.wish = Vector3d(std::nan(""), 0, 0);
  rig.run(50);
  for (const ToArm& message : rig.arm.sent) EXPECT_EQ(message.motors, (std::array<std::int16_t, 3>{}));
}

TEST(HapticLoop, ALatePeriodIsCountedAndNotMadeUpFor) {
  Rig rig;
  rig.run(10);
  rig.clock.oversleep(std::chrono::microseconds(7300));
  rig.run(10);
  EXPECT_EQ(rig.loop.counts().late, 1u);
  EXPECT_EQ(rig.loop.counts().periods, 20u);
}

TEST(HapticLoop, AnArmThatIsGoneEndsTheStep) {
  Rig rig;
  rig.run(5);
  rig.arm.gone = true;
  EXPECT_EQ(rig.loop.step().error().fault, Fault::device_gone);
}

}  // namespace
}  // namespace fude
