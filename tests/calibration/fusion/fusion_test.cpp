#include "calibration/fusion/fusion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "signal/units.h"
#include "tests/calibration/fusion/simulated_hand.h"

namespace fude {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// A 1 kHz inertial unit and whatever fixes a test adds.
class Rig {
 public:
  explicit Rig(const FusionSettings& settings = {}, unsigned seed = 1)
      : fusion(settings), noise(seed), settings_(settings) {}

  void inertial(double t) {
    fusion.add(noise.onto(hand.reading(t, step_s), step_s, settings_.noise), at_second(t));
  }
  FixResult point(double t, double sigma_m, const Eigen::Vector3d& offset = Eigen::Vector3d::Zero()) {
    PointFix fix{.point_m = hand.position(t) + offset + noise.vector(sigma_m)};
    fix.covariance_m2 = Eigen::Matrix3d::Identity() * sigma_m * sigma_m;
    return fusion.add(fix, at_second(t));
  }
  Eigen::Vector3d error(double t) const { return fusion.pose().point_m - hand.position(t); }

  static constexpr double step_s = 1e-3;
  SimulatedHand hand;
  Fusion fusion;
  SimulatedNoise noise;

 private:
  FusionSettings settings_;
};

// Divides t by a period of so many milliseconds.
bool due(int ms, int period_ms) { return ms % period_ms == 0; }

TEST(Fusion, InnovationsAreAsLargeAsTheFilterBelieves) {
  double sum = 0;
  int rows = 0;
  for (unsigned seed = 1; seed <= 10; ++seed) {
    FusionSettings settings;
    settings.start_velocity_mps = 0.3;
    Rig rig(settings, seed);
    for (int ms = 1; ms <= 10000; ++ms) {
      rig.inertial(ms * 1e-3);
      if (!due(ms, 10)) continue;
      const FixResult result = rig.point(ms * 1e-3, 1e-3);
      if (ms <= 2000) continue;
      EXPECT_NE(result.outcome, FixOutcome::unsound);
      sum += result.squared_innovation;
      rows += result.rows;
    }
  }
  // Mean of chi-square with `rows` degrees of freedom over rows; its scatter is √(2/rows).
  std::printf("figure: normalised squared innovation %.3f a row, 1 within %.3f at 95 %%\n", sum / rows,
              1.96 * std::sqrt(2.0 / rows));
  EXPECT_NEAR(sum / rows, 1, 0.05);
}

TEST(Fusion, FollowsAHandWithinItsOwnUncertainty) {
  Rig rig;
  double squares = 0, normalised = 0, turn = 0;
  int count = 0;
  for (int ms = 1; ms <= 20000; ++ms) {
    const double t = ms * 1e-3;
    rig.inertial(t);
    if (due(ms, 10)) rig.point(t, 1e-3);
    if (ms < 5000) continue;
    const FusedPose pose = rig.fusion.pose();
    EXPECT_EQ(pose.state, FusionState::ok);
    const Eigen::Vector3d e = rig.fusion.filter().motion().position_m - rig.hand.position(t);
    squares += e.squaredNorm();
    normalised += e.dot(pose.covariance.topLeftCorner<3, 3>().inverse() * e);
    turn += std::pow(pose.world_from_sensor.angularDistance(rig.hand.rotation(t)), 2);
    ++count;
  }
  EXPECT_LT(std::sqrt(squares / count), 1e-3);  // of fixes with 1.7 mm
  EXPECT_GT(normalised / count, 1.5);
  EXPECT_LT(normalised / count, 5);  // 3 expected; errors last, so the mean scatters
  EXPECT_LT(in_degrees(Radians(std::sqrt(turn / count))), 0.5);
}

TEST(Fusion, LateAndDisorderedSamplesGiveWhatOrderedOnesGive) {
  Rig ordered, late;
  std::vector<std::pair<int, int>> waiting;  // (arrives, stamped) in ms
  for (int ms = 1; ms <= 3000; ++ms) {
    const InertialReading reading = ordered.noise.onto(ordered.hand.reading(ms * 1e-3, 1e-3), 1e-3, {});
    ordered.fusion.add(reading, at_second(ms * 1e-3));
    late.fusion.add(reading, at_second(ms * 1e-3));
    const auto fix = [&](int stamped) {
      return PointFix{.point_m = ordered.hand.position(stamped * 1e-3) +
                                 Eigen::Vector3d(1e-4 * (stamped % 7), 0, 0)};
    };
    if (due(ms, 10)) {
      ordered.fusion.add(fix(ms), at_second(ms * 1e-3));
      waiting.emplace_back(ms + 20 + 37 * (ms / 10 % 3), ms);
    }
    for (auto& [arrives, stamped] : waiting)
      if (arrives == ms) late.fusion.add(fix(stamped), at_second(stamped * 1e-3));
  }
  // The last ones are still on their way.
  for (auto& [arrives, stamped] : waiting)
    if (arrives > 3000)
      late.fusion.add(PointFix{.point_m = late.hand.position(stamped * 1e-3) +
                                          Eigen::Vector3d(1e-4 * (stamped % 7), 0, 0)},
                      at_second(stamped * 1e-3));
  const MotionState &a = ordered.fusion.filter().motion(), &b = late.fusion.filter().motion();
  EXPECT_EQ(difference(a, b).cwiseAbs().maxCoeff(), 0);
  EXPECT_EQ((a.covariance - b.covariance).cwiseAbs().maxCoeff(), 0);
  EXPECT_GT(late.fusion.lateness().late, 250U);
  EXPECT_EQ(late.fusion.lateness().too_late, 0U);
}

TEST(Fusion, TwoHundredMillisecondsWithoutSight) {
  Rig rig;
  double worst = 0, worst_after = 0;
  for (int ms = 1; ms <= 20000; ++ms) {
    const double t = ms * 1e-3;
    rig.inertial(t);
    const int phase = ms % 2000;
    const bool blocked = ms > 4000 && phase < 200;
    if (due(ms, 10) && !blocked) rig.point(t, 5e-4);
    if (ms <= 4200) continue;
    if (blocked) worst = std::max(worst, rig.error(t).norm());
    if (blocked && phase > 120) {
      EXPECT_EQ(rig.fusion.pose().state, FusionState::predicted) << ms;
    }
    if (phase >= 300) {
      worst_after = std::max(worst_after, rig.error(t).norm());
      EXPECT_EQ(rig.fusion.pose().state, FusionState::ok) << ms;
    }
  }
  std::printf("figure: worst through 200 ms without sight %.2f mm, from 100 ms after it %.2f mm\n",
              1e3 * worst, 1e3 * worst_after);
  EXPECT_LT(worst, 5e-3);
  EXPECT_LT(worst_after, 2e-3);
}

TEST(Fusion, OneSourceHandsOverToAnotherWithoutAJump) {
  Rig rig;
  double jump = 0;
  Eigen::Vector3d before = Eigen::Vector3d::Zero();
  for (int ms = 1; ms <= 6000; ++ms) {
    const double t = ms * 1e-3;
    rig.inertial(t);
    // A tracker gives way to a tablet that is 1 mm off, and comes back.
    const bool tablet = ms > 3000 && ms <= 4500;
    if (due(ms, tablet ? 5 : 10))
      rig.point(t, 3e-4, tablet ? Eigen::Vector3d(1e-3, 0, 0) : Eigen::Vector3d::Zero());
    if (ms > 2900) jump = std::max(jump, (rig.error(t) - before).norm());
    before = rig.error(t);
  }
  std::printf("figure: largest step at a hand-over with 1 mm between the sources %.3f mm\n", 1e3 * jump);
  EXPECT_LT(jump, 3e-4);
}

TEST(Fusion, ReturnsWithinATenthOfASecondWhereverTheToolIs) {
  Rig rig;
  const Eigen::Vector3d elsewhere(0.4, -0.1, 0.1);
  std::optional<int> lost, found;
  for (int ms = 1; ms <= 8000; ++ms) {
    const double t = ms * 1e-3;
    if (ms < 3000 || ms > 6000) rig.inertial(t);  // even the inertial unit is gone for three seconds
    const Eigen::Vector3d offset = ms > 6000 ? elsewhere : Eigen::Vector3d::Zero();
    if (due(ms, 10) && (ms < 3000 || ms > 6000)) rig.point(t, 5e-4, offset);
    if (ms > 6000 && !found && (rig.error(t) - elsewhere).norm() < 2e-3 &&
        rig.fusion.pose().state == FusionState::ok)
      found = ms - 6000;
  }
  ASSERT_TRUE(found.has_value());
  std::printf("figure: found again %d ms after a source returned\n", *found);
  EXPECT_LT(*found, 100);
}

TEST(Fusion, ATrackerThatFlipsIsNotBelieved) {
  Rig rig;
  double worst = 0;
  for (int ms = 1; ms <= 5000; ++ms) {
    const double t = ms * 1e-3;
    rig.inertial(t);
    const bool flipped = ms > 2000 && ms / 10 % 4 == 0;
    if (due(ms, 10)) {
      const FixResult result =
          rig.point(t, 5e-4, flipped ? Eigen::Vector3d(0.03, 0, 0.01) : Eigen::Vector3d::Zero());
      if (flipped) {
        EXPECT_EQ(result.outcome, FixOutcome::outlier) << ms;
      }
    }
    if (ms > 1500) worst = std::max(worst, rig.error(t).norm());
  }
  EXPECT_LT(worst, 2e-3);
  EXPECT_GT(rig.fusion.counts().outliers, 70U);
}

TEST(Fusion, AStepThatLastsIsBelieved) {
  Rig rig;
  const Eigen::Vector3d moved(0.05, 0, 0);  // the tracker's base was knocked
  for (int ms = 1; ms <= 4000; ++ms) {
    const double t = ms * 1e-3;
    rig.inertial(t);
    if (due(ms, 10)) rig.point(t, 5e-4, ms > 3000 ? moved : Eigen::Vector3d::Zero());
    if (ms == 3100) {
      EXPECT_LT((rig.error(t) - moved).norm(), 2e-3);
    }
  }
  EXPECT_GE(rig.fusion.counts().anchored, 2U);
}

TEST(Fusion, SurvivesAndNamesWhatDevicesSend) {
  Rig rig;
  for (int ms = 1; ms <= 2000; ++ms) {
    rig.inertial(ms * 1e-3);
    if (due(ms, 10)) rig.point(ms * 1e-3, 5e-4);
  }
  const MotionState before = rig.fusion.filter().motion();
  InertialReading bad = rig.hand.reading(2.001, 1e-3);
  bad.turn_rate_radps.y() = nan;
  EXPECT_FALSE(rig.fusion.add(bad, at_second(2.0005)));
  EXPECT_EQ(rig.fusion.add(PointFix{.point_m = {nan, 0, 0}}, at_second(2)).outcome, FixOutcome::unsound);
  EXPECT_EQ(rig.fusion.add(PointFix{.covariance_m2 = Eigen::Matrix3d::Zero()}, at_second(2)).outcome,
            FixOutcome::unsound);
  EXPECT_FALSE(rig.fusion.add(rig.hand.reading(2, 1e-3), at_second(2)));  // the same time again
  EXPECT_EQ(difference(rig.fusion.filter().motion(), before).norm(), 0);
  EXPECT_EQ(rig.fusion.counts().unsound, 3U);
  EXPECT_EQ(rig.fusion.counts().repeated, 1U);
  EXPECT_EQ(rig.fusion.add(PointFix{}, at_second(1)).outcome, FixOutcome::too_late);
  EXPECT_EQ(rig.fusion.lateness().too_late, 1U);

  // A clock that begins again at 0 is followed, and named.
  for (int ms = 1; ms <= 3000; ++ms) {
    rig.inertial(ms * 1e-3);
    if (due(ms, 10)) rig.point(ms * 1e-3, 5e-4);
  }
  EXPECT_EQ(rig.fusion.lateness().restarts, 1U);
  EXPECT_EQ(rig.fusion.pose().state, FusionState::ok);
  EXPECT_LT(rig.error(3).norm(), 2e-3);
}

// A tracker's programme is started again: its stamps fall back by ten seconds, and later come right. The
// inertial unit's likewise. What is stamped is always what is then.
TEST(Fusion, ASourceWhoseClockStepsBackRejoinsTheOthers) {
  for (const bool tracker : {true, false}) {
    Rig rig;
    double worst = 0;
    for (int ms = 1; ms <= 9000; ++ms) {
      const double t = ms * 1e-3, off = ms > 3000 && ms <= 6000 ? 10 : 0;
      rig.fusion.add(rig.noise.onto(rig.hand.reading(t, 1e-3), 1e-3, {}), at_second(tracker ? t : t - off));
      if (due(ms, 10))
        rig.fusion.add(PointFix{.point_m = rig.hand.position(t) + rig.noise.vector(5e-4)},
                       at_second(tracker ? t - off : t));
      if (ms <= 2000) continue;
      worst = std::max(worst, rig.error(t).norm());
      EXPECT_NE(rig.fusion.pose().state, FusionState::lost) << ms;
      if (ms % 1000 > 200) {
        EXPECT_EQ(rig.fusion.pose().state, FusionState::ok) << ms;
      }
    }
    std::printf("figure: the clock of the %s steps back by 10 s and comes right again: worst %.2f mm\n",
                tracker ? "tracker" : "inertial unit", 1e3 * worst);
    EXPECT_LT(worst, 5e-3);
    EXPECT_EQ(rig.fusion.lateness().rejoined, 1U);
    EXPECT_EQ(rig.fusion.lateness().restarts, 0U);
    EXPECT_LT(rig.fusion.lateness().too_late, 20U);
  }
}

TEST(Fusion, WhatIsHonestlyLateIsNeverTakenForNew) {
  Rig rig;
  for (int ms = 1; ms <= 3000; ++ms) {
    rig.inertial(ms * 1e-3);
    if (due(ms, 10) && ms > 500) {
      EXPECT_EQ(rig.point((ms - 500) * 1e-3, 5e-4).outcome, FixOutcome::too_late);
    }
  }
  EXPECT_EQ(rig.fusion.lateness().too_late, 250U);
  EXPECT_EQ(rig.fusion.lateness().rejoined, 0U);
}

TEST(Fusion, AMagnetWalkingByIsNamedAndDoesNotTurnTheBrush) {
  Rig rig;
  double worst = 0;
  for (int ms = 1; ms <= 12000; ++ms) {
    const double t = ms * 1e-3;
    rig.hand.field_ut =
        Eigen::Vector3d(0, 18, -40) + std::exp(-std::pow(t - 8, 2)) * Eigen::Vector3d(60, -30, 20);
    rig.inertial(t);
    if (due(ms, 10)) rig.point(t, 5e-4);
    if (ms > 4000)
      worst = std::max(worst, rig.fusion.pose().world_from_sensor.angularDistance(rig.hand.rotation(t)));
  }
  EXPECT_LT(in_degrees(Radians(worst)), 1.5);
  EXPECT_GT(rig.fusion.counts().disturbed_field, 5U);
}

TEST(Fusion, PosesAloneAreFollowedWithoutAnInertialUnit) {
  Rig rig;
  for (int ms = 0; ms <= 3000; ms += 5) {
    const double t = ms * 1e-3;
    PoseFix fix{.point_m = rig.hand.position(t), .world_from_sensor = rig.hand.rotation(t)};
    fix.covariance.diagonal() << 1e-7, 1e-7, 1e-7, 1e-5, 1e-5, 1e-5;
    rig.fusion.add(fix, at_second(t));
    if (ms < 500) continue;
    EXPECT_LT(rig.error(t).norm(), 1e-3);
    EXPECT_LT(rig.fusion.pose().world_from_sensor.angularDistance(rig.hand.rotation(t)), 0.02);
  }
}

TEST(Fusion, FindsTheLagAndTheMarkerOfATracker) {
  FusionSettings settings;
  settings.lag_sigma_s = 0.02;
  settings.lever_sigma_m = 0.05;
  Rig rig(settings);
  const double lag = 0.02;
  const Eigen::Vector3d lever(0.03, -0.02, 0.01);
  for (int ms = 1; ms <= 20000; ++ms) {
    rig.inertial(ms * 1e-3);
    if (!due(ms, 20)) continue;
    const double seen = ms * 1e-3 - lag;
    rig.fusion.add(PointFix{.point_m = rig.hand.position(seen) + rig.hand.rotation(seen) * lever +
                                       rig.noise.vector(1e-3)},
                   at_second(ms * 1e-3));
  }
  EXPECT_NEAR(rig.fusion.filter().motion().lag_s, lag, 1e-3);
  const MotionState& found = rig.fusion.filter().motion();
  const double sigma = std::sqrt(found.covariance.diagonal().segment<3>(error::lever).sum());
  EXPECT_LT((found.lever_m - lever).norm(), 3 * sigma);
  EXPECT_LT((found.lever_m - lever).norm(), 5e-3);
}

}  // namespace
}  // namespace fude
