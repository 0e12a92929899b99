#include "drivers/ultrasonic/multilateration.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>
#include <vector>

namespace fude {
namespace {

using namespace ultrasonic;
using Eigen::Vector3d;

const std::vector<Vector3d> frame_of_six{{0, 0, 0},     {0.6, 0, 0.02},   {0.6, 0.4, 0},
                                         {0, 0.4, 0.3}, {0.3, 0.45, 0.5}, {0.3, -0.05, 0.45}};
constexpr double sigma_m = 0.0005;

RangeSample heard(const std::vector<Vector3d>& receivers, const Vector3d& emitter,
                  double temperature_c = 22) {
  RangeSample sample;
  sample.temperature_c = temperature_c;
  sample.receivers = static_cast<std::uint8_t>(receivers.size());
  for (std::size_t i = 0; i < receivers.size(); ++i)
    sample.flight_s[i] = (emitter - receivers[i]).norm() / speed_of_sound_mps(temperature_c);
  return sample;
}

TEST(SpeedOfSound, IsTheTabulatedOne) {
  EXPECT_NEAR(speed_of_sound_mps(0), 331.3, 1e-9);
  EXPECT_NEAR(speed_of_sound_mps(20), 343.2, 0.1);
  EXPECT_NEAR(speed_of_sound_mps(-20), 318.9, 0.1);
}

TEST(Multilateration, FindsThePlaceExactly) {
  for (const double t : {-5.0, 10.0, 35.0})
    for (const Vector3d& at :
         {Vector3d(0.3, 0.2, 0.25), Vector3d(-0.4, 0.9, 1.1), Vector3d(0.31, 0.1, 0.02)}) {
      const auto fix = multilaterate(heard(frame_of_six, at, t), {frame_of_six});
      ASSERT_TRUE(fix) << fix.error().message;
      EXPECT_LT((fix->position_m - at).norm(), 1e-8);
      EXPECT_LT(fix->residual_m, 1e-8);
      EXPECT_EQ(fix->receivers, 0x3fu);
    }
}

TEST(Multilateration, ThreeReceiversAndTheSideOfTheirPlane) {
  const std::vector<Vector3d> three{{0, 0, 0}, {0.6, 0, 0}, {0.2, 0.5, 0}};
  const RangeSample ranges = heard(three, {0.25, 0.2, 0.4});
  const auto above = multilaterate(ranges, {three});
  ASSERT_TRUE(above);
  EXPECT_LT((above->position_m - Vector3d(0.25, 0.2, 0.4)).norm(), 1e-8);
  const auto below = multilaterate(ranges, {three}, Vector3d(0.2, 0.2, -0.3));
  ASSERT_TRUE(below);
  EXPECT_LT((below->position_m - Vector3d(0.25, 0.2, -0.4)).norm(), 1e-8);
}

TEST(Multilateration, AMuteReceiverIsDoneWithout) {
  RangeSample ranges = heard(frame_of_six, {0.3, 0.2, 0.25});
  ranges.flight_s[1].reset();
  ranges.flight_s[4].reset();
  const auto fix = multilaterate(ranges, {frame_of_six});
  ASSERT_TRUE(fix);
  EXPECT_LT((fix->position_m - Vector3d(0.3, 0.2, 0.25)).norm(), 1e-8);
  EXPECT_EQ(fix->receivers, 0x2du);
}

TEST(Multilateration, AnEchoInAnyReceiverIsLeftOut) {
  for (std::size_t late = 0; late < frame_of_six.size(); ++late)
    for (const double detour_m : {0.02, 0.1, 0.8}) {
      RangeSample ranges = heard(frame_of_six, {0.25, 0.15, 0.2});
      *ranges.flight_s[late] += detour_m / speed_of_sound_mps(22);
      const auto fix = multilaterate(ranges, {frame_of_six});
      ASSERT_TRUE(fix) << late << " by " << detour_m;
      EXPECT_LT((fix->position_m - Vector3d(0.25, 0.15, 0.2)).norm(), 1e-7);
      EXPECT_EQ(fix->receivers, 0x3fu & ~(1u << late));
    }
}

TEST(Multilateration, TwoEchoesOfEight) {
  std::vector<Vector3d> eight = frame_of_six;
  eight.emplace_back(-0.2, 0.2, 0.4);
  eight.emplace_back(0.8, 0.2, 0.35);
  RangeSample ranges = heard(eight, {0.25, 0.15, 0.2});
  *ranges.flight_s[2] += 0.3 / speed_of_sound_mps(22);
  *ranges.flight_s[6] += 0.1 / speed_of_sound_mps(22);
  const auto fix = multilaterate(ranges, {eight});
  ASSERT_TRUE(fix) << fix.error().message;
  EXPECT_LT((fix->position_m - Vector3d(0.25, 0.15, 0.2)).norm(), 1e-7);
}

TEST(Multilateration, WhatCannotBeSolvedIsSaid) {
  RangeSample two = heard(frame_of_six, {0.3, 0.2, 0.3});
  for (std::size_t i = 2; i < 6; ++i) two.flight_s[i].reset();
  EXPECT_NE(multilaterate(two, {frame_of_six}).error().message.find("only 2"), std::string::npos);

  const std::vector<Vector3d> line{{0, 0, 0}, {0.3, 0, 0}, {0.6, 0, 0}, {0.9, 0, 0}};
  EXPECT_NE(multilaterate(heard(line, {0.3, 0.2, 0.3}), {line}).error().message.find("one line"),
            std::string::npos);

  const std::vector<Vector3d> flat{{0, 0, 0}, {0.6, 0, 0}, {0.6, 0.4, 0}, {0, 0.4, 0}};
  EXPECT_NE(multilaterate(heard(flat, {0.2, 0.1, 0}), {flat}).error().message.find("in the plane"),
            std::string::npos);

  RangeSample early = heard(frame_of_six, {0.3, 0.2, 0.3});
  *early.flight_s[0] -= 0.1 / speed_of_sound_mps(22);  // no sound comes before the straight way
  EXPECT_NE(multilaterate(early, {frame_of_six}).error().message.find("contradict"), std::string::npos);
  EXPECT_FALSE(position_of(early, {frame_of_six}).valid);
}

// The covariance says what the errors are: over many pulses with known noise, axis by axis, and the
// squared error measured by it has the mean of chi-squared with three degrees of freedom (a little more,
// as its scale is estimated too).
TEST(Multilateration, TheCovarianceIsCalibrated) {
  std::mt19937_64 generator(20260601);
  std::normal_distribution<double> noise(0, sigma_m);
  std::uniform_real_distribution<double> place(0, 0.5);
  constexpr int pulses = 4000;
  Eigen::Matrix3d observed = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d predicted = Eigen::Matrix3d::Zero();
  double mahalanobis = 0;
  const Vector3d at(0.2, 0.1, 0.6);
  for (int i = 0; i < pulses; ++i) {
    RangeSample ranges = heard(frame_of_six, at);
    for (std::size_t k = 0; k < 6; ++k) *ranges.flight_s[k] += noise(generator) / speed_of_sound_mps(22);
    const auto fix = multilaterate(ranges, {frame_of_six, sigma_m});
    ASSERT_TRUE(fix);
    const Vector3d error = fix->position_m - at;
    observed += error * error.transpose() / pulses;
    predicted += fix->covariance_m2 / pulses;
    mahalanobis += error.dot(fix->covariance_m2.ldlt().solve(error)) / pulses;
  }
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(observed(k, k) / predicted(k, k), 1, 0.08) << k;
  EXPECT_GT(mahalanobis, 2.9);
  EXPECT_LT(mahalanobis, 3.7);
}

}  // namespace
}  // namespace fude
