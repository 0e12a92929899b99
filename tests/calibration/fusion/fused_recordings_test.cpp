// Recordings with optical truth: what is left of it thinned to 30 Hz, with noise and late, against all of it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

#include "calibration/fusion/smoother.h"
#include "tests/calibration/fusion/inertial_recording.h"

namespace fude {
namespace {

FusionSettings settings_for_a_tracker() {
  FusionSettings settings;
  settings.lever_sigma_m = 0.05;
  settings.lag_sigma_s = 0.01;
  return settings;
}

struct LateFix {
  Timestamp arrives{};
  Timestamp stamped{};
  PointFix fix;
};

// 30 Hz, 1 mm of noise a coordinate, 20 ms late; with gaps: nothing in the first 200 ms of every two seconds.
std::vector<LateFix> thinned(const InertialRecording& recording, bool gaps) {
  std::mt19937 generator(7);
  std::normal_distribution<double> noise(0, 1e-3);
  std::vector<LateFix> fixes;
  double next = 0;
  for (const PoseSample& sample : recording.truth) {
    const double t = seconds(sample.time.host.time_since_epoch());
    if (t < next) continue;
    next += 1.0 / 30;
    const Eigen::Vector3d error(noise(generator), noise(generator), noise(generator));
    if (!sample.valid || (gaps && std::fmod(t, 2) < 0.2)) continue;
    fixes.push_back({sample.time.host + std::chrono::milliseconds(20), sample.time.host,
                     PointFix{.point_m = sample.tracker_from_tool.translation + error}});
  }
  return fixes;
}

struct Accuracy {
  OrientationError orientation;
  double squares = 0, gap_squares = 0;
  std::vector<double> in_gaps_m;
  int count = 0;

  void add(const FusedPose& pose, const PoseSample& truth, bool moving) {
    if (!truth.valid || !moving) return;
    orientation.add(pose.world_from_sensor, truth.tracker_from_tool.rotation);
    if (pose.state == FusionState::lost) return;
    const double error = (pose.point_m - truth.tracker_from_tool.translation).norm();
    squares += error * error;
    ++count;
    if (std::fmod(seconds(truth.time.host.time_since_epoch()), 2) >= 0.2) return;
    gap_squares += error * error;
    in_gaps_m.push_back(error);
  }
  double position_mm() const { return 1e3 * std::sqrt(squares / count); }
  double gap_mm() const { return 1e3 * std::sqrt(gap_squares / static_cast<double>(in_gaps_m.size())); }
  double gap_p95_mm() {
    std::sort(in_gaps_m.begin(), in_gaps_m.end());
    return 1e3 * in_gaps_m[in_gaps_m.size() * 95 / 100];
  }
};

InertialReading reading_of(const ImuSample& imu) {
  return {imu.turn_rate_radps, imu.specific_force_mps2, imu.magnetic_field_ut};
}

Accuracy causal(const InertialRecording& recording, bool gaps) {
  const std::vector<LateFix> fixes = thinned(recording, gaps);
  Fusion fusion(settings_for_a_tracker());
  Accuracy accuracy;
  std::size_t next = 0;
  for (std::size_t i = 0; i < recording.imu.size(); ++i) {
    const ImuSample& imu = recording.imu[i];
    fusion.add(reading_of(imu), imu.time.host);
    for (; next < fixes.size() && fixes[next].arrives <= imu.time.host; ++next)
      fusion.add(fixes[next].fix, fixes[next].stamped);
    accuracy.add(fusion.pose(), recording.truth[i], imu.buttons != 0);
  }
  return accuracy;
}

Accuracy smoothed(const InertialRecording& recording, bool gaps) {
  std::vector<FusionInput> inputs;
  const std::vector<LateFix> fixes = thinned(recording, gaps);
  std::size_t next = 0;
  for (const ImuSample& imu : recording.imu) {
    inputs.push_back({imu.time.host, reading_of(imu)});
    for (; next < fixes.size() && fixes[next].stamped <= imu.time.host; ++next)
      inputs.push_back({fixes[next].stamped, fixes[next].fix});
  }
  const std::vector<FusedPose> poses = smooth(inputs, settings_for_a_tracker());
  EXPECT_EQ(poses.size(), recording.imu.size());
  Accuracy accuracy;
  for (std::size_t i = 0; i < poses.size(); ++i)
    accuracy.add(poses[i], recording.truth[i], recording.imu[i].buttons != 0);
  return accuracy;
}

TEST(FusedRecordings, ThinLateNoisyPositionsAndTheInertialUnit) {
  double total = 0, position = 0, gap = 0, gap_p95 = 0, smooth_total = 0, smooth_position = 0;
  for (const char* name : optical_recordings) {
    REQUIRE_RECORDING(name);
    const InertialRecording recording = read_inertial_recording(name);
    Accuracy a = causal(recording, false), b = causal(recording, true), c = smoothed(recording, true);
    std::printf(
        "figure: %s total %.3f deg position %.2f mm; gaps of 200 ms %.2f p95 %.2f mm; smoothed with gaps "
        "%.3f deg %.2f mm, in gaps %.2f mm\n",
        name, a.orientation.total(), a.position_mm(), b.gap_mm(), b.gap_p95_mm(), c.orientation.total(),
        c.position_mm(), c.gap_mm());
    total += a.orientation.total() / 4;
    position += a.position_mm() / 4;
    gap += b.gap_mm() / 4;
    gap_p95 += b.gap_p95_mm() / 4;
    smooth_total += c.orientation.total() / 4;
    smooth_position += c.position_mm() / 4;
    EXPECT_LT(c.position_mm(), b.position_mm());
  }
  std::printf(
      "figure: mean total %.3f deg position %.2f mm; gaps %.2f p95 %.2f mm; smoothed %.3f deg %.2f mm\n",
      total, position, gap, gap_p95, smooth_total, smooth_position);
  EXPECT_LE(total, 1.5);
  EXPECT_LE(position, 1.5);
  EXPECT_LE(gap, 5);
  EXPECT_LE(gap_p95, 10);
  EXPECT_LT(smooth_total, total);
}

TEST(FusedRecordings, OrientationAloneSmoothed) {
  double total = 0, inclination = 0;
  for (const char* name : optical_recordings) {
    REQUIRE_RECORDING(name);
    const InertialRecording recording = read_inertial_recording(name);
    std::vector<OrientationInput> inputs;
    for (const ImuSample& imu : recording.imu) inputs.push_back({imu.time.host, reading_of(imu)});
    const auto middle = smooth_orientation(inputs, {});
    OrientationError error;
    for (std::size_t i = 0; i < middle.size(); ++i)
      if (recording.truth[i].valid && recording.imu[i].buttons != 0)
        error.add(middle[i], recording.truth[i].tracker_from_tool.rotation);
    std::printf("figure: %s smoothed total %.3f inclination %.3f deg\n", name, error.total(),
                error.inclination());
    total += error.total() / 4;
    inclination += error.inclination() / 4;
  }
  std::printf("figure: smoothed mean total %.3f inclination %.3f deg\n", total, inclination);
  EXPECT_LE(total, 1.85);
  EXPECT_LE(inclination, 0.91);
}

}  // namespace
}  // namespace fude
