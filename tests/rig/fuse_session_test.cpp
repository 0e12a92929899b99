#include "rig/fusion/fuse_session.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <sstream>
#include <string>

#include "rig/import_session.h"
#include "signal/units.h"
#include "tests/calibration/fusion/inertial_recording.h"
#include "tests/rig/simulated_session.h"

namespace fude {
namespace {

std::set<FuseSource> named(const char* names) { return fuse_sources(names).value(); }

TEST(FuseSession, NamesOfSources) {
  EXPECT_EQ(named("imu,opt_pose"),
            (std::set{FuseSource::gyro, FuseSource::accel, FuseSource::mag, FuseSource::opt_pose}));
  EXPECT_EQ(fuse_sources("imu,odour").error().fault, Fault::usage);
  EXPECT_EQ(fuse_sources("").error().fault, Fault::usage);
}

TEST(FuseSession, TruthIsUsedOnlyWhereItIsNamed) {
  const Session session = session_of({}, "text:imu-csv");
  const auto alone = fuse_session(session, {});
  ASSERT_TRUE(alone.has_value()) << alone.error().message;
  ASSERT_EQ(alone->rows.size(), 2500U);
  for (const FusedRow& row : alone->rows) EXPECT_FALSE(row.position_m.has_value());
  const auto with = fuse_session(session, {.use = named("imu,opt_position")});
  ASSERT_TRUE(with.has_value()) << with.error().message;
  ASSERT_EQ(with->rows.size(), 2500U);
  EXPECT_EQ(with->rows.back().state, FusionState::ok);
  EXPECT_LT((with->rows.back().position_m.value() - SimulatedHand{}.position(10)).norm(), 2e-3);
}

TEST(FuseSession, PosesOfATrackerAreUsedByThemselves) {
  const SimulatedHand hand;
  for (const char* use : {"imu,pose", "pose", "position"}) {
    for (const bool smooth : {false, true}) {
      const auto fused = fuse_session(session_of(hand, "0002:0001:"), {.use = named(use), .smooth = smooth});
      ASSERT_TRUE(fused.has_value()) << fused.error().message;
      EXPECT_EQ(fused->rows.size(), std::string(use) == "imu,pose" ? 2500U : 500U);
      const FusedRow& row = fused->rows[fused->rows.size() * 3 / 4 - 1];
      const double t = seconds(row.time.time_since_epoch());
      ASSERT_TRUE(row.position_m.has_value());
      EXPECT_LT((*row.position_m - hand.position(t)).norm(), 3e-3) << use << smooth;
      EXPECT_GT(row.covariance.diagonal().minCoeff(), 0);
    }
  }
}

// All clocks fall back by six seconds at the middle: the same times come twice, in another place. Or the
// tracker's alone does.
TEST(FuseSession, RunsBeforeAndAfterAClockThatBeginsAgainAreSmoothedApart) {
  const SimulatedHand hand;
  for (const bool all : {true, false}) {
    Session session = session_of(hand, "0002:0001:");
    constexpr double middle_s = 6, back_s = 6;
    const Eigen::Vector3d away(0.3, -0.2, 0.1);
    for (RecordedSample& sample : session.samples) {
      if (auto* imu = std::get_if<ImuSample>(&sample.sample);
          imu != nullptr && all && imu->time.host > at_second(middle_s))
        imu->time.host -= std::chrono::seconds(6);
      auto* pose = std::get_if<PoseSample>(&sample.sample);
      if (pose == nullptr || pose->time.host <= at_second(middle_s)) continue;
      pose->time.host -= std::chrono::seconds(6);
      if (all) pose->tracker_from_tool.translation += away;
    }
    const auto fused = fuse_session(session, {.use = named("gyro,accel,pose"), .smooth = true});
    ASSERT_TRUE(fused.has_value()) << fused.error().message;
    ASSERT_EQ(fused->rows.size(), 2500U);
    EXPECT_EQ(fused->lateness.restarts, all ? 1U : 0U);
    EXPECT_EQ(fused->lateness.rejoined, all ? 0U : 1U);
    for (const std::size_t i : {500U, 1000U, 1300U, 1400U, 1800U, 2200U, 2400U}) {
      const bool later = all && (double(i) + 1) * step_s > middle_s;
      const double t = seconds(fused->rows[i].time.time_since_epoch()) + (later ? back_s : 0);
      ASSERT_TRUE(fused->rows[i].position_m) << i;
      const Eigen::Vector3d truth = hand.position(t) + (later ? away : Eigen::Vector3d::Zero());
      EXPECT_LT((*fused->rows[i].position_m - truth).norm(), 3e-3) << i << " " << all;
    }
  }
}

TEST(FuseSession, WhatIsNotThereIsSaid) {
  const Session session = session_of({}, "text:imu-csv");
  EXPECT_EQ(fuse_session(session, {.use = named("range")}).error().fault, Fault::usage);
  EXPECT_EQ(fuse_session(session, {.use = named("pose")}).error().fault, Fault::usage);
  EXPECT_EQ(fuse_session(session, {.use = named("gyro,mag")}).error().fault, Fault::usage);
  EXPECT_EQ(fuse_session(session, {.use = named("gyro,opt_pose")}).error().fault, Fault::usage);
  EXPECT_EQ(fuse_session(Session{}, {}).error().fault, Fault::not_found);
}

TEST(FuseSession, GyroAloneTurnsFromWhereItStood) {
  SimulatedHand hand;
  hand.gyro_bias_radps.setZero();
  const auto fused = fuse_session(session_of(hand, "text:imu-csv"), {.use = named("gyro")});
  ASSERT_TRUE(fused.has_value());
  const Eigen::Quaterniond turned = hand.rotation(step_s).conjugate() * hand.rotation(10);
  EXPECT_LT(fused->rows.back().world_from_sensor->angularDistance(turned), 1e-6);
}

TEST(FuseSession, TheTable) {
  const auto fused = fuse_session(session_of({}, "text:imu-csv"), {.use = named("imu")});
  std::istringstream lines(csv_of(*fused));
  std::string header, first;
  std::getline(lines, header);
  std::getline(lines, first);
  EXPECT_EQ(header, "t_s,x_m,y_m,z_m,qw,qx,qy,qz,var_0,var_1,var_2,var_3,var_4,var_5,state");
  EXPECT_EQ(first.substr(0, 15), "0.004000000,,,,");
  EXPECT_EQ(std::count(first.begin(), first.end(), ','), 14);
  EXPECT_EQ(first.substr(first.size() - 3), ",OK");
}

TEST(FuseSession, TipAndReceiversComeFromTheSessionsCalibration) {
  const SimulatedHand hand;
  Session session = session_of(hand, "text:imu-csv");
  session.devices.push_back({3, {.id = "0003:0001:", .name = "ears", .kind = DeviceKind::ultrasonic}});
  session.calibrations.push_back(
      {"ears",
       "emitter_m = [0.01, 0.0, 0.1]\n"
       "receivers_m = [[-0.1, 0.0, 0.5], [0.4, 0.0, 0.5], [0.4, 0.45, 0.5], [-0.1, 0.45, 0.45]]\n"});
  const std::array receivers{Eigen::Vector3d(-0.1, 0, 0.5), Eigen::Vector3d(0.4, 0, 0.5),
                             Eigen::Vector3d(0.4, 0.45, 0.5), Eigen::Vector3d(-0.1, 0.45, 0.45)};
  const std::vector<RecordedSample> before = session.samples;
  session.samples.clear();
  for (const RecordedSample& sample : before) {
    session.samples.push_back(sample);
    const auto* imu = std::get_if<ImuSample>(&sample.sample);
    if (imu == nullptr) continue;
    const double t = seconds(imu->time.host.time_since_epoch());
    RangeSample range{.time = imu->time, .receivers = 4, .temperature_c = 20};
    for (std::size_t i = 0; i < 4; ++i)
      range.flight_s[i] =
          (hand.position(t) + hand.rotation(t) * Eigen::Vector3d(0.01, 0, 0.1) - receivers[i]).norm() /
          343.21;  // m/s at 20 degrees
    session.samples.push_back({3, range, 0});
  }
  const auto fused = fuse_session(session, {.use = named("gyro,accel,range")});
  ASSERT_TRUE(fused.has_value()) << fused.error().message;
  EXPECT_LT((fused->rows.back().position_m.value() - hand.position(10)).norm(), 3e-3);
  for (const char* wrong : {"emitter_m = [", "emitter_m = [0.1, 0.2]", "emitter_m = [[0.0, 0.0, 0.1], [0.1]]",
                            "receivers_m = [[0.0, nan, 0.1]]"}) {
    session.calibrations.front().toml = wrong;
    EXPECT_EQ(fuse_session(session, {}).error().fault, Fault::malformed) << wrong;
  }
}

// Gravity does not show how the brush is turned about the vertical; two emitters that fire in turn do,
// wherever north is. A third, of which nothing is known, says nothing.
TEST(FuseSession, TwoEmittersGiveTheWholeOrientation) {
  const std::array emitters{Eigen::Vector3d(0.01, 0.01, 0.1), Eigen::Vector3d(0.06, -0.04, 0.02)};
  const std::array receivers{Eigen::Vector3d(-0.1, 0, 0.5), Eigen::Vector3d(0.4, 0, 0.5),
                             Eigen::Vector3d(0.4, 0.45, 0.5), Eigen::Vector3d(-0.1, 0.45, 0.45),
                             Eigen::Vector3d(0.15, 0.6, 0.1)};
  const SimulatedHand hand;
  for (const double heading_deg : {0.0, 70.0, 140.0, -110.0}) {
    // Everything stands turned in the room; the inertial unit feels nothing of it.
    const Eigen::Quaterniond room = rotation_of({0, 0, heading_deg * std::numbers::pi / 180});
    Session session = session_of(hand, "text:imu-csv");
    session.devices.push_back({3, {.id = "0003:0001:", .name = "ears", .kind = DeviceKind::ultrasonic}});
    std::string toml = "emitter_m = [[0.01, 0.01, 0.1], [0.06, -0.04, 0.02]]\nreceivers_m = [";
    for (const Eigen::Vector3d& receiver : receivers) {
      const Eigen::Vector3d place = room * receiver;
      toml += "[" + std::to_string(place.x()) + "," + std::to_string(place.y()) + "," +
              std::to_string(place.z()) + "],";
    }
    session.calibrations.push_back({"ears", toml + "]\n"});
    SimulatedNoise noise(5);
    std::vector<RecordedSample> samples;
    std::uint64_t pulses = 0;
    for (const RecordedSample& sample : session.samples) {
      samples.push_back(sample);
      const auto* imu = std::get_if<ImuSample>(&sample.sample);
      if (imu == nullptr) continue;
      const double t = seconds(imu->time.host.time_since_epoch());
      const auto emitter = static_cast<std::uint8_t>(pulses++ % 3);
      const Eigen::Vector3d place =
          hand.position(t) + hand.rotation(t) * (emitter < 2 ? emitters[emitter] : Eigen::Vector3d::Zero());
      RangeSample range{.time = imu->time, .emitter = emitter, .receivers = 5, .temperature_c = 20};
      for (std::size_t i = 0; i < receivers.size(); ++i)
        range.flight_s[i] = ((place - receivers[i]).norm() + 5e-4 * noise.normal(noise.generator)) / 343.21;
      samples.push_back({3, range, 0});
    }
    session.samples = std::move(samples);
    const auto fused = fuse_session(session, {.use = named("gyro,accel,range")});
    ASSERT_TRUE(fused.has_value()) << fused.error().message;
    EXPECT_EQ(fused->unplaced_pulses, pulses / 3);
    double places = 0, turns = 0;
    int count = 0;
    for (const FusedRow& row : fused->rows) {
      const double t = seconds(row.time.time_since_epoch());
      if (t < 5) continue;
      ASSERT_TRUE(row.position_m) << t;
      places += (*row.position_m - room * hand.position(t)).squaredNorm();
      turns += std::pow(row.world_from_sensor->angularDistance(room * hand.rotation(t)), 2);
      ++count;
    }
    const double place_mm = 1e3 * std::sqrt(places / count);
    const double turn_deg = in_degrees(Radians(std::sqrt(turns / count)));
    std::printf("figure: two emitters in turn, turned by %.0f deg in the room: %.2f mm, %.2f deg\n",
                heading_deg, place_mm, turn_deg);
    EXPECT_LT(place_mm, 1);
    EXPECT_LT(turn_deg, 0.5);
  }
}

TEST(FuseSession, AnImportedRecording) {
  const std::string name = optical_recordings[0];
  REQUIRE_RECORDING(name);
  const auto file = std::filesystem::path(testing::TempDir()) /
                    ("fude-fuse-imported-" + std::to_string(getpid()) + ".fude");
  ASSERT_TRUE(import_session(recordings() / name, file, {.overwrite = true}).has_value());
  const auto session = read_session(file);
  ASSERT_TRUE(session.has_value());
  const InertialRecording truth = read_inertial_recording(name);
  const auto begin = std::chrono::steady_clock::now();
  for (const char* use : {"imu", "gyro,accel", "imu,opt_position", "imu,opt_pose"}) {
    const auto fused = fuse_session(*session, {.use = named(use)});
    ASSERT_TRUE(fused.has_value()) << fused.error().message;
    ASSERT_EQ(fused->rows.size(), truth.truth.size());
    OrientationError error;
    for (std::size_t i = 0; i < truth.truth.size(); ++i) {
      ASSERT_EQ(fused->rows[i].time, truth.imu[i].time.host);
      if (truth.truth[i].valid && truth.imu[i].buttons != 0)
        error.add(*fused->rows[i].world_from_sensor, truth.truth[i].tracker_from_tool.rotation);
    }
    std::printf("figure: %s by %s: total %.3f inclination %.3f deg\n", name.c_str(), use, error.total(),
                error.inclination());
    EXPECT_LT(error.inclination(), 1);
  }
  std::printf("figure: four fusions of 90 s in %.2f s\n",
              std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
}

}  // namespace
}  // namespace fude
