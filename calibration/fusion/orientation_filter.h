// Orientation from a gyroscope and an accelerometer, and heading where there is a magnetometer: what is known
// without any fix of place. Small enough for every sample of every device.
//
// The way of D. Laidig and T. Seel, "VQF: Highly accurate IMU orientation estimation with bias estimation and
// magnetic disturbance rejection", Information Fusion 91 (2023): turn rates are integrated alone; the
// specific force is averaged in that nearly inertial frame, where a hand's accelerations cancel, before it
// corrects the inclination; heading is one more angle on top, which a disturbed field does not move.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>

namespace fude {

// Every number has a physical meaning; one set serves every device and motion.
struct OrientationSettings {
  double force_time_s = 3;          // over which the accelerations of a hand cancel
  double field_time_s = 15;         // over which the heading follows the field
  double start_bias_radps = 0.01;   // how far a gyroscope's offset may be from 0 at first
  double bias_walk = 2e-5;          // of that offset, rad/s per √s
  double rest_bias_radps = 5e-4;    // how well a second of rest shows the offset
  double motion_bias_radps = 1e-2;  // how well a second of motion shows it, by the inclination's drift
  double rest_turn_radps = 0.035;   // at rest rates and forces stay this near their own average …
  double rest_force_mps2 = 0.5;
  double rest_s = 1.5;             // … for this long
  double most_bias_radps = 0.035;  // what turns faster does not rest
  double field_norm_share = 0.1;   // a field further than this from the usual strength is disturbed,
  double field_dip_rad = 0.17;     // as is one whose dip is further off;
  double field_settle_s = 0.5;     // one counts as sound after this long without either
  double field_turn_rad = 0.2;     // the most that one reading counts for, once the heading has settled
  double new_field_s = 20;         // a steady other field becomes the usual one after so long in motion
  double longest_step_s = 0.5;     // after a longer silence the inclination is found anew
};

// One reading in the sensor's frame; the specific force points up at rest.
struct InertialReading {
  Eigen::Vector3d turn_rate_radps = Eigen::Vector3d::Zero();
  Eigen::Vector3d specific_force_mps2 = Eigen::Vector3d::Zero();
  std::optional<Eigen::Vector3d> magnetic_field_ut;
};

// Finite, and no more than any unit on a tool measures (4000 degrees a second, 100 g).
bool plausible(const InertialReading& reading);

class OrientationFilter {
 public:
  explicit OrientationFilter(const OrientationSettings& settings = {});

  // `step_s` since the reading before. A step that is not positive and readings that are not plausible give
  // false and change nothing; a step above longest_step_s begins the inclination again and keeps the offset.
  bool add(const InertialReading& reading, double step_s);

  // Earth: z up, y towards magnetic north where a field was ever sound, else where the first reading's
  // heading was zero. Unit length.
  Eigen::Quaterniond earth_from_sensor() const;

  // Turns the heading so that the sensor is now seen as `earth_from_sensor` has it: an optical or tablet fix.
  void set_heading(const Eigen::Quaterniond& earth_from_sensor);

  // From here on time runs backwards: the readings that follow are the earlier ones, their turn rates
  // negated.
  void reverse();

  Eigen::Vector3d bias_radps() const { return bias_; }
  Eigen::Vector3d bias_variance() const { return bias_covariance_.diagonal(); }  // (rad/s)²
  // Of turns about earth's x, y and z, rad²: what is usual where the averages have settled, more before; the
  // heading without a sound field grows with what the gyroscope's offset may be.
  Eigen::Vector3d variance() const;
  bool resting() const { return rest_time_ >= settings_.rest_s; }
  bool field_disturbed() const { return has_field_ && sound_time_ < settings_.field_settle_s; }
  bool has_heading() const { return heading_known_; }

 private:
  // Second-order Butterworth low-pass of any vector, after a running mean over its first time constant.
  template <int Size>
  struct LowPass {
    Eigen::Matrix<double, Size, 1> value = Eigen::Matrix<double, Size, 1>::Zero();
    Eigen::Matrix<double, Size, 1> rate = Eigen::Matrix<double, Size, 1>::Zero();
    double age = 0;
    void add(const Eigen::Matrix<double, Size, 1>& input, double step_s, double time_s);
  };

  void start(const Eigen::Vector3d& force);
  void correct_inclination(const Eigen::Vector3d& force, double step_s);
  void watch_rest(const InertialReading& reading, double step_s);
  void learn_bias(double step_s);
  void correct_heading(const Eigen::Vector3d& field, double step_s);

  OrientationSettings settings_;
  bool started_ = false;
  Eigen::Quaterniond inertial_from_sensor_ = Eigen::Quaterniond::Identity();  // turn rates alone
  Eigen::Quaterniond level_from_inertial_ = Eigen::Quaterniond::Identity();   // z up, any heading
  Eigen::Quaterniond level_from_sensor_ = Eigen::Quaterniond::Identity();
  double heading_ = 0;  // earth from level, about z
  double heading_sigma_ = 0;
  LowPass<3> force_;  // inertial frame

  Eigen::Vector3d bias_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d bias_covariance_;
  LowPass<8> turned_;  // the first two rows of level-from-sensor, and those rows times the bias
  Eigen::Vector2d drift_ = Eigen::Vector2d::Zero();  // inclination corrected since the bias was last learnt
  double drift_time_ = 0;

  LowPass<3> rest_turn_, rest_force_;  // sensor frame
  double rest_time_ = 0;

  bool has_field_ = false, heading_known_ = false;
  // Strength, and the cosine and sine of the dip below the horizon.
  struct Field {
    double norm = 0;
    Eigen::Vector2d dip = Eigen::Vector2d::UnitX();
  };
  bool alike(const Field& a, const Field& b) const;
  Field usual_, other_;  // other: what is seen instead, for other_time_
  double other_time_ = 0, sound_time_ = 0, heading_age_ = 0;
};

}  // namespace fude
