#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdio>

#include "calibration/delay/delay_estimate.h"
#include "calibration/delay/motion_fit.h"
#include "calibration/report.h"
#include "tests/fakes/scripted_strokes.h"
#include "tests/fakes/scripted_tracker.h"

namespace fude {
namespace {

// A hand's way: sums of sines between 0.3 and 4 Hz, drawn by the seed.
struct Hand {
  explicit Hand(std::uint32_t seed) {
    Noise random(seed);
    for (int i = 0; i < 12; ++i) {
      const double hz = random.uniform(0.3, 4);
      waves.push_back({random.vector(0.02 / hz), hz, random.uniform(0, 6.28)});
    }
  }
  struct Wave {
    Eigen::Vector3d size_m;
    double hz, phase;
  };
  std::vector<Wave> waves;
  Eigen::Vector3d at(double t) const {
    Eigen::Vector3d p = Eigen::Vector3d::Zero();
    for (const Wave& w : waves) p += w.size_m * std::sin(2 * M_PI * w.hz * t + w.phase);
    return p;
  }
};

Series seen(const Hand& hand, double hz, double length_s, double offset_s, double drift, double noise_m,
            const Eigen::Matrix3d& axes, std::uint32_t seed) {
  Noise random(seed);
  Series series;
  for (double t = random.uniform(0, 1 / hz); t < length_s; t += 1 / hz)
    series.add(t, axes * hand.at(t + offset_s + drift * t) + random.vector(noise_m));
  return series;
}

Eigen::Matrix3d turned(double angle) {
  return Eigen::AngleAxisd(angle, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
}

TEST(Motion, TwoTrackersInFramesOfTheirOwn) {
  const Hand hand(1);
  Witness a{.name = "a", .path = seen(hand, 120, 40, 0, 0, 1e-4, turned(0.3), 2)};
  for (const double offset_s : {0.00234, -0.2976, 1.5}) {
    Witness b{.name = "b", .path = seen(hand, 60, 40, offset_s, 0, 2e-4, 1.02 * turned(-2), 3)};
    const auto delay = delay_between(a, b, {});
    ASSERT_TRUE(delay) << delay.error();
    EXPECT_NEAR(delay->line.offset_s, offset_s, 0.2e-3);
    EXPECT_LT(delay->offset_ci95_s, 0.2e-3);
    EXPECT_EQ(delay->line.drift, 0);
  }
}

TEST(Motion, IntervalsHoldTheTruth) {
  int covered = 0;
  constexpr int sessions = 40;
  std::vector<double> errors_ms;
  for (std::uint32_t seed = 1; seed <= sessions; ++seed) {
    const Hand hand(seed);
    Witness a{.name = "a", .path = seen(hand, 120, 40, 0, 0, 2e-4, turned(0.3), 1000 + seed)};
    Witness b{.name = "b", .path = seen(hand, 60, 40, 0.0123, 0, 5e-4, turned(1), 2000 + seed)};
    const auto delay = delay_between(a, b, {.range_s = 0.2});
    ASSERT_TRUE(delay) << delay.error();
    const double error = delay->line.offset_s - 0.0123;
    errors_ms.push_back(1e3 * error);
    covered += std::abs(error) < delay->offset_ci95_s;
  }
  std::printf(
      "figure: delay by motion, 40 s at 120 and 60 Hz with 0.2 and 0.5 mm, %d sessions: rms %.3f ms, %d "
      "covered\n",
      sessions, root_mean_square(errors_ms), covered);
  EXPECT_GE(covered, 34);
}

TEST(Motion, ADriftIsFound) {
  const Hand hand(4);
  Witness a{.name = "a", .path = seen(hand, 100, 300, 0, 0, 1e-4, turned(0), 2)};
  Witness b{.name = "b", .path = seen(hand, 100, 300, 0.05, 60e-6, 1e-4, turned(1), 3)};
  const auto delay = delay_between(a, b, {});
  ASSERT_TRUE(delay) << delay.error();
  EXPECT_NEAR(1e6 * delay->line.drift, 60, 2);
  EXPECT_NEAR(delay->line.offset_s, 0.05 + 60e-6 * delay->line.reference_s, 0.2e-3);
  ASSERT_GT(delay->course.size(), 10U);
  EXPECT_NEAR(delay->course.back().offset_s - delay->course.front().offset_s,
              60e-6 * (delay->course.back().t_s - delay->course.front().t_s), 1e-3);
}

TEST(Motion, StrangersEvenMotionAndJumpingClocksAreNamed) {
  Witness a{.name = "a", .path = seen(Hand(1), 100, 40, 0, 0, 1e-4, turned(0), 2)};
  const auto refused = [&](const Witness& b, const std::string& cause) {
    const auto delay = delay_between(a, b, {});
    ASSERT_FALSE(delay) << cause;
    EXPECT_NE(delay.error().find(cause), std::string::npos) << delay.error();
  };
  refused({.name = "b", .path = seen(Hand(2), 100, 40, 0, 0, 1e-4, turned(0), 3)},
          "do not see the same motion");
  Series jumping = seen(Hand(1), 100, 40, 0, 0, 1e-4, turned(0), 4);
  for (std::size_t i = jumping.size() * 6 / 10; i < jumping.size(); ++i) jumping.t_s[i] += 0.4;
  refused({.name = "b", .path = jumping}, "started anew");
  Hand even(1);
  even.waves.resize(1);
  even.waves[0].hz = 1;
  a.path = seen(even, 100, 40, 0, 0, 1e-4, turned(0), 2);
  refused({.name = "b", .path = seen(even, 100, 40, 0.1, 0, 1e-4, turned(0), 3)}, "vary your speed");
}

// An inertial unit on the easel feels the brush come down and does not turn with it.
TEST(Motion, JoltsServeWhereNoTurningIsSeen) {
  const ScriptedStrokes script{.offset_s = 0.042};
  auto seen = script.seen(3);
  std::erase_if(seen.touches, [](const Touch& touch) { return !touch.down; });
  Noise random(1);
  Witness unit{.name = "imu", .touches = seen.touches}, tracker{.name = "tracker", .path = seen.path};
  for (const double t : seen.path.t_s) {
    unit.turn_rate.add(t, random.vector(0.01));
    tracker.turn_rate.add(t, random.vector(0.01));
  }
  const auto delay = delay_between(unit, tracker, {});
  ASSERT_TRUE(delay) << delay.error();
  EXPECT_NEAR(delay->line.offset_s, 0.042, 1e-3);
  const auto back = delay_between(tracker, unit, {});
  ASSERT_TRUE(back) << back.error();
  EXPECT_NEAR(back->line.offset_s, -delay->line.offset_s, 1e-9);
}

TEST(Pairs, TouchesFeltTwice) {
  Noise random(1);
  std::vector<Touch> a, b;
  double t = 1;
  for (int i = 0; i < 60; ++i) {
    t += random.uniform(0.4, 1.6);
    a.push_back({std::ceil(t / 0.002) * 0.002, 0.002, true});
    if (i % 9 != 0) b.push_back({std::ceil((t - 0.31) / 0.005) * 0.005, 0.005, true});
    if (i % 7 == 0) b.push_back({b.empty() ? t : b.back().t_s + 0.25, 0.005, true});
  }
  const Witness tablet{.name = "tablet", .touches = a}, unit{.name = "imu", .touches = b};
  const auto delay = delay_between(tablet, unit, {});
  ASSERT_TRUE(delay) << delay.error();
  EXPECT_NEAR(delay->line.offset_s, 0.31, 0.6e-3);
  EXPECT_NEAR(delay->line.offset_s, 0.31, 1.5 * delay->offset_ci95_s);
  for (Touch& touch : a) touch.t_s = 1 + double(&touch - a.data()) * 0.5;
  b = a;
  const auto even = delay_between({.name = "tablet", .touches = a}, {.name = "imu", .touches = b}, {});
  ASSERT_FALSE(even);
  EXPECT_NE(even.error().find("vary the time"), std::string::npos) << even.error();
}

}  // namespace
}  // namespace fude
