#include "calibration/imu.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "tests/fakes/scripted_tracker.h"

namespace fude {
namespace {

// A unit that is laid on its six sides and some edges, a second each at 100 Hz, and tumbled between.
struct ScriptedUnit {
  ImuCalibration truth{
      {0.01, -0.02, 0.005},
      {0.1, -0.15, 0.2},
      {1.01, 0.98, 1.02},
      ImuCalibration::Magnetometer{{12, -30, 8}, Eigen::Vector3d(1.1, 0.95, 1 / (1.1 * 0.95)).asDiagonal()}};
  int sides = 10;
  bool magnet = false;

  std::vector<ImuSample> samples(std::uint32_t seed = 1) const {
    const Eigen::Vector3d ups[] = {{0, 0, 1},  {0, 0, -1}, {1, 0, 0},  {-1, 0, 0}, {0, 1, 0},
                                   {0, -1, 0}, {1, 1, 1},  {-1, 1, 1}, {1, -1, 1}, {-1, -1, -1}};
    Noise noise(seed);
    std::vector<ImuSample> all;
    const auto add = [&](const Eigen::Quaterniond& unit_from_world, const Eigen::Vector3d& rate) {
      ImuSample s;
      s.time.host = Timestamp(std::chrono::milliseconds(10 * all.size()));
      s.turn_rate_radps = rate + truth.gyro_bias_radps + noise.vector(0.002);
      s.specific_force_mps2 =
          (unit_from_world * Eigen::Vector3d(0, 0, standard_gravity_mps2)).cwiseQuotient(truth.accel_scale) +
          truth.accel_bias_mps2 + noise.vector(0.02);
      Eigen::Vector3d field = unit_from_world * Eigen::Vector3d(0, 20, -44);
      if (magnet && all.size() % 5 == 0) field += Eigen::Vector3d(30, 10, -20);
      s.magnetic_field_ut =
          truth.magnetometer->shape.inverse() * field + truth.magnetometer->offset_ut + noise.vector(0.2);
      all.push_back(s);
    };
    Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
    for (int side = 0; side < sides; ++side) {
      const auto next = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), ups[side].normalized());
      for (int i = 1; i <= 50; ++i) add(q.slerp(i / 50.0, next), {1, 2, -1});
      q = next;
      for (int i = 0; i < 100; ++i) add(q, Eigen::Vector3d::Zero());
    }
    return all;
  }
};

Calibration<ImuCalibration> calibrated(const std::vector<ImuSample>& samples) {
  ImuProcedure procedure;
  for (const ImuSample& s : samples) procedure.add(s);
  return procedure.finish();
}

TEST(Imu, SixSidesAndSomeEdgesGiveBiasesAndScales) {
  const ScriptedUnit unit;
  const auto found = calibrated(unit.samples());
  ASSERT_TRUE(found) << found.error().reason;
  const ImuCalibration& imu = found->value;
  EXPECT_LT((imu.gyro_bias_radps - unit.truth.gyro_bias_radps).norm(), 1e-3);
  EXPECT_LT((imu.accel_bias_mps2 - unit.truth.accel_bias_mps2).norm(), 0.02);
  EXPECT_LT((imu.accel_scale - unit.truth.accel_scale).norm(), 0.003);
  EXPECT_LT(found->report.rms, 0.01);
}

TEST(Imu, TheEllipsoidGivesHardAndSoftIron) {
  const ScriptedUnit unit;
  const auto found = calibrated(unit.samples());
  ASSERT_TRUE(found && found->value.magnetometer);
  EXPECT_LT((found->value.magnetometer->offset_ut - unit.truth.magnetometer->offset_ut).norm(), 0.5);
  EXPECT_LT((found->value.magnetometer->shape - unit.truth.magnetometer->shape).norm(), 0.02);
}

TEST(Imu, AMagnetThatWalksByLeavesTheMagnetometerOut) {
  const auto found = calibrated(ScriptedUnit{.magnet = true}.samples());
  ASSERT_TRUE(found) << found.error().reason;
  EXPECT_FALSE(found->value.magnetometer);
  EXPECT_NE(found->report.warnings.back().find("magnet"), std::string::npos);
}

TEST(Imu, ProgressAsksForMoreSides) {
  ImuProcedure procedure;
  Progress progress;
  for (const ImuSample& s : ScriptedUnit{.sides = 2}.samples()) progress = procedure.add(s);
  EXPECT_EQ(progress.missing, "lay it on 4 more sides");
  for (const ImuSample& s : ScriptedUnit{}.samples()) progress = procedure.add(s);
  EXPECT_EQ(progress.covered, 1);
}

TEST(Imu, ResultsReadBack) {
  const ScriptedUnit unit;
  const auto read = imu_from(to_fields(unit.truth));
  ASSERT_TRUE(read && read->magnetometer);
  EXPECT_EQ(read->accel_scale, unit.truth.accel_scale);
  EXPECT_EQ(read->magnetometer->shape, unit.truth.magnetometer->shape);
}

TEST(ImuRefuses, TooFewSidesAndNoRestAndAnotherUnit) {
  const auto few = calibrated(ScriptedUnit{.sides = 4}.samples());
  ASSERT_FALSE(few);
  EXPECT_NE(few.error().reason.find("lay on 4 sides"), std::string::npos) << few.error().reason;
  auto samples = ScriptedUnit{}.samples();
  Noise noise(2);
  for (ImuSample& s : samples) s.turn_rate_radps += noise.vector(0.5);
  const auto shaken = calibrated(samples);
  ASSERT_FALSE(shaken);
  EXPECT_NE(shaken.error().reason.find("never lay still"), std::string::npos);
  samples = ScriptedUnit{}.samples();
  for (ImuSample& s : samples) s.specific_force_mps2 /= standard_gravity_mps2;
  EXPECT_FALSE(calibrated(samples));
  EXPECT_FALSE(calibrated({}));
}

TEST(ImuSurvives, NumbersThatAreNoneSaturationAndAClockThatRestarts) {
  const ScriptedUnit unit;
  auto samples = unit.samples();
  for (std::size_t i = 0; i < samples.size(); i += 40)
    samples[i].turn_rate_radps.x() = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 10; i < samples.size(); i += 90) samples[i].saturated = true;
  for (std::size_t i = 700; i < samples.size(); ++i) samples[i].time.host -= std::chrono::seconds(6);
  const auto found = calibrated(samples);
  ASSERT_TRUE(found) << found.error().reason;
  EXPECT_LT((found->value.accel_bias_mps2 - unit.truth.accel_bias_mps2).norm(), 0.03);
  EXPECT_EQ(found->report.warnings.size(), 2U);
}

}  // namespace
}  // namespace fude
