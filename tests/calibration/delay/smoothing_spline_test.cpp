#include "calibration/delay/smoothing_spline.h"

#include <gtest/gtest.h>

#include <cmath>

#include "calibration/delay/felt_touch.h"
#include "tests/fakes/scripted_tracker.h"

namespace fude {
namespace {

// Paths whose third derivative is noise, of three strengths, seen 200 times a second.
TEST(SmoothingSpline, StatesItsErrorHonestly) {
  for (const double strength : {0.3, 3.0, 30.0}) {
    Eigen::Vector3d squares = Eigen::Vector3d::Zero();
    constexpr int draws = 400, finer = 10, samples = 60;
    constexpr double noise = 1e-4, step_s = 0.005 / finer;
    Noise random(1);
    for (int draw = 0; draw < draws; ++draw) {
      Series path;
      Eigen::Vector3d state = random.vector(0.01), truth = state;
      const int middle = finer * samples / 2 + 3;
      for (int i = 0; i < finer * samples; ++i) {
        if (i % finer == 0) path.add(i * step_s, {0, 0, state.x() + random.normal(noise)});
        if (i == middle) truth = state;
        state += step_s * Eigen::Vector3d(state.y() + step_s / 2 * state.z(), state.z(),
                                          random.normal(strength / std::sqrt(step_s)));
      }
      const auto spline = spline_about(path, middle * step_s, 0.1, 0.1);
      ASSERT_TRUE(spline);
      const SplineState found = averaged(*spline, noise * noise, 0);
      const Eigen::Vector3d off = found.mean.col(2) - truth;
      squares += off.cwiseAbs2().cwiseQuotient(found.covariance.diagonal()) / (noise * noise * draws);
    }
    EXPECT_NEAR(squares(0), 1, 0.3) << strength;
    EXPECT_GT(squares(1), 0.4) << strength;  // of the rate it is stated less well
    EXPECT_LT(squares(1), 2) << strength;
  }
}

TEST(SmoothingSpline, WantsSamplesOnTheSidesThatItIsAskedFor) {
  Series path;
  for (int i = 0; i < 100; ++i) path.add(0.01 * i, {1, 2, 3});
  EXPECT_TRUE(spline_about(path, 0.5, 0.1, 0.1));
  EXPECT_FALSE(spline_about(path, 1.1, 0.1, 0.1));
  EXPECT_TRUE(spline_about(path, 0.99, 0.1, 0));
  EXPECT_FALSE(spline_about(path, 1.05, 0.1, 0));
  const SplineState still = averaged(*spline_about(path, 0.5, 0.1, 0.1), 1e-6, 0);
  EXPECT_NEAR(still.mean(0, 2), 3, 1e-6);
  EXPECT_NEAR(still.mean(1, 2), 0, 1e-4);
}

// The density is one, its score that of numbers, its information the mean of the score's square.
TEST(FeltTouch, IsADensityWithItsScore) {
  for (const double half : {0.01, 0.3, 1.0, 5.0, 40.0}) {
    const FeltTouch touch{half, 1};
    double sum = 0, squares = 0, information = 0;
    constexpr double step = 1e-3;
    for (double x = -half - 9; x < half + 9; x += step) {
      const double density = std::exp(touch.log_density(x));
      sum += step * density;
      squares += step * density * x * x;
      information += step * density * touch.score(x) * touch.score(x);
    }
    EXPECT_NEAR(sum, 1, 1e-3) << half;
    EXPECT_NEAR(squares, touch.variance(), 2e-3 * touch.variance());
    EXPECT_NEAR(information, touch.information(), 2e-3 * information) << half;
    for (const double x : {-half - 3, -half, 0.2, half + 12}) {
      constexpr double h = 1e-4;
      EXPECT_NEAR(touch.score(x), -(touch.log_density(x + h) - touch.log_density(x - h)) / (2 * h), 1e-3);
    }
  }
  EXPECT_GT((FeltTouch{5, 1}.information()), 1.5 / (FeltTouch{5, 1}.variance()));
}

}  // namespace
}  // namespace fude
