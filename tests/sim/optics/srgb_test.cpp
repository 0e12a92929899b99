#include "sim/optics/srgb.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace fude {
namespace {

TEST(Srgb, FollowsTheStandard) {
  // The C library's pow is the independent answer.
  for (double linear = 0; linear <= 1; linear += 1.0 / 4096) {
    const double want = linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
    EXPECT_NEAR(srgb_from_linear(linear), want, 1e-14);
    EXPECT_NEAR(linear_from_srgb(srgb_from_linear(linear)), linear, 1e-8);
  }
  EXPECT_NEAR(srgb_from_linear(0.214041140482), 0.5, 1e-9);
  EXPECT_EQ(srgb_from_linear(-1), 0);
  EXPECT_NEAR(srgb_from_linear(2), 1, 1e-15);
}

TEST(Srgb, TheTableRoundsToTheNearestCode) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int i = 0; i < 100000; ++i) {
    double x = uniform(random);
    if (i % 2) x *= x * x;  // the dark end, where codes are dense
    ASSERT_NEAR(srgb16_from_linear(x), srgb_from_linear(x) * 65535, 0.5 + 1e-4) << x;
  }
  for (int code = 0; code < 65536; ++code)
    ASSERT_EQ(srgb16_from_linear(linear_from_srgb(code / 65535.0)), code);
  EXPECT_EQ(srgb16_from_linear(-0.5), 0);
  EXPECT_EQ(srgb16_from_linear(0), 0);
  EXPECT_EQ(srgb16_from_linear(1), 65535);
  EXPECT_EQ(srgb16_from_linear(7), 65535);
}

}  // namespace
}  // namespace fude
