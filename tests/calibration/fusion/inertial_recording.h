// An inertial recording with its optical truth, and how its publishers measure an error.
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "capture/import/import.h"
#include "signal/imu_sample.h"
#include "signal/pose_sample.h"
#include "signal/units.h"
#include "tests/fakes/recordings.h"

namespace fude {

inline constexpr std::array optical_recordings{
    "imu_optical/broad_02_undisturbed_slow_rotation_B.csv.gz",
    "imu_optical/broad_07_undisturbed_fast_rotation_B.csv.gz",
    "imu_optical/broad_15_undisturbed_fast_translation_A.csv.gz",
    "imu_optical/broad_21_undisturbed_fast_combined.csv.gz",
};

struct InertialRecording {
  std::vector<ImuSample> imu;
  std::vector<PoseSample> truth;  // as many, at the same times
};

inline InertialRecording read_inertial_recording(const std::string& name) {
  InertialRecording recording;
  const auto file = import_file(recordings() / name, {});
  if (!file) {
    ADD_FAILURE() << file.error().message;
    return recording;
  }
  for (const RawRecording& device : file->recordings)
    for (const Sample& sample : device.samples) {
      if (const auto* imu = std::get_if<ImuSample>(&sample)) recording.imu.push_back(*imu);
      if (const auto* pose = std::get_if<PoseSample>(&sample)) recording.truth.push_back(*pose);
    }
  EXPECT_EQ(recording.imu.size(), recording.truth.size());
  return recording;
}

// Root mean squares in degrees over the rows that count: the error turned in the earth frame, its part about
// the vertical, and the rest.
class OrientationError {
 public:
  void add(const Eigen::Quaterniond& estimate, const Eigen::Quaterniond& truth) {
    const Eigen::Quaterniond e = estimate * truth.conjugate();
    const auto square = [](double angle) { return std::pow(in_degrees(Radians(angle)), 2); };
    total_ += square(2 * std::acos(std::min(1.0, std::abs(e.w()))));
    heading_ += square(2 * std::atan(std::abs(e.z() / e.w())));
    inclination_ += square(2 * std::acos(std::min(1.0, std::hypot(e.w(), e.z()))));
    ++count_;
  }
  double total() const { return std::sqrt(total_ / count_); }
  double heading() const { return std::sqrt(heading_ / count_); }
  double inclination() const { return std::sqrt(inclination_ / count_); }

 private:
  double total_ = 0, heading_ = 0, inclination_ = 0, count_ = 0;
};

}  // namespace fude
