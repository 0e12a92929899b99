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
  settings.gyro_lag_sigma_s = 0.001;
  return settings;
}

struct LateFix {
  Timestamp arrives{};
  Timestamp stamped{};
  PointFix fix;
};

constexpr Duration delay = std::chrono::milliseconds(20);

enum class Stamp { when_seen, when_it_arrives };

struct Thinning {
  unsigned seed = 7;
  bool gaps = false;  // nothing in the first 200 ms of every two seconds
  Stamp stamp = Stamp::when_seen;
};

// 30 Hz, 1 mm of noise a coordinate, 20 ms late.
std::vector<LateFix> thinned(const InertialRecording& recording, const Thinning& how) {
  std::mt19937 generator(how.seed);
  std::normal_distribution<double> noise(0, 1e-3);
  std::vector<LateFix> fixes;
  double next = 0;
  for (const PoseSample& sample : recording.truth) {
    const double t = seconds(sample.time.host.time_since_epoch());
    if (t < next) continue;
    next += 1.0 / 30;
    const Eigen::Vector3d error(noise(generator), noise(generator), noise(generator));
    if (!sample.valid || (how.gaps && std::fmod(t, 2) < 0.2)) continue;
    const Timestamp arrives = sample.time.host + delay;
    fixes.push_back({arrives, how.stamp == Stamp::when_seen ? sample.time.host : arrives,
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

class Mean {
 public:
  // Of a run without gaps, and of the gaps of one with them.
  void add(Accuracy whole, Accuracy gaps) {
    sum_ += Eigen::Vector4d(whole.orientation.total(), whole.position_mm(), gaps.gap_mm(), gaps.gap_p95_mm());
    ++count_;
  }
  void add(const Mean& other) {
    sum_ += other.sum_;
    count_ += other.count_;
  }
  double total() const { return sum_[0] / count_; }
  double position_mm() const { return sum_[1] / count_; }
  double gap_mm() const { return sum_[2] / count_; }
  double gap_p95_mm() const { return sum_[3] / count_; }
  void print(const char* what) const {
    std::printf("figure: %s: total %.3f deg position %.2f mm; gaps of 200 ms %.2f p95 %.2f mm\n", what,
                total(), position_mm(), gap_mm(), gap_p95_mm());
  }

 private:
  Eigen::Vector4d sum_ = Eigen::Vector4d::Zero();
  int count_ = 0;
};

InertialReading reading_of(const ImuSample& imu) {
  return {imu.turn_rate_radps, imu.specific_force_mps2, imu.magnetic_field_ut};
}

Accuracy causal(const InertialRecording& recording, const Thinning& how) {
  const std::vector<LateFix> fixes = thinned(recording, how);
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

Accuracy smoothed(const InertialRecording& recording, const Thinning& how) {
  std::vector<FusionInput> inputs;
  const std::vector<LateFix> fixes = thinned(recording, how);
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

// Four draws of the noise each: one alone says little where a limit is near.
TEST(FusedRecordings, ThinLateNoisyPositionsAndTheInertialUnit) {
  constexpr unsigned draws = 4;
  Mean all, in_time, smooth_all;
  for (const char* name : optical_recordings) {
    REQUIRE_RECORDING(name);
    const InertialRecording recording = read_inertial_recording(name);
    Mean here;
    for (unsigned seed = 7; seed < 7 + draws; ++seed) {
      here.add(causal(recording, {.seed = seed}), causal(recording, {.seed = seed, .gaps = true}));
      if (seed == 7) {
        const Accuracy with_gaps = smoothed(recording, {.gaps = true});
        smooth_all.add(with_gaps, with_gaps);
        in_time.add(causal(recording, {.stamp = Stamp::when_it_arrives}), with_gaps);
      }
    }
    here.print(name);
    all.add(here);
  }
  all.print("mean");
  smooth_all.print("mean, smoothed, with gaps");
  std::printf("figure: mean where positions are stamped 20 ms late: total %.3f deg position %.2f mm\n",
              in_time.total(), in_time.position_mm());
  EXPECT_LE(all.total(), 0.75);
  EXPECT_LE(all.position_mm(), 1.45);
  EXPECT_LE(all.gap_mm(), 3);
  EXPECT_LE(all.gap_p95_mm(), 6);
  EXPECT_LE(in_time.total(), 1.5);
  EXPECT_LE(in_time.position_mm(), 1.5);
  EXPECT_LT(smooth_all.total(), all.total());
  EXPECT_LT(smooth_all.position_mm(), 0.7 * all.position_mm());
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
