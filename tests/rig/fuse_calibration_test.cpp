// What a fusion makes of calibrations: each of an error that only it puts right.
#include "rig/fusion/fuse_calibration.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "calibration/sensor_axes.h"
#include "rig/calibration/calibration_file.h"
#include "rig/fusion/fuse_session.h"
#include "tests/rig/simulated_session.h"

namespace fude {
namespace {

RecordedCalibration stored(const char* procedure, Fields fields, std::vector<std::string> devices = {}) {
  StoredCalibration calibration{.result = std::move(fields)};
  calibration.report.procedure = procedure;
  calibration.report.accepted = true;
  calibration.report.devices = std::move(devices);
  return {std::string(procedure) + ".toml", toml_of(calibration)};
}

Session tracked() { return session_of({}, "0002:0001:"); }

struct Accuracy {
  double position_m = 0, turn_rad = 0;
};
// Root mean squares from 4 s on, of poses that `world_from_tracker` takes from the hand's own.
Accuracy accuracy(const FusedSession& fused, const Pose<Paper, Tracker>& world_from_tracker = {}) {
  const SimulatedHand hand;
  Accuracy sum;
  int count = 0;
  for (const FusedRow& row : fused.rows) {
    const double t = seconds(row.time.time_since_epoch());
    if (t < 4) continue;
    if (!row.position_m) return {1e9, 1e9};
    sum.position_m += (*row.position_m - world_from_tracker * hand.position(t)).squaredNorm();
    sum.turn_rad +=
        std::pow(row.world_from_sensor->angularDistance(world_from_tracker.rotation * hand.rotation(t)), 2);
    ++count;
  }
  return {std::sqrt(sum.position_m / count), std::sqrt(sum.turn_rad / count)};
}

FusedSession fused_with(const Session& session, std::vector<RecordedCalibration> calibrations) {
  auto fused = fuse_session(
      session, {.use = fuse_sources("gyro,accel,pose").value(), .calibrations = std::move(calibrations)});
  EXPECT_TRUE(fused) << fused.error().message;
  return fused ? *fused : FusedSession{};
}

template <class Change>
void change_inertial(Session& session, Change change) {
  for (RecordedSample& sample : session.samples)
    if (auto* imu = std::get_if<ImuSample>(&sample.sample)) change(*imu);
}

bool told(const FusedSession& fused, const char* what) {
  return std::any_of(fused.notes.begin(), fused.notes.end(),
                     [&](const std::string& note) { return note.find(what) != std::string::npos; });
}

TEST(FuseCalibration, OfTheInertialUnit) {
  const ImuCalibration imu{.gyro_bias_radps = {0.2, -0.3, 0.1},
                           .accel_bias_mps2 = {0.5, 1, -0.8},
                           .accel_scale = {1.05, 0.94, 1.1},
                           .magnetometer = ImuCalibration::Magnetometer{.offset_ut = {10, -5, 3}}};
  Session session = tracked();
  change_inertial(session, [&](ImuSample& sample) {
    sample.turn_rate_radps += imu.gyro_bias_radps;
    sample.specific_force_mps2 =
        sample.specific_force_mps2.cwiseQuotient(imu.accel_scale) + imu.accel_bias_mps2;
  });
  const FusedSession with = fused_with(session, {stored("imu", to_fields(imu))});
  EXPECT_TRUE(told(with, "applied: imu"));
  EXPECT_LT(accuracy(with).position_m, 1e-3);
  EXPECT_GT(accuracy(fused_with(session, {})).position_m, 3 * accuracy(with).position_m);
  // The session's own, as it carries it.
  session.calibrations.push_back(stored("imu", to_fields(imu)));
  EXPECT_EQ(accuracy(fused_with(session, {})).position_m, accuracy(with).position_m);
}

TEST(FuseCalibration, OfItsAxes) {
  const SensorAxes axes{rotation_of({0.4, 1.2, -0.3})};
  Session session = tracked();
  change_inertial(session, [&](ImuSample& sample) {
    sample.turn_rate_radps = axes.tool_from_sensor.conjugate() * sample.turn_rate_radps;
    sample.specific_force_mps2 = axes.tool_from_sensor.conjugate() * sample.specific_force_mps2;
  });
  const FusedSession with = fused_with(session, {stored("imu-axes", to_fields(axes))});
  EXPECT_LT(accuracy(with).position_m, 1e-3);
  EXPECT_LT(accuracy(with).turn_rad, 0.01);
  EXPECT_GT(accuracy(fused_with(session, {})).turn_rad, 0.01);
}

Fields delay_of(double offset_s, double drift_ppm = 0) {
  return {{"offset_s", offset_s},
          {"drift_ppm", drift_ppm},
          {"streams", std::vector<std::string>{"imu", "optical"}}};
}

// Even one beyond what late samples are kept for.
TEST(FuseCalibration, OfADelay) {
  for (const int ms : {60, -60, 900}) {
    Session session = tracked();
    for (RecordedSample& sample : session.samples)
      if (auto* pose = std::get_if<PoseSample>(&sample.sample))
        pose->time.host += std::chrono::milliseconds(ms);
    const FusedSession with = fused_with(session, {stored("delay", delay_of(-1e-3 * ms))});
    EXPECT_LT(accuracy(with).position_m, 1e-3) << ms;
    EXPECT_EQ(with.lateness.too_late, 0U);
    EXPECT_EQ(with.rows.front().time, at_second(step_s));  // as imported
    if (ms > 300) {
      EXPECT_GT(accuracy(fused_with(session, {})).position_m, 3 * accuracy(with).position_m);
    }
  }
  EXPECT_TRUE(told(fused_with(tracked(), {stored("delay", {{"offset_s", 0.1}})}), "does not name its two"));
  const Fields elsewhere{{"offset_s", 0.1}, {"streams", std::vector<std::string>{"imu", "radar"}}};
  EXPECT_TRUE(told(fused_with(tracked(), {stored("delay", elsewhere)}), "no stream radar"));
}

TEST(FuseCalibration, ADriftIsOfItsOwnSession) {
  const FusedSession fused = fused_with(tracked(), {stored("delay", delay_of(0, 1000))});
  EXPECT_TRUE(told(fused, "of another session"));
  EXPECT_LT(accuracy(fused).position_m, 1e-3);
}

TEST(FuseCalibration, OfThePaper) {
  SurfaceCalibration surface;
  surface.width_mm = 300;
  surface.height_mm = 200;
  surface.paper_from_tracker = {rotation_of({0.5, -0.3, 1.1}), {20, 30, -40}};
  const FusedSession fused = fused_with(tracked(), {stored("surface", to_fields(surface))});
  const Pose<Paper, Tracker> metres{surface.paper_from_tracker.rotation,
                                    1e-3 * surface.paper_from_tracker.translation};
  EXPECT_LT(accuracy(fused, metres).position_m, 1e-3);
  EXPECT_LT(accuracy(fused, metres).turn_rad, 0.01);
}

// The frame of a tracker that hangs on a wall: gravity says where up is in it.
TEST(FuseCalibration, UpIsWhereGravityHasIt) {
  const Pose<Paper, Tracker> wall{rotation_of({0.9, 0.4, -0.2}), {0.1, 0.2, 0.3}};
  Session session = tracked();
  for (RecordedSample& sample : session.samples)
    if (auto* pose = std::get_if<PoseSample>(&sample.sample)) {
      pose->tracker_from_tool.translation = wall * pose->tracker_from_tool.translation;
      pose->tracker_from_tool.rotation = wall.rotation * pose->tracker_from_tool.rotation;
    }
  const FusedSession found = fused_with(session, {});
  EXPECT_TRUE(told(found, "gravity"));
  EXPECT_LT(accuracy(found, wall).position_m, 1e-3);
  EXPECT_LT(accuracy(found, wall).turn_rad, 0.01);
  const auto taken = fuse_session(session, {.use = fuse_sources("gyro,accel,position").value()});
  ASSERT_TRUE(taken);
  EXPECT_TRUE(told(*taken, "--up"));
}

TEST(FuseCalibration, OfAnotherDeviceIsNotUsed) {
  const ImuCalibration imu{.gyro_bias_radps = {0.5, 0.5, 0.5}};
  const auto ours = stored("imu", to_fields(imu), {"0001:0001:"});
  const auto other = stored("imu", to_fields(imu), {"0001:0001:SERIAL"});
  EXPECT_GT(accuracy(fused_with(tracked(), {ours})).turn_rad,
            2 * accuracy(fused_with(tracked(), {other})).turn_rad);
  EXPECT_TRUE(told(fused_with(tracked(), {other}), "with the device 0001:0001:SERIAL, which is not here"));
  StoredCalibration palette{.result = {{"tip_m", std::vector{0.0, 0.0, -0.1}}}};
  palette.report.procedure = "pivot";
  palette.report.accepted = true;
  palette.report.tool = "palette";
  EXPECT_TRUE(
      told(fused_with(tracked(), {{"pivot palette", toml_of(palette)}}), "the tool palette, and this is sensor"));
  StoredCalibration refused{.result = to_fields(imu)};
  refused.report.procedure = "imu";
  EXPECT_EQ(fuse_session(tracked(), {.calibrations = {{"imu.toml", toml_of(refused)}}}).error().fault,
            Fault::malformed);
}

}  // namespace
}  // namespace fude
