#include "calibration/fusion/orientation_filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <random>

#include "signal/units.h"
#include "tests/calibration/fusion/inertial_recording.h"

namespace fude {
namespace {

constexpr double rate_hz = 250, step_s = 1 / rate_hz;
const Eigen::Vector3d up(0, 0, 9.81), north_field(0, 18, -40);

double degrees_between(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  return in_degrees(Radians(a.angularDistance(b)));
}

// A sensor that turns about an axis of its own at an even rate; what it would read.
struct Turning {
  Eigen::Quaterniond start = Eigen::Quaterniond::Identity();
  Eigen::Vector3d rate_radps = Eigen::Vector3d::Zero();

  Eigen::Quaterniond at(double t) const {
    const double angle = rate_radps.norm() * t;
    return angle == 0 ? start : Eigen::Quaterniond(start * Eigen::AngleAxisd(angle, rate_radps.normalized()));
  }
  InertialReading reading(double t, const Eigen::Vector3d& field = north_field) const {
    const Eigen::Quaterniond sensor_from_earth = at(t).conjugate();
    return {rate_radps, sensor_from_earth * up, sensor_from_earth * field};
  }
};

TEST(OrientationFilter, FollowsAnEvenTurnExactly) {
  const Turning turning{Eigen::Quaterniond(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized())),
                        {0.4, -1.1, 2.0}};
  OrientationFilter filter;
  for (int i = 0; i <= 20 * rate_hz; ++i) ASSERT_TRUE(filter.add(turning.reading(i * step_s), step_s));
  EXPECT_LT(degrees_between(filter.earth_from_sensor(), turning.at(20)), 0.2);
  EXPECT_TRUE(filter.has_heading());
  EXPECT_FALSE(filter.field_disturbed());
}

TEST(OrientationFilter, RestShowsTheOffsetOfTheGyroscope) {
  const Eigen::Vector3d offset(0.006, -0.004, 0.008);
  std::mt19937 generator(1);
  std::normal_distribution<double> noise(0, 0.003);
  OrientationFilter filter;
  for (int i = 0; i < 10 * rate_hz; ++i) {
    InertialReading reading = Turning{}.reading(0);
    reading.magnetic_field_ut.reset();
    reading.turn_rate_radps = offset + Eigen::Vector3d(noise(generator), noise(generator), noise(generator));
    filter.add(reading, step_s);
  }
  EXPECT_TRUE(filter.resting());
  EXPECT_LT((filter.bias_radps() - offset).norm(), 5e-4);
  EXPECT_LT((filter.bias_radps() - offset).cwiseAbs().maxCoeff(),
            4 * std::sqrt(filter.bias_variance().maxCoeff()));
}

TEST(OrientationFilter, MotionShowsTheOffsetToo) {
  const Eigen::Vector3d offset(0.01, -0.01, 0.005);
  OrientationFilter filter;
  Turning turning;
  for (int i = 0; i < 120 * rate_hz; ++i) {
    const double t = i * step_s;
    // Never at rest, and every axis comes to lie level.
    turning.rate_radps = {1.5 * std::sin(0.9 * t), 1.2 * std::cos(0.7 * t), 0.8 * std::sin(0.5 * t + 1)};
    const double angle = turning.rate_radps.norm() * step_s;
    turning.start = (turning.start * Eigen::AngleAxisd(angle, turning.rate_radps.normalized())).normalized();
    InertialReading reading = turning.reading(0);
    reading.turn_rate_radps += offset;
    reading.magnetic_field_ut.reset();
    filter.add(reading, step_s);
  }
  EXPECT_FALSE(filter.resting());
  EXPECT_LT((filter.bias_radps() - offset).norm(), 0.002);
}

TEST(OrientationFilter, AccelerationsOfAHandCancel) {
  OrientationFilter filter;
  double worst = 0;
  for (int i = 0; i < 30 * rate_hz; ++i) {
    const double t = i * step_s;
    InertialReading reading = Turning{}.reading(0);
    reading.specific_force_mps2 +=
        Eigen::Vector3d(6 * std::sin(9 * t), 5 * std::cos(11 * t), 4 * std::sin(8 * t));
    filter.add(reading, step_s);
    const double lean = std::acos((filter.earth_from_sensor() * Eigen::Vector3d::UnitZ()).z());
    if (t > 10) worst = std::max(worst, in_degrees(Radians(lean)));
  }
  EXPECT_LT(worst, 1.0);  // 6 m/s² alone would lean by 31°
}

TEST(OrientationFilter, AMagnetWalkingByDoesNotTurnTheHeading) {
  OrientationFilter filter;
  double worst = 0;
  bool named = false;
  for (int i = 0; i < 40 * rate_hz; ++i) {
    const double t = i * step_s, near = std::exp(-std::pow((t - 25) / 2, 2));
    filter.add(Turning{}.reading(0, north_field + near * Eigen::Vector3d(60, -30, 20)), step_s);
    worst = std::max(worst, degrees_between(filter.earth_from_sensor(), Turning{}.start));
    if (t > 24 && t < 26) named = named || filter.field_disturbed();
  }
  EXPECT_LT(worst, 3.0);  // the field itself turns by 80°
  EXPECT_TRUE(named);
  EXPECT_FALSE(filter.field_disturbed());
}

TEST(OrientationFilter, AFixGivesTheHeadingWithoutAField) {
  const Turning turning{Eigen::Quaterniond(Eigen::AngleAxisd(3.1, Eigen::Vector3d::UnitZ())), {0, 0, 0.5}};
  OrientationFilter filter;
  for (int i = 0; i <= 1000; ++i) {
    InertialReading reading = turning.reading(i * step_s);
    reading.magnetic_field_ut.reset();
    filter.add(reading, step_s);
    if (i == 500) filter.set_heading(turning.at(i * step_s));
  }
  EXPECT_TRUE(filter.has_heading());
  EXPECT_LT(degrees_between(filter.earth_from_sensor(), turning.at(4)), 0.01);
}

TEST(OrientationFilter, SurvivesWhatADeviceMaySend) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  OrientationFilter filter;
  const Turning turning{Eigen::Quaterniond(Eigen::AngleAxisd(1, Eigen::Vector3d::UnitX())), {0, 0, 0}};
  for (int i = 0; i < 500; ++i) filter.add(turning.reading(0), step_s);
  const Eigen::Quaterniond before = filter.earth_from_sensor();
  InertialReading bad = turning.reading(0);
  bad.turn_rate_radps.x() = nan;
  EXPECT_FALSE(filter.add(bad, step_s));
  bad = turning.reading(0);
  bad.specific_force_mps2.z() = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(filter.add(bad, step_s));
  EXPECT_FALSE(filter.add(turning.reading(0), 0));
  EXPECT_FALSE(filter.add(turning.reading(0), -1));
  EXPECT_FALSE(filter.add(turning.reading(0), nan));
  EXPECT_EQ(filter.earth_from_sensor().coeffs(), before.coeffs());
  bad = turning.reading(0);
  bad.magnetic_field_ut = Eigen::Vector3d(nan, 0, 0);
  EXPECT_TRUE(filter.add(bad, step_s));
  EXPECT_TRUE(filter.add(turning.reading(0), 30));  // a long silence
  EXPECT_LT(degrees_between(filter.earth_from_sensor(), turning.start), 0.1);
}

