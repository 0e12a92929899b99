#include "calibration/fusion/motion_state.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <memory>

#include "calibration/fusion/fix.h"

namespace fude {
namespace {

MotionState some_state() {
  MotionState s;
  s.position_m = {0.3, -0.2, 0.5};
  s.velocity_mps = {0.4, 0.1, -0.3};
  s.world_from_sensor = rotation_of({0.4, -0.9, 1.3});
  s.gyro_bias_radps = {0.01, -0.02, 0.005};
  s.accel_bias_mps2 = {0.1, 0.2, -0.1};
  s.lever_m = {0.02, -0.03, 0.1};
  s.lag_s = 0.004;
  s.gyro_lag_s = 0.001;
  return s;
}

const InertialInput some_input{{0.8, -1.5, 2.0}, {1.0, 4.0, 8.0}, {0.3, -0.2, 0.5}};

TEST(MotionState, AddUndoesDifference) {
  const MotionState a = some_state();
  ErrorVector e;
  for (int i = 0; i < error::size; ++i) e[i] = 0.01 * (i + 1) * (i % 2 == 0 ? 1 : -1);
  MotionState b = a;
  b.add(e);
  EXPECT_LT((difference(b, a) - e).norm(), 1e-12);
}

// On a circle at an even rate, the sensor turning with it: force and turn rate are constant in its frame.
TEST(MotionState, ACircleClosesByDeadReckoning) {
  const double radius = 0.2, rate = 3, step = 1e-3;
  MotionState s;
  s.position_m = {radius, 0, 0};
  s.velocity_mps = {0, radius * rate, 0};
  const InertialInput input{{0, 0, rate}, {-radius * rate * rate, 0, 9.81}};
  const int steps = static_cast<int>(std::lround(2 * 2 * M_PI / rate / step));
  for (int i = 0; i < steps; ++i) advance(s, input, step, {});
  const double angle = rate * steps * step;
  EXPECT_LT((s.position_m - Eigen::Vector3d(radius * std::cos(angle), radius * std::sin(angle), 0)).norm(),
            1e-5);
  EXPECT_LT(s.world_from_sensor.angularDistance(rotation_of({0, 0, angle})), 1e-9);
}

// The transition is what errors of the state become: against differences of the exact step.
TEST(MotionState, TransitionIsTheDerivativeOfTheStep) {
  const double step = 1e-4, tiny = 1e-6;
  const MotionNoise noise;
  ErrorMatrix transition = ErrorMatrix::Identity();
  MotionState end = some_state();
  advance(end, some_input, step, noise, &transition);
  for (int i = 0; i < error::size; ++i) {
    MotionState moved = some_state();
    moved.add(tiny * ErrorVector::Unit(i));
    advance(moved, some_input, step, noise);
    const ErrorVector column = difference(moved, end) / tiny;
    EXPECT_LT((column - transition.col(i)).cwiseAbs().maxCoeff(), 2e-6) << i;
  }
}

TEST(MotionState, CovarianceStaysSymmetricAndPositive) {
  MotionState s = some_state();
  s.covariance = 1e-4 * ErrorMatrix::Identity();
  for (int i = 0; i < 1000; ++i) advance(s, some_input, 1e-3, {});
  EXPECT_LT((s.covariance - s.covariance.transpose()).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<ErrorMatrix>(s.covariance).eigenvalues().minCoeff(), 0);
}

// A sheet that bows by some millimetres.
std::shared_ptr<const SmoothField> bow() {
  Eigen::MatrixXd points(9, 2), heights(9, 1);
  for (int i = 0; i < 9; ++i) {
    const double x = 400.0 * (i % 3) - 200, y = 400.0 * (i / 3) - 200;
    points.row(i) << x, y;
    heights(i, 0) = 2e-4 * x * x - 1e-4 * x * y + 0.02 * y;
  }
  return std::make_shared<const SmoothField>(SmoothField::polynomial(points, heights, FreeShape::quadric));
}

TEST(ContactFix, IsMetOnTheSheet) {
  const MotionState s = some_state();
  const Eigen::Vector3d tip = s.tracked_point_m() + s.world_from_sensor * Eigen::Vector3d(0, 0.01, -0.15);
  ContactFix fix{.tip_offset_m = {0, 0.01, -0.15}, .sheet = bow()};
  const double x = 1e3 * tip.x(), y = 1e3 * tip.y();
  const double height_m = 1e-3 * (2e-4 * x * x - 1e-4 * x * y + 0.02 * y);
  EXPECT_NEAR(innovation_of(fix, s, Eigen::Vector3d::Zero(), 0).residual[0], height_m - tip.z(), 1e-9);
}

class FixJacobian : public testing::TestWithParam<Fix> {};

TEST_P(FixJacobian, IsTheDerivativeOfTheResidual) {
  const Eigen::Vector3d rate(0.5, 1.0, -2.0);
  const MotionState s = some_state();
  const Innovation here = innovation_of(GetParam(), s, rate, 0.004);
  ASSERT_GT(here.rows, 0);
  for (int i = 0; i < error::size; ++i) {
    const double tiny = 1e-6;
    MotionState moved = s;
    moved.add(tiny * ErrorVector::Unit(i));
    const Innovation there = innovation_of(GetParam(), moved, rate, 0.004);
    const Eigen::VectorXd column = -(there.residual - here.residual).head(here.rows) / tiny;
    EXPECT_LT((column - here.jacobian.col(i).head(here.rows)).cwiseAbs().maxCoeff(), 1e-4) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(
    AllKinds, FixJacobian,
    testing::Values(
        Fix(PointFix{.point_m = {0.3, -0.2, 0.6}}),
        Fix(PointFix{.point_m = {0.3, -0.2, 0.6}, .offset_m = Eigen::Vector3d(0.01, 0, -0.1)}),
        Fix(PoseFix{.point_m = {0.3, -0.2, 0.6}, .world_from_sensor = some_state().world_from_sensor}),
        Fix(RangeFix{
            .receiver_m = {-0.1, 0.4, 0.9}, .emitter_offset_m = {0.02, 0.01, 0.1}, .distance_m = 0.8}),
        Fix(ContactFix{.tip_offset_m = {0, 0.01, -0.15}}),
        Fix(ContactFix{.tip_offset_m = {0, 0.01, -0.15}, .sheet = bow()}),
        Fix(AttitudeFix{.world_from_sensor = some_state().world_from_sensor,
                        .inclination_sigma_rad = 0.1,
                        .heading_sigma_rad = 0.2})));

}  // namespace
}  // namespace fude
