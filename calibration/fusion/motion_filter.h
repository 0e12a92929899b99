// The error-state Kalman filter, one sample after another in the order of their time. A plain value: a copy
// is a snapshot, and the same samples give the same state again.
#pragma once

#include <cstdint>
#include <optional>

#include "calibration/fusion/fix.h"
#include "calibration/fusion/motion_state.h"
#include "calibration/fusion/orientation_filter.h"
#include "signal/timestamp.h"

namespace fude {

struct FusionSettings {
  MotionNoise noise;
  OrientationSettings orientation;
  Eigen::Quaterniond world_from_earth = Eigen::Quaterniond::Identity();  // earth: z up, y north
  bool use_gravity = true;  // the averaged specific force as the vertical
  bool use_field = true;    // the magnetometer as north

  // What is believed before the first sample, as standard deviations.
  double start_inclination_rad = 0.1;
  double start_heading_rad = 0.2;  // by the field; without one it is free
  double start_accel_mps2 = 0.1;
  double start_velocity_mps = 1;
  Eigen::Vector3d start_position_m =
      Eigen::Vector3d::Zero();  // for ranges and contacts, that need a first guess
  double start_position_sigma_m = 0.3;
  Eigen::Vector3d lever_m = Eigen::Vector3d::Zero();  // the tracked point in the sensor's frame
  double lever_sigma_m = 0;                           // 0: known exactly
  double lag_s = 0;
  double lag_sigma_s = 0;
  double gyro_lag_sigma_s = 0;  // of the gyroscope behind the accelerometer

  // How far gravity and field are trusted, one fix each attitude_s; their errors last for seconds, hence so
  // little.
  double attitude_s = 0.1;
  double gravity_sigma_rad = 0.1;
  double field_sigma_rad = 0.2;

  double gate_quantile_sigma =
      4;                     // beyond what a normal deviate of so many sigma would be, a fix is an outlier
  double regain_s = 0.06;    // outliers for so long without a good fix are the truth after all
  double coast_s = 0.05;     // an inertial sample is held for so long
  double predicted_s = 0.1;  // without a fix for longer: PREDICTED
  double lost_s = 1;         // for longer, or less sure than lost_sigma_m: LOST
  double lost_sigma_m = 0.05;
};

enum class FusionState : std::uint8_t { ok, predicted, lost };

enum class FixOutcome : std::uint8_t {
  used,
  anchored,  // nothing was known, or all else had failed: the position is what this fix says
  outlier,
  unsound,   // not finite, no variance
  too_late,  // older than what is kept
};

struct FixResult {
  FixOutcome outcome = FixOutcome::unsound;
  double squared_innovation = 0;  // normalised; chi-square with `rows` degrees of freedom
  int rows = 0;
};

// What was done with everything that came.
struct FusionCounts {
  std::uint64_t inertial = 0, used = 0, anchored = 0, outliers = 0, unsound = 0;
  std::uint64_t changed_mind = 0;     // outliers that lasted and became the truth: a tracker that flips
  std::uint64_t repeated = 0;         // inertial samples whose time is no later than the one before
  std::uint64_t disturbed_field = 0;  // attitude fixes without a heading, since the field was disturbed
  std::uint64_t coasted = 0;          // silences of the inertial unit
};

class MotionFilter {
 public:
  explicit MotionFilter(const FusionSettings& settings = {});

  // Times may not run backwards; what is not later than the newest moves nothing. `transition` as in
  // advance().
  bool take(const InertialReading& reading, Timestamp time, ErrorMatrix* transition = nullptr);
  FixResult take(const Fix& fix, Timestamp time, double assumed_lag_s = 0);
  void move_to(Timestamp time, ErrorMatrix* transition = nullptr);
  void begin_again();  // as before the first sample, but for the counts

  // Gravity and field as a fix, when one is due at the newest inertial sample.
  std::optional<AttitudeFix> attitude_due();

  Timestamp time() const { return time_; }
  bool started() const { return started_; }
  bool placed() const { return placed_; }  // the position is known at all
  FusionState state() const;
  const MotionState& motion() const { return motion_; }
  Eigen::Vector3d rate_radps() const { return input_.turn_rate_radps - motion_.gyro_bias_radps; }
  const OrientationFilter& orientation() const { return orientation_; }
  const FusionCounts& counts() const { return counts_; }
  const FusionSettings& settings() const { return settings_; }

 private:
  void start(Timestamp time);
  void step(Timestamp time, const InertialInput& input, ErrorMatrix* transition);
  void anchor(const Fix& fix);
  void forget(int at, double sigma);
  FixResult correct(const Innovation& innovation, bool soft);
  template <int Rows>
  FixResult correct_rows(const Innovation& innovation, bool soft);

  FusionSettings settings_;
  MotionState motion_;
  OrientationFilter orientation_;
  InertialInput input_;  // the newest
  Timestamp time_{}, input_time_{}, attitude_time_{}, fix_time_{};
  std::optional<Timestamp> first_outlier_;
  int outliers_ = 0;  // in a row
  bool started_ = false, has_input_ = false, levelled_ = false, placed_ = false;
  FusionCounts counts_;
};

}  // namespace fude
