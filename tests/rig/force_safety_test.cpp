// What a force may be (firmware-notes/falcon.md), from the brush's thread to the wire: never without a
// number, never above the limit, and nothing 20 ms after the last model's validity.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <random>
#include <thread>

#include "drivers/falcon/falcon_decoder.h"
#include "drivers/falcon/force_guard.h"
#include "drivers/falcon/kinematics.h"
#include "rig/arm_on_paper.h"
#include "rig/haptic_reader.h"
#include "tests/fakes/falcon_arm.h"

namespace fude {
namespace {

using namespace falcon;
using Eigen::Vector3d;

constexpr Duration expires = std::chrono::milliseconds(20);
constexpr double a_motor_count_n = 0.01;  // what rounding to counts may add at the grip

Timestamp later(Timestamp time, std::int64_t ms) { return time + std::chrono::milliseconds(ms); }

// The grip stands still in the middle, so that motors are forces.
struct Watch {
  ForceGuard::Options limits;
  std::uint64_t messages = 0;
  std::uint64_t with_force = 0;
  double largest_n = 0;
  bool finite = true;
  bool in_time = true;

  void see(const FalconArm::Sent& sent, Timestamp valid_until) {
    ++messages;
    const auto& motors = sent.message.motors;
    if (motors == std::array<std::int16_t, 3>{}) return;
    ++with_force;
    in_time = in_time && sent.time < valid_until + expires;
    constexpr double counts_per_nm = 10'000;
    const double angle = leg_angle(0);
    const auto force = grip_force(*grip_position({angle, angle, angle}, workspace_middle()),
                                  -Vector3d(motors[0], motors[1], motors[2]) / counts_per_nm);
    finite = finite && force && force->allFinite();
    if (force) largest_n = std::max(largest_n, force->norm());
  }
};

// Any model that a solver gone mad could make.
ContactModel any_model(std::mt19937& random, Timestamp now) {
  std::uniform_real_distribution<double> part(-1, 1);
  std::uniform_int_distribution<int> pick(0, 99);
  ContactModel model;
  for (int i = 0; i < 3; ++i) {
    model.wrench.force_n[i] = part(random) * std::pow(10, 3 * part(random));
    model.paper_from_handle.translation[i] = 20 * part(random);
  }
  for (double& k : model.stiffness.reshaped()) k = part(random) * std::pow(10, 2 * part(random));
  const int kind = pick(random);
  if (kind == 0) model.wrench.force_n.x() = std::numeric_limits<double>::quiet_NaN();
  if (kind == 1) model.wrench.force_n.z() = std::numeric_limits<double>::infinity();
  if (kind == 2) model.stiffness(2, 2) = -std::numeric_limits<double>::max();
  if (kind == 3) model.stiffness(0, 0) = std::numeric_limits<double>::quiet_NaN();
  model.valid_until = later(now, pick(random) - 20);
  return model;
}

struct Trial {
  std::unique_ptr<ManualClock> own_clock = std::make_unique<ManualClock>();
  ManualClock& clock = *own_clock;
  std::unique_ptr<FalconArm> own_arm = std::make_unique<FalconArm>(clock);
  FalconArm& arm = *own_arm;
  FalconDecoder decoder{{}, false};
  Newest<ContactModel> models;
  Watch watch;
  std::atomic<bool> ended{false};

