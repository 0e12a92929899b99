#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "drivers/falcon/force_guard.h"
#include "drivers/falcon/ftdi.h"
#include "drivers/falcon/haptic_loop.h"
#include "drivers/falcon/simulated_arm.h"
#include "tests/fakes/falcon_arm.h"
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

struct Rig {
  ManualClock clock;
  FalconArm arm{clock};
  FalconDecoder decoder{{}, false};
  std::optional<Vector3d> wish = Vector3d(0, 2, 0);
  HapticLoop loop{arm, clock, decoder, [this](const HapticSample&) { return wish; }};

  void run(int periods) {
    for (int i = 0; i < periods; ++i) EXPECT_TRUE(loop.step());
  }
  bool forceless() const { return arm.sent.back().message.motors == std::array<std::int16_t, 3>{}; }
  bool never_a_force() const {
    return std::ranges::all_of(arm.sent, [](const FalconArm::Sent& sent) {
      return sent.message.motors == std::array<std::int16_t, 3>{};
    });
  }
};

// The message that would be read at that time.
Transfer said_at(const FromArm& state, Timestamp time) {
  auto bytes = octets({0x01, 0x60});
  append(bytes, write_from_arm(state));
  Transfer transfer = from_device(TransferKind::usb_bulk, bytes);
  transfer.time = time;
  return transfer;
}

TEST(HapticLoop, APeriodIsOneSampleAndOneMessage) {
  Rig rig;
  rig.run(1000);
  EXPECT_EQ(rig.loop.counts().pace.periods, 1000u);
  EXPECT_EQ(rig.loop.counts().pace.late, 0u);
  EXPECT_EQ(rig.loop.counts().samples, 1000u);
  EXPECT_EQ(rig.arm.sent.size(), 1001u);  // and the greeting
  EXPECT_EQ(rig.clock.now(), at_us(1'000'000 + 999'000));
  EXPECT_FALSE(rig.forceless());
}

TEST(HapticLoop, AnArmThatIsNotHomedFeelsNothing) {
  Rig rig;
  rig.arm.state.homed = 5;
  rig.run(50);
  EXPECT_TRUE(rig.never_a_force());
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
  EXPECT_TRUE(rig.never_a_force());
}

TEST(HapticLoop, GarbageWithoutEndDoesNotKeepTheForceFromFading) {
  Rig rig;
  rig.run(50);
  rig.arm.flooding = true;
  rig.run(21);
  EXPECT_TRUE(rig.forceless());
  EXPECT_GT(rig.decoder.counts().malformed, 0u);
}

TEST(HapticLoop, ForceIsAsFreshAsTheSampleThatItAnswers) {
  Rig rig;
  rig.run(50);
  rig.arm.muted = true;
  for (int i = 0; i < 30; ++i)
    rig.arm.instead.push_back(said_at({.homed = 7}, rig.clock.now() - std::chrono::milliseconds(20)));
  rig.run(21);
  EXPECT_TRUE(rig.forceless());
}

TEST(HapticLoop, ASampleFromTheFutureHoldsNoForce) {
  Rig rig;
  rig.run(50);
  rig.arm.muted = true;
  rig.arm.instead.push_back(said_at({.homed = 7}, rig.clock.now() + std::chrono::hours(1)));
  rig.run(1);
  rig.wish.reset();
  rig.run(21);
  EXPECT_TRUE(rig.forceless());
}

TEST(HapticLoop, WhatTheArmDoesNotTakeLetsGoOfTheForceAndEndsNothing) {
  Rig rig;
  std::uint64_t heard = 0;
  HapticLoop loop(
      rig.arm, rig.clock, rig.decoder, [&](const HapticSample&) { return rig.wish; },
      [&](const Transfer& t, const Decoded&) { heard += t.direction == Direction::to_device; });
  for (int i = 0; i < 50; ++i) ASSERT_TRUE(loop.step());
  rig.arm.full = true;
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(loop.step());
  EXPECT_EQ(loop.counts().unsent, 10u);
  const auto taken = heard;
  EXPECT_EQ(taken, rig.arm.sent.size() + 4);  // and the chip's setting up
  rig.arm.full = false;
  rig.arm.muted = true;
  ASSERT_TRUE(loop.step());
  EXPECT_TRUE(rig.forceless());
}

TEST(HapticLoop, ALatePeriodIsCountedAndNotMadeUpFor) {
  Rig rig;
  rig.run(10);
  rig.clock.oversleep(std::chrono::microseconds(7300));
  rig.run(10);
  EXPECT_EQ(rig.loop.counts().pace.late, 1u);
  EXPECT_EQ(rig.loop.counts().pace.periods, 20u);
}

TEST(HapticLoop, AnArmThatIsGoneEndsTheStep) {
  Rig rig;
  rig.run(5);
  rig.arm.gone = true;
  EXPECT_EQ(rig.loop.step().error().fault, Fault::device_gone);
}

TEST(HapticLoop, AnArmThatComesBackIsGreetedAgain) {
  Rig rig;
  rig.run(50);
  const auto before = rig.arm.sent.size();
  rig.arm.muted = true;
  rig.arm.instead.push_back(from_device(TransferKind::unplugged));
  rig.run(10);
  EXPECT_EQ(rig.arm.sent.size(), before);
  rig.arm.muted = false;
  rig.arm.instead.push_back(from_device(TransferKind::plugged));
  rig.wish.reset();
  rig.run(2);
  EXPECT_GT(rig.arm.sent.size(), before);
  EXPECT_TRUE(rig.forceless());
  EXPECT_EQ(rig.decoder.state(), FalconDecoder::State::running);
}

TEST(SimulatedArm, IsWhereTheHandIs) {
  const Vector3d places[] = {{0, 0, 0}, {0.02, 0.01, -0.01}, {-0.03, 0.02, 0.02}};
  for (const Vector3d& place : places) {
    SimulatedArm arm([&](Timestamp) { return place; });
    FalconDecoder decoder({}, false);
    for (const Transfer& transfer : decoder.greeting()) ASSERT_TRUE(arm.write(transfer));
    const auto answer = arm.read(Timestamp{});
    ASSERT_TRUE(answer && *answer);
    const auto sample = std::get<HapticSample>(decoded(decoder, **answer).samples.at(0));
    EXPECT_TRUE(sample.homed);
    EXPECT_LT((sample.position_m - place).norm(), 1e-4);  // a count is some hundredths of a millimetre
  }
}

TEST(SimulatedArm, BetweenItsAnswersTheChipSaysThatItIsThere) {
  SimulatedArm arm([](Timestamp) { return Vector3d::Zero(); });
  const auto status = arm.read(std::nullopt);
  ASSERT_TRUE(status && *status);
  EXPECT_TRUE(without_status((*status)->payload).empty());
  arm.wake();
  while (*arm.read(std::nullopt)) continue;  // until the wake-up
}

}  // namespace
}  // namespace fude
