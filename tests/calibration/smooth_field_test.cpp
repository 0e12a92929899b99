#include "calibration/smooth_field.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "tests/fakes/scripted_tracker.h"

namespace fude {
namespace {

Eigen::MatrixXd scattered(int n, int dimensions, std::uint32_t seed) {
  Noise noise(seed);
  Eigen::MatrixXd points(n, dimensions);
  for (Eigen::Index i = 0; i < points.size(); ++i) points.data()[i] = noise.uniform(-200, 200);
  return points;
}

TEST(SmoothField, PolynomialsOfItsKindComeBackExactly) {
  for (const int dimensions : {2, 3})
    for (const FreeShape shape : {FreeShape::plane, FreeShape::quadric}) {
      const Eigen::MatrixXd points = scattered(30, dimensions, 1);
      const auto truth = [&](const Eigen::RowVectorXd& x) {
        const double flat = 3 - 0.1 * x(0) + 0.02 * x(1);
        return shape == FreeShape::plane ? flat : flat + 1e-3 * x(0) * x.tail<1>()(0) - 2e-3 * x(1) * x(1);
      };
      Eigen::MatrixXd values(30, 1);
      for (Eigen::Index i = 0; i < 30; ++i) values(i, 0) = truth(points.row(i));
      const SmoothField field = SmoothField::fit(points, values, shape);
      const SmoothField alone = SmoothField::polynomial(points, values, shape);
      const Eigen::MatrixXd elsewhere = scattered(20, dimensions, 2);
      for (Eigen::Index i = 0; i < 20; ++i) {
        EXPECT_NEAR(field.at(elsewhere.row(i))(0), truth(elsewhere.row(i)), 1e-6);
        EXPECT_NEAR(alone.at(elsewhere.row(i))(0), truth(elsewhere.row(i)), 1e-8);
      }
    }
}

// The residual of each point by a fit without it, done the long way with the same smoothing: the polynomial.
TEST(SmoothField, LeftOutResidualsAreThoseOfFitsWithoutThePoint) {
  const Eigen::MatrixXd points = scattered(15, 2, 3);
  Noise noise(4);
  Eigen::MatrixXd values(15, 1);
  for (Eigen::Index i = 0; i < 15; ++i) values(i, 0) = noise.normal(1);
  const SmoothField all = SmoothField::polynomial(points, values, FreeShape::quadric);
  for (Eigen::Index left = 0; left < 15; ++left) {
    Eigen::MatrixXd p(14, 2), v(14, 1);
    for (Eigen::Index i = 0, j = 0; i < 15; ++i)
      if (i != left) {
        p.row(j) = points.row(i);
        v.row(j++) = values.row(i);
      }
    const double foretold = SmoothField::polynomial(p, v, FreeShape::quadric).at(points.row(left))(0);
    EXPECT_NEAR(all.left_out_residuals()(left, 0), values(left, 0) - foretold, 1e-8);
  }
}

TEST(SmoothField, ExactDataOfASmoothFunctionAreFollowed) {
  for (const int dimensions : {2, 3}) {
    const Eigen::MatrixXd points = scattered(200, dimensions, 5), elsewhere = scattered(50, dimensions, 6);
    const auto truth = [](const Eigen::RowVectorXd& x) {
      return Eigen::RowVector2d(std::sin(x(0) / 90) * std::cos(x(1) / 110), std::exp(-x.squaredNorm() / 4e4));
    };
    Eigen::MatrixXd values(200, 2);
    for (Eigen::Index i = 0; i < 200; ++i) values.row(i) = truth(points.row(i));
    const SmoothField field = SmoothField::fit(points, values, FreeShape::quadric);
    double sum = 0;
    for (Eigen::Index i = 0; i < 50; ++i)
      sum += (field.at(elsewhere.row(i)) - truth(elsewhere.row(i))).squaredNorm();
    EXPECT_LT(std::sqrt(sum / 50), dimensions == 2 ? 0.02 : 0.1);
  }
}

TEST(SmoothField, NoiseAloneIsNotTakenForShape) {
  const Eigen::MatrixXd points = scattered(80, 2, 7);
  Noise noise(8);
  double freedom = 0;
  for (int trial = 0; trial < 20; ++trial) {
    Eigen::MatrixXd values(80, 1);
    for (Eigen::Index i = 0; i < 80; ++i) values(i, 0) = noise.normal(0.3);
    freedom += SmoothField::fit(points, values, FreeShape::plane).freedom() / 20;
  }
  EXPECT_LT(freedom, 6);  // three are the plane's
}

TEST(SmoothField, ItsSlopeIsThatOfItsValues) {
  for (const int dimensions : {2, 3})
    for (const FreeShape shape : {FreeShape::plane, FreeShape::quadric, FreeShape::bowed}) {
      const Eigen::MatrixXd points = scattered(60, dimensions, 10);
      Eigen::MatrixXd values(60, 2);
      for (Eigen::Index i = 0; i < 60; ++i)
        values.row(i) << std::sin(points(i, 0) / 90), std::cos(points(i, 1) / 70) + 0.01 * points(i, 0);
      const SmoothField field = SmoothField::fit(points, values, shape);
      const Eigen::RowVectorXd at = 0.5 * scattered(1, dimensions, 11);
      const Eigen::MatrixXd slope = field.slope(at);
      ASSERT_EQ(slope.rows(), dimensions);
      constexpr double h = 1e-3;
      for (Eigen::Index i = 0; i < dimensions; ++i) {
        const Eigen::RowVectorXd step = h * Eigen::RowVectorXd::Unit(dimensions, i);
        const Eigen::RowVectorXd by_values = (field.at(at + step) - field.at(at - step)) / (2 * h);
        EXPECT_LT((slope.row(i) - by_values).norm(), 1e-7) << dimensions << " dimensions, coordinate " << i;
      }
    }
}

TEST(SmoothField, WhatIsStoredGivesTheSame) {
  const Eigen::MatrixXd points = scattered(40, 2, 9);
  const Eigen::MatrixXd values = points.col(0).array().sin().matrix();
  const SmoothField f = SmoothField::fit(points, values, FreeShape::quadric);
  const SmoothField g(f.shape(), f.centre(), f.scale(), f.knots(), f.weights(), f.coefficients());
  EXPECT_EQ(f.at(Eigen::RowVector2d(3, 4)), g.at(Eigen::RowVector2d(3, 4)));
}

}  // namespace
}  // namespace fude
