#include "signal/elementary.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace fude {
namespace {

constexpr double relative_error = 4e-15;

// The C library is the independent answer: accurate, though not the same bits everywhere.
template <class Own, class Reference>
void agree(Own own, Reference reference, double low, double high, bool absolute) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> in(low, high);
  for (int i = 0; i < 20000; ++i) {
    const double x = in(random);
    const double want = reference(x);
    const double scale = absolute ? 1.0 : std::abs(want);
    ASSERT_NEAR(own(x), want, relative_error * std::max(scale, 1e-300)) << "at " << x;
  }
}

TEST(Elementary, SineAndCosineAgreeWithTheLibrary) {
  agree(elementary::sine, [](double x) { return std::sin(x); }, -10, 10, true);
  agree(elementary::cosine, [](double x) { return std::cos(x); }, -10, 10, true);
}

TEST(Elementary, ExponentialAndLogarithmAgreeWithTheLibrary) {
  agree(elementary::exponential, [](double x) { return std::exp(x); }, -5, 5, false);
  agree(elementary::logarithm, [](double x) { return std::log(x); }, 1.5, 1e6, false);
  agree(elementary::logarithm, [](double x) { return std::log(x); }, 1e-9, 0.5, false);
}

TEST(Elementary, ArctangentAgreesWithTheLibraryInEveryQuadrant) {
  agree([](double x) { return elementary::arctangent(x); }, [](double x) { return std::atan(x); }, -50, 50, false);
  for (double y : {-2.0, -0.3, 0.0, 0.3, 2.0})
    for (double x : {-1.5, -0.1, 0.1, 1.5}) EXPECT_NEAR(elementary::arctangent(y, x), std::atan2(y, x), 4e-15);
  EXPECT_EQ(elementary::arctangent(0, 0), 0);
  EXPECT_NEAR(elementary::arctangent(1, 0), std::numbers::pi / 2, 1e-16);
}

TEST(Elementary, PowerHandlesZeroAndOne) {
  EXPECT_EQ(elementary::power(0, 2), 0);
  EXPECT_EQ(elementary::power(0, 0), 1);
  EXPECT_NEAR(elementary::power(2, 0.5), std::sqrt(2.0), 1e-14);
}

}  // namespace
}  // namespace fude