  std::unique_ptr<HapticReader> start(Reader::Heard heard = [](const Transfer&, std::span<const Sample>) {}) {
    HapticWish wish;
    wish.feel = feel_of(models, {});
    wish.clock = std::move(own_clock);
    return std::make_unique<HapticReader>(std::move(own_arm), decoder, std::move(heard), std::move(wish));
  }
  void see_all(Timestamp valid_until) {
    for (const FalconArm::Sent& sent : arm.sent) watch.see(sent, valid_until);
    arm.sent.clear();
  }
  void wait() const {
    while (!ended) std::this_thread::yield();
  }
};

// Brush and arm fail in turn and together: models are mad, late or missing; the arm falls silent, floods,
// takes nothing, forgets its zero, tells of other times, comes and goes; the loop oversleeps.
TEST(ForceSafety, HoldsThroughEveryFaultOfBrushAndArm) {
  Trial trial;
  std::mt19937 random(20261122);
  std::uniform_int_distribution<int> pick(0, 999);
  Timestamp valid_until{};
  std::int64_t now_ms = 0;
  trial.clock.woke = [&](Timestamp now) {
    trial.see_all(valid_until);
    const int fault = pick(random);
    FalconArm& arm = trial.arm;
    if (fault < 20) arm.muted = !arm.muted;
    if (fault >= 20 && fault < 30) arm.flooding = !arm.flooding;
    if (fault >= 30 && fault < 40) arm.full = !arm.full;
    if (fault >= 40 && fault < 50) arm.state.homed = arm.state.homed == 7 ? 3 : 7;
    if (fault >= 50 && fault < 55) arm.instead.push_back({.time = now, .kind = TransferKind::unplugged});
    if (fault >= 55 && fault < 60) arm.instead.push_back({.time = now, .kind = TransferKind::plugged});
    if (fault >= 60 && fault < 65) arm.instead.push_back({.time = now, .kind = TransferKind::suspended});
    if (fault >= 65 && fault < 75) {
      Transfer strange{.time = later(now, pick(random) - 500), .kind = TransferKind::usb_bulk};
      for (int i = 0; i < 40; ++i) strange.payload.push_back(static_cast<std::byte>(random()));
      arm.instead.push_back(std::move(strange));
    }
    if (fault >= 75 && fault < 80) trial.clock.oversleep(std::chrono::milliseconds(pick(random) % 60));
    if (fault >= 100 && fault < 200) {
      // All is well again.
      arm.muted = arm.flooding = arm.full = false;
      arm.state.homed = 7;
    }
    if (pick(random) < 300) {
      const ContactModel model = any_model(random, now);
      valid_until = std::max(valid_until, model.valid_until);
      trial.models.put(model);
    }
    if (++now_ms == 60'000) trial.ended = true;
  };
  const auto reader = trial.start();
  trial.wait();
  EXPECT_FALSE(reader->stop());
  EXPECT_TRUE(trial.watch.finite);
  EXPECT_TRUE(trial.watch.in_time);
  EXPECT_LE(trial.watch.largest_n, trial.watch.limits.limit_n + a_motor_count_n);
  EXPECT_GT(trial.watch.with_force, 1000u);  // or nothing was tried
}

// The brush stops for good while a hand presses: at every phase of the loop nothing is left after 20 ms.
TEST(ForceSafety, ABrushThatStopsLetsGoWithinTwentyMilliseconds) {
  for (int valid_ms = 0; valid_ms < 30; valid_ms += 3) {
    Trial trial;
    int now_ms = 0;
    Timestamp valid_until{};
    trial.clock.woke = [&](Timestamp now) {
      trial.see_all(valid_until);
      if (++now_ms <= 100) {
        valid_until = later(now, valid_ms);
        trial.models.put(paper_plane(10, valid_until));
      }
      if (now_ms == 200) trial.ended = true;
    };
    const auto reader = trial.start();
    trial.wait();
    EXPECT_FALSE(reader->stop());
    EXPECT_TRUE(trial.watch.in_time) << valid_ms;
    EXPECT_GT(trial.watch.with_force, 50u) << valid_ms;
  }
}

// The brush on a thread of its own, as it is: what the loop looks at is whole.
TEST(ForceSafety, HoldsWithABrushOnAnotherThread) {
  Trial trial;
  int now_ms = 0;
  std::atomic<bool> brush_done{false};
  std::atomic<Duration::rep> last_valid_until{0};
  trial.clock.woke = [&](Timestamp) {
    // A model's time is told before the model is put: the loop cannot know one of which we do not.
    trial.see_all(Timestamp(Duration(last_valid_until)));
    if (++now_ms >= 5000 && brush_done) trial.ended = true;
  };
  const auto reader = trial.start();
  std::mt19937 random(7);
  for (int i = 0; i < 20'000; ++i) {
    const ContactModel model = any_model(random, trial.clock.now());
    last_valid_until = std::max(last_valid_until.load(), model.valid_until.time_since_epoch().count());
    trial.models.put(model);
  }
  brush_done = true;
  trial.wait();
  EXPECT_FALSE(reader->stop());
  EXPECT_TRUE(trial.watch.finite);
  EXPECT_TRUE(trial.watch.in_time);
  EXPECT_LE(trial.watch.largest_n, trial.watch.limits.limit_n + a_motor_count_n);
}

TEST(ForceSafety, TheLastWordIsNoForce) {
  Trial trial;
  std::optional<ToArm> last;
  int with_force = 0;
  trial.clock.woke = [&, ms = 0](Timestamp now) mutable {
    trial.models.put(paper_plane(10, later(now, 20)));
    if (++ms == 100) trial.ended = true;
  };
  const auto reader = trial.start([&](const Transfer& transfer, std::span<const Sample>) {
    if (transfer.direction != Direction::to_device) return;
    last = read_to_arm(transfer.payload);
    with_force += last && last->motors != std::array<std::int16_t, 3>{};
  });
  trial.wait();
  EXPECT_FALSE(reader->stop());
  EXPECT_GT(with_force, 50);
  ASSERT_TRUE(last);
  EXPECT_EQ(last->motors, (std::array<std::int16_t, 3>{}));
}

}  // namespace
}  // namespace fude
