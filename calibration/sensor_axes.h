// How an inertial unit's axes lie to those of the markers on the same handle: what its gyroscope says of a
// turn, against what the tracker saw of it.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "calibration/pose_screen.h"
#include "calibration/report.h"
#include "signal/imu_sample.h"
#include "signal/pose_sample.h"

namespace fude {

struct SensorAxes {
  Eigen::Quaterniond tool_from_sensor = Eigen::Quaterniond::Identity();
};
Fields to_fields(const SensorAxes& axes);
std::optional<SensorAxes> sensor_axes_from(const Fields& fields);

class SensorAxesProcedure {
 public:
  // Each stream in the order of its time; the two may come one after the other.
  Progress add(const ImuSample& sample);
  Progress add(const PoseSample& sample);

  // The turns of a quarter of a second, of which both streams need but the ends; never across a gap. First
  // their axes alone (Wahba 1965, by the q-method's singular values, Markley 1988), then least squares with
  // the gyroscope's offset and a constant lag of either stream, up to 0.2 s. Residuals are the angles between
  // the two turns. Refused: too few turns seen by both; turning about one axis only (condition above 15);
  // rates in degrees; an axis with the wrong sign; turns that differ by 5 degrees, or more than a quarter
  // that do not agree; an interval above 5 degrees. Details: lag_s, by which the unit's times are later,
  // and gyro_bias_radps. unit: degrees.
  Calibration<SensorAxes> finish() const;

 private:
  Progress progress() const;

  std::vector<ImuSample> readings_;
  std::vector<PoseSample> poses_;
  PoseScreen screen_;
  std::string tool_;
  Eigen::Matrix3d turning_ = Eigen::Matrix3d::Zero();  // of the rates
};

}  // namespace fude