// One set of parameters; the errors are defined by the recordings' publishers. The best published filter gave
// 2.21 and 0.91 degrees on the same files.
TEST(OrientationFilter, RecordingsWithOpticalTruth) {
  double total = 0, inclination = 0, inclination_alone = 0;
  for (const char* name : optical_recordings) {
    REQUIRE_RECORDING(name);
    const InertialRecording recording = read_inertial_recording(name);
    OrientationFilter with_field, alone;
    OrientationError error, error_alone;
    for (std::size_t i = 0; i < recording.imu.size(); ++i) {
      const ImuSample& imu = recording.imu[i];
      const double step = i == 0 ? step_s : seconds(imu.time.host - recording.imu[i - 1].time.host);
      with_field.add({imu.turn_rate_radps, imu.specific_force_mps2, imu.magnetic_field_ut}, step);
      alone.add({imu.turn_rate_radps, imu.specific_force_mps2, {}}, step);
      const PoseSample& truth = recording.truth[i];
      if (!truth.valid || imu.buttons == 0) continue;
      error.add(with_field.earth_from_sensor(), truth.tracker_from_tool.rotation);
      error_alone.add(alone.earth_from_sensor(), truth.tracker_from_tool.rotation);
    }
    std::printf("figure: %s total %.3f heading %.3f inclination %.3f deg; without field %.3f deg\n", name,
                error.total(), error.heading(), error.inclination(), error_alone.inclination());
    total += error.total() / optical_recordings.size();
    inclination += error.inclination() / optical_recordings.size();
    inclination_alone += error_alone.inclination() / optical_recordings.size();
  }
  std::printf("figure: mean total %.3f inclination %.3f deg; without field inclination %.3f deg\n", total,
              inclination, inclination_alone);
  EXPECT_LE(total, 2.3);
  EXPECT_LE(inclination, 1.0);
  EXPECT_LE(inclination_alone, 1.0);
}

}  // namespace
}  // namespace fude
