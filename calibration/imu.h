// What an inertial unit's readings lack: laid on its sides and left at rest on each, then tumbled.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "calibration/report.h"
#include "signal/imu_sample.h"

namespace fude {

// In the unit's own frame. True values: turn_rate − gyro_bias, accel_scale ∘ (force − accel_bias), and
// mag_shape · (field − mag_offset), whose length is that of the readings' mean field.
struct ImuCalibration {
  Eigen::Vector3d gyro_bias_radps = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_bias_mps2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_scale = Eigen::Vector3d::Ones();
  struct Magnetometer {
    Eigen::Vector3d offset_ut = Eigen::Vector3d::Zero();  // hard iron
    Eigen::Matrix3d shape = Eigen::Matrix3d::Identity();  // soft iron, symmetric
  };
  std::optional<Magnetometer> magnetometer;
};
Fields to_fields(const ImuCalibration& imu);
std::optional<ImuCalibration> imu_from(const Fields& fields);

inline constexpr double standard_gravity_mps2 = 9.80665;

class ImuProcedure {
 public:
  Progress add(const ImuSample& sample);

  // Bias of the gyroscope from the rests, bias and scale of the accelerometer from the length of gravity in
  // at least six directions that span all axes, the magnetometer's ellipsoid from all of its readings. The
  // scale of the gyroscope needs a turntable and is not sought. Residuals are lengths of gravity less its
  // true one. Refused: no rest of 0.4 s, too few directions, a condition above 50, a residual above
  // 0.2 m/s², a scale more than a fifth off. A field that no ellipsoid fits (a magnet near by) or that was
  // seen from too few sides leaves the magnetometer out, with a warning.
  Calibration<ImuCalibration> finish() const;

 private:
  struct Rest {
    Eigen::Vector3d turn_rate_radps, force_mps2;
  };
  void end_window();

  std::vector<Rest> rests_;
  std::vector<Eigen::Vector3d> directions_;  // of gravity, 25° apart
  std::vector<Eigen::Vector3d> fields_ut_;
  std::vector<ImuSample> window_;
  std::size_t seen_ = 0, unusable_ = 0, backwards_ = 0;
};

}  // namespace fude
