#include "calibration/fusion/fusion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "signal/units.h"
#include "tests/calibration/fusion/simulated_rig.h"

namespace fude {
namespace {

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

TEST(Fusion, AStepThatLastsIsBelieved) {
  Rig rig;
  const Eigen::Vector3d moved(0.05, 0, 0);  // the tracker's base was knocked
  for (int ms = 1; ms <= 4000; ++ms) {
    const double t = ms * 1e-3;
    rig.inertial(t);
    if (due(ms, 10)) rig.point(t, 5e-4, ms > 3000 ? moved : Eigen::Vector3d::Zero());
    if (ms == 3100) {
      EXPECT_LT((rig.error(t) - moved).norm(), 3e-3);
    }
  }
  EXPECT_GE(rig.fusion.counts().anchored, 2U);
}

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
