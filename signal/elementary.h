// Elementary functions with the same bits everywhere. The C library picks another implementation by
// the processor's features, so its last bits change from machine to machine; these use only + − × ÷,
// comparisons and the square root, all of which IEEE 754 fixes (compile with -ffp-contract=off).
// Errors are below 4e-15 relative (sine and cosine: absolute, for |x| < 1e5).
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <numbers>

namespace fude::elementary {

inline double square_root(double x) { return std::sqrt(x); }

namespace detail {

// pi/2 in two parts, the first with 33 bits, so that n·high is exact for |n| < 2^20 (Cody and Waite).
inline constexpr double half_pi_high = 1.57079632673412561417;
inline constexpr double half_pi_low = 6.07710050650619224932e-11;

// Taylor polynomials on [-pi/4, pi/4].
inline double sine_core(double x) {
  const double q = x * x;
  double s = -1.0 / 1307674368000.0;
  s = s * q + 1.0 / 6227020800.0;
  s = s * q - 1.0 / 39916800.0;
  s = s * q + 1.0 / 362880.0;
  s = s * q - 1.0 / 5040.0;
  s = s * q + 1.0 / 120.0;
  s = s * q - 1.0 / 6.0;
  return x + x * (q * s);
}

inline double cosine_core(double x) {
  const double q = x * x;
  double c = 1.0 / 20922789888000.0;
  c = c * q - 1.0 / 87178291200.0;
  c = c * q + 1.0 / 479001600.0;
  c = c * q - 1.0 / 3628800.0;
  c = c * q + 1.0 / 40320.0;
  c = c * q - 1.0 / 720.0;
  c = c * q + 1.0 / 24.0;
  c = c * q - 0.5;
  return 1.0 + q * c;
}

inline double round_to_even(double x) {
  constexpr double shift = 6755399441055744.0;  // 1.5 · 2^52
  return (x + shift) - shift;
}

}  // namespace detail

struct SineCosine {
  double sine;
  double cosine;
};

inline SineCosine sine_cosine(double x) {
  const double n = detail::round_to_even(x * (2 / std::numbers::pi));
  const double r = (x - n * detail::half_pi_high) - n * detail::half_pi_low;
  const double s = detail::sine_core(r);
  const double c = detail::cosine_core(r);
  switch (static_cast<std::int64_t>(n) & 3) {
    case 0:
      return {s, c};
    case 1:
      return {c, -s};
    case 2:
      return {-s, -c};
    default:
      return {-c, s};
  }
}

inline double sine(double x) { return sine_cosine(x).sine; }
inline double cosine(double x) { return sine_cosine(x).cosine; }
inline double tangent(double x) {
  const SineCosine t = sine_cosine(x);
  return t.sine / t.cosine;
}

inline double arctangent(double x) {
  // Two halvings bring |x| below tan(pi/16); then the Taylor series.
  const bool negative = x < 0;
  double t = negative ? -x : x;
  const bool inverted = t > 1;
  if (inverted) t = 1 / t;
  t = t / (1 + std::sqrt(1 + t * t));
  t = t / (1 + std::sqrt(1 + t * t));
  const double q = t * t;
  double s = 0;
  for (int k = 23; k >= 3; k -= 2) s = (s + ((k / 2) % 2 ? -1.0 : 1.0) / k) * q;
  double a = 4 * (t + t * s);
  if (inverted) a = std::numbers::pi / 2 - a;
  return negative ? -a : a;
}

// The angle of (x, y) from the x axis, in (-pi, pi]; 0 for (0, 0).
inline double arctangent(double y, double x) {
  if (x == 0) return y > 0 ? std::numbers::pi / 2 : y < 0 ? -std::numbers::pi / 2 : 0;
  const double a = arctangent(y / x);
  if (x > 0) return a;
  return y < 0 ? a - std::numbers::pi : a + std::numbers::pi;
}

inline double arccosine(double x) { return arctangent(std::sqrt((1 - x) * (1 + x)), x); }

// e to the x; 0 below -708, infinity above 709.
inline double exponential(double x) {
  if (x < -708) return 0;
  if (x > 709) return std::numeric_limits<double>::infinity();
  const double n = detail::round_to_even(x * std::numbers::log2e);
  const double r = (x - n * 0.693147180369123816490) - n * 1.90821492927058770002e-10;
  double e = 1.0 / 6227020800.0;
  for (double f : {1.0 / 479001600.0, 1.0 / 39916800.0, 1.0 / 3628800.0, 1.0 / 362880.0, 1.0 / 40320.0,
                   1.0 / 5040.0, 1.0 / 720.0, 1.0 / 120.0, 1.0 / 24.0, 1.0 / 6.0, 0.5, 1.0, 1.0})
    e = e * r + f;
  const auto exponent = static_cast<std::int64_t>(n) + 1023;
  return e * std::bit_cast<double>(static_cast<std::uint64_t>(exponent) << 52);
}

// The natural logarithm of a positive, normal number.
inline double logarithm(double x) {
  const auto bits = std::bit_cast<std::uint64_t>(x);
  auto exponent = static_cast<std::int64_t>(bits >> 52) - 1023;
  double m = std::bit_cast<double>((bits & 0x000fffffffffffffULL) | 0x3ff0000000000000ULL);
  if (m > std::numbers::sqrt2) {
    m *= 0.5;
    ++exponent;
  }
  const double t = (m - 1) / (m + 1);
  const double q = t * t;
  double s = 0;
  for (int k = 21; k >= 3; k -= 2) s = (s + 1.0 / k) * q;
  return 2 * (t + t * s) + static_cast<double>(exponent) * std::numbers::ln2;
}

// x to the y for x >= 0.
inline double power(double x, double y) {
  if (x <= 0) return y == 0 ? 1 : 0;
  return exponential(y * logarithm(x));
}

}  // namespace fude::elementary
