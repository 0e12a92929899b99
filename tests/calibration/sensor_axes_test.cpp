#include "calibration/sensor_axes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "calibration/fusion/motion_state.h"
#include "calibration/turned_path.h"
#include "signal/units.h"
#include "tests/calibration/fusion/inertial_recording.h"
#include "tests/fakes/scripted_tracker.h"

namespace fude {
namespace {

const Eigen::Quaterniond truth(Eigen::AngleAxisd(2.2, Eigen::Vector3d(-1, 0.4, 2).normalized()));

double degrees_off(const Eigen::Quaterniond& found, const Eigen::Quaterniond& true_axes = truth) {
  return in_degrees(Radians(found.angularDistance(true_axes)));
}

struct Scene {
  double seconds = 20;
  double flatness = 1;  // 0: turning about one axis alone
  double lag_s = 0;     // of the unit
  double pose_noise_rad = 2e-3;
  Eigen::Vector3d bias_radps{0.02, -0.01, 0.03};

  Eigen::Quaterniond tool_at(double t) const {
    const Eigen::Vector3d turn(0.9 * std::sin(3.1 * t), flatness * 0.7 * std::sin(2.3 * t + 1),
                               flatness * 0.8 * std::sin(1.7 * t + 2));
    return rotation_of(turn);
  }
  std::vector<ImuSample> readings(std::uint32_t seed = 1) const {
    constexpr double rate_hz = 200, half_s = 1e-4;
    Noise noise(seed);
    std::vector<ImuSample> samples;
    for (int i = 0; i < int(seconds * rate_hz); ++i) {
      const double t = i / rate_hz;
      const Eigen::Vector3d rate =
          turn_of(tool_at(t - lag_s - half_s).conjugate() * tool_at(t - lag_s + half_s)) / (2 * half_s);
      ImuSample& sample = samples.emplace_back();
      sample.time.host = Timestamp(Duration(std::llround(1e9 * (3 + t))));
      sample.turn_rate_radps = truth.conjugate() * rate + bias_radps + noise.vector(3e-3);
    }
    return samples;
  }
  std::vector<PoseSample> poses(std::uint32_t seed = 1) const {
    constexpr double rate_hz = 60;
    Noise noise(seed + 1000);
    std::vector<PoseSample> samples;
    for (int i = 0; i < int(seconds * rate_hz); ++i) {
      const double t = (i + 0.3) / rate_hz;
      samples.push_back(
          pose_sample({tool_at(t) * rotation_of(noise.vector(pose_noise_rad)), {0.1, 0.2, 1}}, 3 + t));
    }
    return samples;
  }
};

Calibration<SensorAxes> found(const std::vector<ImuSample>& readings, const std::vector<PoseSample>& poses) {
  SensorAxesProcedure procedure;
  for (const ImuSample& reading : readings) procedure.add(reading);
  for (const PoseSample& pose : poses) procedure.add(pose);
  return procedure.finish();
}
Calibration<SensorAxes> found(const Scene& scene, std::uint32_t seed = 1) {
  return found(scene.readings(seed), scene.poses(seed));
}

TEST(TurnedPath, AnEvenTurnAddsUpAndItsOffsetComesOff) {
  std::vector<ImuSample> readings(101);
  const Eigen::Vector3d rate(0.4, -1, 2), bias(0.01, 0.02, -0.03);
  for (int i = 0; i <= 100; ++i) {
    readings[std::size_t(i)].time.host = Timestamp(std::chrono::milliseconds(10 * i));
    readings[std::size_t(i)].turn_rate_radps = rate + bias;
  }
  const auto at = [](int ms) { return Timestamp(std::chrono::milliseconds(ms)); };
  const TurnedPath path(readings, bias);
  const auto turned = path.between(at(103), at(888));
  ASSERT_TRUE(turned);
  EXPECT_LT(turned->rotation.angularDistance(rotation_of(0.785 * rate)), 1e-7);
  EXPECT_NEAR(path.lasted_s(), 1, 1e-9);
  EXPECT_NEAR(path.turned_rad(), rate.norm(), 1e-9);
  // What a change of the offset does, by its derivative and by doing it.
  const Eigen::Vector3d change(1e-4, -2e-4, 1e-4);
  const auto other = TurnedPath(readings, bias + change).between(at(103), at(888));
  EXPECT_LT((turn_of(turned->rotation.conjugate() * other->rotation) + turned->by_bias * change).norm(),
            1e-6);
  EXPECT_FALSE(path.between(at(500), at(1001)));
  readings[50].valid = false;
  EXPECT_FALSE(TurnedPath(readings, bias).between(at(103), at(888)));
}

TEST(SensorAxes, TheRotationIsFoundWithOffsetAndLag) {
  for (const double lag_s : {0.0, 0.012, -0.08}) {
    const auto result = found(Scene{.lag_s = lag_s});
    ASSERT_TRUE(result) << result.error().reason;
    const double off = degrees_off(result->value.tool_from_sensor);
    std::printf(
        "figure: sensor axes, simulated with a lag of %.0f ms: %.4f degrees off, within %.4f stated\n",
        1e3 * lag_s, off, (*result->report.ci95)[1]);
    EXPECT_LT(off, 0.05);
    EXPECT_LT((*result->report.ci95)[1], 0.1);
    EXPECT_NEAR(numbers_in(result->report.details, "lag_s")->front(), lag_s, 1e-3);
    const auto bias = *numbers_in(result->report.details, "gyro_bias_radps");
    EXPECT_LT((Eigen::Vector3d(bias.data()) - Scene{}.bias_radps).norm(), 2e-3);
    EXPECT_EQ(result->report.warnings.empty(), std::abs(lag_s) < 5e-3);
  }
}

TEST(SensorAxes, TheStatedIntervalHoldsTheTruth) {
  int within = 0;
  for (std::uint32_t seed = 0; seed < 30; ++seed) {
    const auto result = found(Scene{.seconds = 6, .pose_noise_rad = 5e-3}, seed);
    ASSERT_TRUE(result) << result.error().reason;
    within += degrees_off(result->value.tool_from_sensor) < (*result->report.ci95)[1];
  }
  std::printf("figure: sensor axes: the stated interval held the truth in %d of 30\n", within);
  EXPECT_GE(within, 27);
}

TEST(SensorAxes, FlipsAndGapsAreNamedAndLeftOut) {
  const Scene scene;
  auto poses = scene.poses();
  for (std::size_t i = 200; i < 240; ++i)
    poses[i].tracker_from_tool.rotation =
        poses[i].tracker_from_tool.rotation * Eigen::Quaterniond(0, 1, 0, 0);
  for (std::size_t i = 600; i < 700; ++i) poses[i].valid = false;
  auto readings = scene.readings();
  readings.erase(readings.begin() + 2500, readings.begin() + 2600);
  const auto result = found(readings, poses);
  ASSERT_TRUE(result) << result.error().reason;
  EXPECT_LT(degrees_off(result->value.tool_from_sensor), 0.05);
  ASSERT_EQ(result->report.warnings.size(), 2u);
  EXPECT_NE(result->report.warnings[1].find("turns are outliers"), std::string::npos);
}

// The publishers turned the recordings so that the axes agree.
TEST(SensorAxes, RecordedUnitsAgreeWithTheirPublishers) {
  for (const char* name : optical_recordings) {
    REQUIRE_RECORDING(name);
    const InertialRecording recording = read_inertial_recording(name);
    const auto result = found(recording.imu, recording.truth);
    ASSERT_TRUE(result) << name << ": " << result.error().reason;
    const double off = degrees_off(result->value.tool_from_sensor, Eigen::Quaterniond::Identity());
    std::printf(
        "figure: sensor axes of %s: %.2f degrees from the published ones, within %.2f stated, rms %.2f, "
        "condition %.1f, lag %.1f ms\n",
        name, off, (*result->report.ci95)[1], result->report.rms, *result->report.condition,
        1e3 * numbers_in(result->report.details, "lag_s")->front());
    EXPECT_LT(off, 2);
  }
}

TEST(SensorAxes, ResultsReadBack) {
  const auto read = sensor_axes_from(to_fields({truth}));
  ASSERT_TRUE(read);
  EXPECT_LT(degrees_off(read->tool_from_sensor), 1e-6);
  EXPECT_FALSE(sensor_axes_from({{"tool_from_sensor_q", std::vector{1.0, 1.0, 0.0, 0.0}}}));
}

void expect_refused(const std::vector<ImuSample>& readings, const std::vector<PoseSample>& poses,
                    const std::string& cause) {
  const auto result = found(readings, poses);
  ASSERT_FALSE(result) << "accepted, where it should name: " << cause;
  EXPECT_NE(result.error().reason.find(cause), std::string::npos) << result.error().reason;
}

TEST(SensorAxesRefuse, TurningAboutOneAxis) {
  const Scene scene{.flatness = 0};
  expect_refused(scene.readings(), scene.poses(), "turn it about another axis too");
}

TEST(SensorAxesRefuse, NoMotionAndNoMeeting) {
  const Scene scene;
  auto poses = scene.poses();
  expect_refused({}, poses, "only 0 turns");
  for (PoseSample& pose : poses) pose.tracker_from_tool = poses[0].tracker_from_tool;
  expect_refused(scene.readings(), poses, "the tracker is frozen");
  Noise noise(5);
  for (PoseSample& pose : poses)
    pose.tracker_from_tool.rotation = poses[0].tracker_from_tool.rotation * rotation_of(noise.vector(1e-3));
  expect_refused(scene.readings(), poses, "hardly any turning");
}

TEST(SensorAxesRefuse, DegreesForRadians) {
  const Scene scene;
  auto readings = scene.readings();
  for (ImuSample& reading : readings) reading.turn_rate_radps *= 57.2958;
  expect_refused(readings, scene.poses(), "degrees a second");
}

TEST(SensorAxesRefuse, AMirroredAxis) {
  const Scene scene;
  auto readings = scene.readings();
  for (ImuSample& reading : readings) reading.turn_rate_radps.y() *= -1;
  expect_refused(readings, scene.poses(), "wrong sign");
}

TEST(SensorAxesRefuse, AnotherMotion) {
  Scene other;
  other.flatness = 0.3;
  auto readings = other.readings();
  std::reverse(readings.begin(), readings.end());
  for (std::size_t i = 0; i < readings.size(); ++i)
    readings[i].time.host = Timestamp(std::chrono::milliseconds(3000 + 5 * int(i)));
  EXPECT_FALSE(found(readings, Scene{}.poses()));
}

}  // namespace
}  // namespace fude
