// The rig of Chu's thesis: ultrasonic emitters on the handle, receivers around the paper, gyroscopes and
// accelerometers in it. Two emitters, or one and a magnetometer: one with gyroscopes leaves the yaw free.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>

#include "calibration/fusion/fusion.h"
#include "signal/units.h"
#include "tests/calibration/fusion/simulated_hand.h"

namespace fude {
namespace {

constexpr double range_sigma_m = 5e-4;
const std::array receivers{Eigen::Vector3d(-0.1, 0, 0.5), Eigen::Vector3d(0.4, 0, 0.5),
                           Eigen::Vector3d(0.4, 0.45, 0.5), Eigen::Vector3d(-0.1, 0.45, 0.45),
                           Eigen::Vector3d(0.15, 0.6, 0.1)};
const std::array emitters{Eigen::Vector3d(0.01, 0.01, 0.1), Eigen::Vector3d(0.06, -0.04, 0.02)};
const Eigen::Vector3d tip(0, 0, -0.12);

struct RigError {
  double tip_mm = 0, turn_deg = 0, blocked_mm = 0;
};

RigError run(std::size_t emitter_count, bool field, unsigned seed) {
  FusionSettings settings;
  settings.use_field = field;
  settings.start_position_m = {0.1, 0.2, 0.3};
  SimulatedHand hand;
  SimulatedNoise noise(seed);
  Fusion fusion(settings);
  double squares = 0, turns = 0, blocked_squares = 0;
  int count = 0, blocked_count = 0;
  for (int ms = 1; ms <= 30000; ++ms) {
    const double t = ms * 1e-3;
    fusion.add(noise.onto(hand.reading(t, 1e-3), 1e-3, settings.noise), at_second(t));
    const bool blocked = ms > 8000 && ms % 2000 < 200;
    // The emitters take turns, each at 100 Hz.
    for (std::size_t e = 0; e < emitter_count; ++e) {
      if (blocked || ms % 10 != static_cast<int>(5 * e)) continue;
      const Eigen::Vector3d place = hand.position(t) + hand.rotation(t) * emitters[e];
      for (const Eigen::Vector3d& receiver : receivers)
        fusion.add(
            RangeFix{.receiver_m = receiver,
                     .emitter_offset_m = emitters[e],
                     .distance_m = (place - receiver).norm() + range_sigma_m * noise.normal(noise.generator),
                     .sigma_m = range_sigma_m},
            at_second(t));
    }
    if (ms <= 8000) continue;
    const FusedPose pose = fusion.pose();
    const Eigen::Vector3d error =
        pose.point_m + pose.world_from_sensor * tip - (hand.position(t) + hand.rotation(t) * tip);
    squares += error.squaredNorm();
    turns += std::pow(pose.world_from_sensor.angularDistance(hand.rotation(t)), 2);
    ++count;
    if (!blocked) continue;
    blocked_squares += error.squaredNorm();
    ++blocked_count;
  }
  return {1e3 * std::sqrt(squares / count), in_degrees(Radians(std::sqrt(turns / count))),
          1e3 * std::sqrt(blocked_squares / blocked_count)};
}

TEST(UltrasonicRig, TwoEmitters) {
  const RigError e = run(2, false, 1);
  std::printf("figure: two emitters: tip %.2f mm, %.3f deg; through 200 ms blocked %.2f mm\n", e.tip_mm,
              e.turn_deg, e.blocked_mm);
  EXPECT_LT(e.tip_mm, 1);
  EXPECT_LT(e.turn_deg, 0.5);
  EXPECT_LT(e.blocked_mm, 2);
}

TEST(UltrasonicRig, OneEmitterAndAMagnetometer) {
  const RigError e = run(1, true, 2);
  std::printf(
      "figure: one emitter and a magnetometer: tip %.2f mm, %.3f deg; through 200 ms blocked %.2f mm\n",
      e.tip_mm, e.turn_deg, e.blocked_mm);
  EXPECT_LT(e.tip_mm, 1);
  EXPECT_LT(e.turn_deg, 0.5);
  EXPECT_LT(e.blocked_mm, 2);
}

// Contacts hold the height of a tip that nothing else sees for a while.
TEST(UltrasonicRig, ContactsHoldTheHeight) {
  const auto height_error = [](bool contacts) {
    SimulatedHand hand;
    SimulatedNoise noise(3);
    Fusion fusion;
    for (int ms = 1; ms <= 6000; ++ms) {
      const double t = ms * 1e-3;
      fusion.add(noise.onto(hand.reading(t, 1e-3), 1e-3, {}), at_second(t));
      PointFix fix{.point_m = hand.position(t) + noise.vector(1e-3)};
      if (ms <= 5600 && ms % 10 == 0) fusion.add(fix, at_second(t));
      const double height = (hand.position(t) + hand.rotation(t) * tip).z();
      if (contacts && ms % 10 == 0)
        fusion.add(ContactFix{.tip_offset_m = tip, .height_m = height}, at_second(t));
    }
    const FusedPose pose = fusion.pose();
    return std::abs(
        (pose.point_m + pose.world_from_sensor * tip - hand.position(6) - hand.rotation(6) * tip).z());
  };
  EXPECT_LT(height_error(true), 5e-4);
  EXPECT_GT(height_error(false), height_error(true));
}

}  // namespace
}  // namespace fude
