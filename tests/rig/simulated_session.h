// A session of a simulated hand.
#pragma once

#include <string>

#include "capture/session.h"
#include "tests/calibration/fusion/simulated_hand.h"

namespace fude {

inline constexpr double step_s = 0.004;

// A simulated hand: an inertial unit as device 1, and a tracker with its poses as device 2.
inline Session session_of(const SimulatedHand& hand, const std::string& tracker_id) {
  Session session;
  session.devices.push_back({1, {.id = "0001:0001:", .name = "imu", .kind = DeviceKind::imu}});
  session.devices.push_back({2, {.id = tracker_id, .name = "optical", .kind = DeviceKind::tracker}});
  for (int i = 1; i <= 2500; ++i) {
    const double t = i * step_s;
    const InertialReading r = hand.reading(t, step_s);
    ImuSample imu{.time = {.host = at_second(t)},
                  .turn_rate_radps = r.turn_rate_radps,
                  .specific_force_mps2 = r.specific_force_mps2,
                  .magnetic_field_ut = r.magnetic_field_ut};
    session.samples.push_back({1, imu, 0});
    if (i % 5 != 0) continue;
    PoseSample pose{.time = {.host = at_second(t)}, .tool = "sensor"};
    pose.tracker_from_tool = {hand.rotation(t), hand.position(t)};
    session.samples.push_back({2, pose, 0});
  }
  return session;
}

}  // namespace fude
