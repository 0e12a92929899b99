#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "sim/ink/kernels/lang_cpp.h"

namespace fude {
namespace {

#include "sim/ink/kernels/numeric.k"

TEST(Numeric, ReciprocalIsGoodToTheLastBits) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> exponent(-80, 80);
  for (int i = 0; i < 100000; ++i) {
    const float x = std::exp(exponent(random));
    EXPECT_NEAR(static_cast<double>(reciprocal(x)) * static_cast<double>(x), 1.0, 2e-7) << x;
  }
}

TEST(Numeric, DecayAgreesWithTheLibrary) {
  EXPECT_EQ(decay(0.0F), 1.0F);
  for (float x = 0; x <= 80; x += 0.0037F) {
    const double want = std::exp(-static_cast<double>(x));
    EXPECT_NEAR(static_cast<double>(decay(x)), want, 3e-7 * want) << x;
  }
}

TEST(Numeric, SmoothRiseIsTheCubicBetweenItsEdgesAndFlatOutside) {
  EXPECT_EQ(smooth_rise(-0.5F), 0.0F);
  EXPECT_EQ(smooth_rise(0.5F), 0.5F);
  EXPECT_EQ(smooth_rise(1.0F), 1.0F);
  EXPECT_EQ(smooth_rise(1e30F), 1.0F);
  EXPECT_NEAR(smooth_rise(0.25F), 0.15625F, 1e-7F);
}

}  // namespace
}  // namespace fude
