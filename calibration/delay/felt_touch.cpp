#include "calibration/delay/felt_touch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace fude {
namespace {

constexpr double blurred = 0.1;  // half over sd under which nobody tells it from a Gaussian
constexpr double furthest = 8;   // standard deviations beyond the end, from where on it falls as a Gaussian
constexpr double half_turn = std::numbers::pi;

double gauss(double x) { return std::exp(-x * x / 2) / std::sqrt(2 * half_turn); }
double above(double x) { return std::erfc(x / std::numbers::sqrt2) / 2; }

// Of an even density over [-k, k] with Gaussian ends of deviation 1.
double density(double x, double k) { return (above(x - k) - above(x + k)) / (2 * k); }
double score_of(double x, double k) {
  if (x < 0) return -score_of(-x, k);
  if (x > k + furthest) return x - k;
  return (gauss(x - k) - gauss(x + k)) / (2 * k) / density(x, k);
}

double information_of(double k) {
  const double end = k + furthest;
  const int steps = 16 * int(std::ceil(end));
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const double x = (i + 0.5) * end / steps, score = score_of(x, k);
    sum += score * score * density(x, k);
  }
  return 2 * sum * end / steps;
}

// Twelve to a doubling of k, from `blurred` on.
constexpr int to_a_doubling = 12;
constexpr int doublings = 10;
const std::array<double, to_a_doubling * doublings + 1>& informations() {
  static const auto table = [] {
    std::array<double, to_a_doubling * doublings + 1> all{};
    for (std::size_t i = 0; i < all.size(); ++i)
      all[i] = information_of(blurred * std::exp2(double(i) / to_a_doubling));
    return all;
  }();
  return table;
}

}  // namespace

double FeltTouch::log_density(double off) const {
  const double k = half / sd, x = std::abs(off) / sd;
  if (k < blurred) return -off * off / (2 * variance()) - std::log(2 * half_turn * variance()) / 2;
  if (x > k + furthest)
    return std::log(density(k + furthest, k) / sd) - ((x - k) * (x - k) - furthest * furthest) / 2;
  return std::log(density(x, k) / sd);
}

double FeltTouch::score(double off) const {
  const double k = half / sd;
  return k < blurred ? off / variance() : score_of(off / sd, k) / sd;
}

double FeltTouch::information() const {
  const double k = half / sd;
  if (k < blurred) return 1 / variance();
  const auto& table = informations();
  const double at = to_a_doubling * std::log2(k / blurred);
  const auto i = std::min(std::size_t(at), table.size() - 2);
  const double share = at - double(i);
  // Beyond the table it falls as 1/k.
  const double of_one = share > 1 ? table.back() * std::exp2(-(at - double(table.size() - 1)) / to_a_doubling)
                                  : table[i] + share * (table[i + 1] - table[i]);
  return of_one / (sd * sd);
}

}  // namespace fude
