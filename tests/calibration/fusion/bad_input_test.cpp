// What devices and rooms do to a fusion: each survived, and named in its counts.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "calibration/fusion/fusion.h"
#include "signal/units.h"
#include "tests/calibration/fusion/simulated_rig.h"

namespace fude {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

TEST(BadInput, ATrackerThatFlipsIsNotBelieved) {
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

// Half a second here, half a second there, as a tracker does that has two solutions for one picture.
TEST(BadInput, ATrackerThatTakesTurnsBetweenTwoPlacesIsNamed) {
  Rig rig;
  for (int ms = 1; ms <= 6400; ++ms) {
    const double t = ms * 1e-3;
    rig.inertial(t);
    const bool flipped = ms > 2000 && ms / 500 % 2 == 1;
    if (due(ms, 10)) rig.point(t, 5e-4, flipped ? Eigen::Vector3d(0.03, 0, 0.01) : Eigen::Vector3d::Zero());
    ASSERT_TRUE(rig.fusion.pose().point_m.allFinite());
  }
  EXPECT_GE(rig.fusion.counts().changed_mind, 6U);
  EXPECT_LT(rig.error(6.4).norm(), 3e-3);
}

TEST(BadInput, SurvivesAndNamesWhatDevicesSend) {
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

TEST(BadInput, AMagnetWalkingByIsNamedAndDoesNotTurnTheBrush) {
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

// One reading that nobody could have measured is passed over.
TEST(BadInput, AnAbsurdReadingOfTheInertialUnit) {
  for (const double absurd : {1e4, 1e12, 1e300}) {
    for (const bool turn : {true, false}) {
      Rig rig;
      for (int ms = 1; ms <= 4000; ++ms) {
        const double t = ms * 1e-3;
        if (ms == 3000) {
          InertialReading reading = rig.hand.reading(t, 1e-3);
          (turn ? reading.turn_rate_radps : reading.specific_force_mps2).y() = absurd;
          EXPECT_FALSE(rig.fusion.add(reading, at_second(t)));
        } else {
          rig.inertial(t);
        }
        if (due(ms, 10)) rig.point(t, 5e-4);
        if (ms < 3000) continue;
        const FusedPose pose = rig.fusion.pose();
        EXPECT_EQ(pose.state, FusionState::ok);
        EXPECT_LT(rig.error(t).norm(), 3e-3) << ms;
        EXPECT_LT(pose.world_from_sensor.angularDistance(rig.hand.rotation(t)), 0.03) << ms;
      }
      EXPECT_EQ(rig.fusion.counts().unsound, 1U);
    }
  }
}

// A slip that a unit could have measured turns the brush by as much, until the next fixes turn it back.
TEST(BadInput, ASlipWithinTheUnitsRange) {
  Rig rig;
  for (int ms = 1; ms <= 4000; ++ms) {
    const double t = ms * 1e-3;
    if (ms == 3000) {
      InertialReading reading = rig.hand.reading(t, 1e-3);
      reading.turn_rate_radps.y() = 60;
      EXPECT_TRUE(rig.fusion.add(reading, at_second(t)));
    } else {
      rig.inertial(t);
    }
    if (due(ms, 10)) rig.point(t, 5e-4);
    if (ms < 3000) continue;
    EXPECT_EQ(rig.fusion.pose().state, FusionState::ok);
    EXPECT_LT(rig.error(t).norm(), 3e-3) << ms;
  }
  EXPECT_EQ(rig.fusion.counts().changed_mind, 0U);
  EXPECT_LT(rig.fusion.pose().world_from_sensor.angularDistance(rig.hand.rotation(4)), 0.03);
}

// A time stamp that slipped by years, of either kind of sample.
TEST(BadInput, OneLeapOfTime) {
  for (const double leap_s : {10.0, 1e9}) {
    for (const bool inertial : {true, false}) {
      Rig rig;
      for (int ms = 1; ms <= 4000; ++ms) {
        const double t = ms * 1e-3;
        rig.inertial(t);
        if (due(ms, 10)) rig.point(t, 5e-4);
        if (ms == 3000) {
          if (inertial)
            EXPECT_FALSE(rig.fusion.add(rig.hand.reading(t, 1e-3), at_second(t + leap_s)));
          else
            EXPECT_EQ(rig.fusion.add(PointFix{}, at_second(t + leap_s)).outcome, FixOutcome::too_late);
        }
        if (ms < 3000) continue;
        EXPECT_EQ(rig.fusion.pose().state, FusionState::ok) << ms;
        EXPECT_LT(rig.error(t).norm(), 2e-3) << ms;
      }
      EXPECT_EQ(rig.fusion.lateness().leaps, 1U);
      EXPECT_EQ(rig.fusion.lateness().too_late, 0U);
    }
  }
}

TEST(BadInput, APauseOfAMinuteIsNoLeap) {
  Rig rig;
  for (int ms = 1; ms <= 2000; ++ms) {
    const double t = ms * 1e-3 + (ms > 1000 ? 60 : 0);
    rig.inertial(t);
    if (due(ms, 10)) rig.point(t, 5e-4);
  }
  EXPECT_EQ(rig.fusion.lateness().leaps, 1U);  // the first after it is not believed yet
  EXPECT_LT(rig.error(62).norm(), 6e-3);       // as a second after any beginning
  EXPECT_EQ(rig.fusion.pose().state, FusionState::ok);
}

}  // namespace
}  // namespace fude
