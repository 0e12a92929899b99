// The pose that is fused as samples come is the one that a recording of them gives.
#include "rig/fusion/live_fusion.h"

#include <gtest/gtest.h>

#include <chrono>
#include <vector>

#include "rig/fusion/fuse_session.h"
#include "tests/calibration/fusion/inertial_recording.h"
#include "tests/calibration/fusion/simulated_hand.h"

namespace fude {
namespace {

constexpr double step_s = 0.004;
constexpr int steps = 1500;
const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();

ImuSample inertial(const SimulatedHand& hand, int i) {
  const InertialReading r = hand.reading(i * step_s, step_s);
  return {.time = {.host = at_second(i * step_s)},
          .turn_rate_radps = r.turn_rate_radps,
          .specific_force_mps2 = r.specific_force_mps2};
}

PoseSample seen(const SimulatedHand& hand, int i) {
  PoseSample pose{.time = {.host = at_second(i * step_s)}, .tool = "brush"};
  pose.tracker_from_tool = {hand.rotation(i * step_s), hand.position(i * step_s)};
  return pose;
}

TEST(LiveFusion, IsWhatARecordingOfTheSameSamplesGives) {
  const SimulatedHand hand;
  Session session;
  session.devices.push_back({1, {.id = "0001:0001:", .name = "imu", .kind = DeviceKind::imu}});
  session.devices.push_back({2, {.id = "0002:0001:", .name = "tracker", .kind = DeviceKind::tracker}});
  LiveFusion fusion(up);
  std::vector<PoseSample> live;
  const auto add = [&](DeviceNumber device, const Sample& sample) {
    session.samples.push_back({device, sample, 0});
    if (const auto pose = fusion.add(static_cast<std::size_t>(device), sample)) live.push_back(*pose);
  };
  for (int i = 1; i <= steps; ++i) {
    add(1, inertial(hand, i));
    if (i % 5 == 0 && i < steps - 100) add(2, seen(hand, i));  // lost at the end
  }
  const auto recorded = fuse_session(session, {.use = fuse_sources("gyro,accel,pose").value(), .up = up});
  ASSERT_TRUE(recorded) << recorded.error().message;
  ASSERT_EQ(live.size(), recorded->rows.size());
  for (std::size_t i = 0; i < live.size(); ++i) {
    const FusedRow& row = recorded->rows[i];
    EXPECT_EQ(live[i].tool, "fused");
    EXPECT_EQ(live[i].time.sequence, i);
    EXPECT_EQ(live[i].valid, row.position_m.has_value()) << i;
    if (!live[i].valid) continue;
    EXPECT_EQ(live[i].origin, row.state == FusionState::ok ? PoseOrigin::measured : PoseOrigin::predicted);
    EXPECT_EQ(live[i].tracker_from_tool.translation, *row.position_m) << i;
    EXPECT_EQ(live[i].tracker_from_tool.rotation.coeffs(), row.world_from_sensor->coeffs());
    EXPECT_EQ(live[i].covariance->diagonal().tail<3>(), row.covariance.diagonal().head<3>());
    EXPECT_EQ(live[i].covariance->diagonal().head<3>(), row.covariance.diagonal().tail<3>());
  }
  EXPECT_EQ(live[steps / 2].origin, PoseOrigin::measured);
  EXPECT_LT((live[steps / 2].tracker_from_tool.translation - hand.position((steps / 2 + 1) * step_s)).norm(),
            2e-3);
  EXPECT_EQ(live.back().origin, PoseOrigin::predicted);
}

TEST(LiveFusion, ATrackerAloneIsFusedAndOtherToolsAreNot) {
  const SimulatedHand hand;
  LiveFusion fusion(up);
  std::optional<PoseSample> last;
  for (int i = 5; i <= steps; i += 5) {
    last = fusion.add(2, seen(hand, i));
    EXPECT_TRUE(last);
    PoseSample other = seen(hand, i);
    other.tool = "palette";
    EXPECT_FALSE(fusion.add(2, other));
    EXPECT_FALSE(fusion.add(3, seen(hand, i)));
    PoseSample blind = seen(hand, i);
    blind.valid = false;
    EXPECT_FALSE(fusion.add(2, blind));
  }
  EXPECT_LT((last->tracker_from_tool.translation - hand.position(steps * step_s)).norm(), 3e-3);
  EXPECT_FALSE(fusion.add(4, PenSample{}));
}

// Its stamps fall back by ten seconds in the middle: beside an inertial unit, and alone.
TEST(LiveFusion, ATrackerWhoseClockBeginsAgainIsFollowed) {
  for (const bool helped : {true, false}) {
    const SimulatedHand hand;
    LiveFusion fusion(up);
    std::optional<PoseSample> last;
    for (int i = 1; i <= steps; ++i) {
      if (helped) last = fusion.add(1, inertial(hand, i));
      if (i % 5 != 0) continue;
      PoseSample pose = seen(hand, i);
      if (i > steps / 2) pose.time.host -= std::chrono::seconds(10);
      const auto fused = fusion.add(2, pose);
      if (!helped) last = fused;
    }
    ASSERT_TRUE(last && last->valid);
    EXPECT_EQ(last->origin, PoseOrigin::measured);
    EXPECT_LT((last->tracker_from_tool.translation - hand.position(steps * step_s)).norm(), 3e-3);
    const double off_s = helped ? 0 : 10;
    EXPECT_EQ(last->time.host, at_second(steps * step_s - off_s));
  }
}

// The inertial unit is plugged in later: from then on its samples give the pose.
TEST(LiveFusion, AnInertialUnitMayComeLater) {
  const SimulatedHand hand;
  LiveFusion fusion(up);
  std::optional<PoseSample> last;
  for (int i = 1; i <= steps; ++i) {
    if (i > steps / 2) last = fusion.add(1, inertial(hand, i));
    if (i % 5 == 0) {
      const auto pose = fusion.add(2, seen(hand, i));
      EXPECT_EQ(pose.has_value(), i <= steps / 2);
    }
  }
  ASSERT_TRUE(last && last->valid);
  EXPECT_LT((last->tracker_from_tool.translation - hand.position(steps * step_s)).norm(), 2e-3);
}

// A hub is unplugged and comes back: the same unit and the same tool are now other devices.
TEST(LiveFusion, SourcesComeBackAsOtherDevices) {
  const SimulatedHand hand;
  LiveFusion fusion(up);
  std::optional<PoseSample> last;
  for (int i = 1; i <= steps; ++i) {
    const bool away = i > steps / 2 && i <= steps / 2 + 300;  // 1.2 s
    const std::size_t other = i > steps / 2 ? 10 : 0;
    if (away) continue;
    if (const auto pose = fusion.add(1 + other, inertial(hand, i))) last = pose;
    if (i % 5 == 0) fusion.add(2 + other, seen(hand, i));
  }
  ASSERT_TRUE(last && last->valid);
  EXPECT_EQ(last->origin, PoseOrigin::measured);
  EXPECT_EQ(last->time.host, at_second(steps * step_s));
  EXPECT_LT((last->tracker_from_tool.translation - hand.position(steps * step_s)).norm(), 3e-3);
}

// The unit's battery is empty: the tracker goes on alone.
TEST(LiveFusion, TheTrackerGoesOnWithoutTheUnit) {
  const SimulatedHand hand;
  LiveFusion fusion(up);
  std::optional<PoseSample> last;
  for (int i = 1; i <= steps; ++i) {
    if (i <= steps / 2) fusion.add(1, inertial(hand, i));
    if (i % 5 == 0) last = fusion.add(2, seen(hand, i));
  }
  ASSERT_TRUE(last && last->valid);
  EXPECT_LT((last->tracker_from_tool.translation - hand.position(steps * step_s)).norm(), 3e-3);
}

TEST(LiveFusion, AheadOfItsTimeForADisplay) {
  const SimulatedHand hand;
  constexpr Duration ahead = std::chrono::milliseconds(20);
  LiveFusion fusion(up, ahead);
  std::optional<PoseSample> last;
  for (int i = 1; i <= steps; ++i) {
    last = fusion.add(1, inertial(hand, i));
    if (i % 5 == 0) fusion.add(2, seen(hand, i));
  }
  ASSERT_TRUE(last && last->valid);
  EXPECT_EQ(last->origin, PoseOrigin::predicted);
  EXPECT_EQ(last->time.host, at_second(steps * step_s) + ahead);
  EXPECT_LT((last->tracker_from_tool.translation - hand.position(steps * step_s + 0.02)).norm(), 3e-3);
}

}  // namespace
}  // namespace fude
