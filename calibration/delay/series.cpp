#include "calibration/delay/series.h"

#include <Eigen/LU>
#include <algorithm>

namespace fude {

double Series::interval_s() const {
  if (size() < 2) return 0;
  std::vector<double> steps;
  steps.reserve(size() - 1);
  for (std::size_t i = 1; i < size(); ++i) steps.push_back(t_s[i] - t_s[i - 1]);
  const auto middle = steps.begin() + std::ptrdiff_t(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

std::optional<LocalMotion> local_motion(const Series& series, double at_s, double before_s, double after_s) {
  constexpr std::size_t fewest = 5;
  const double begin_s = at_s - before_s, end_s = at_s + after_s, length_s = before_s + after_s;
  const auto& t = series.t_s;
  const auto first = std::size_t(std::lower_bound(t.begin(), t.end(), begin_s) - t.begin());
  std::size_t end = first;
  Eigen::Matrix3d square = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  double last_s = begin_s;
  // In units of the window's length, about the moment asked for.
  for (; end < t.size() && t[end] <= end_s; ++end) {
    if (t[end] - last_s > (end == first ? 0.25 : 0.5) * length_s) return std::nullopt;
    last_s = t[end];
    const double u = (t[end] - at_s) / length_s;
    const Eigen::Vector3d powers(1, u, u * u);
    square += powers * powers.transpose();
    moments += powers * series.values[end].transpose();
  }
  if (end - first < fewest || end_s - last_s > 0.25 * length_s) return std::nullopt;
  Eigen::Matrix3d inverse;
  bool invertible = false;
  square.computeInverseWithCheck(inverse, invertible);
  if (!invertible) return std::nullopt;
  const Eigen::Matrix3d coefficients = inverse * moments;  // a power a row
  LocalMotion motion;
  motion.value = coefficients.row(0);
  motion.rate = coefficients.row(1) / length_s;
  motion.bend = 2 * coefficients.row(2) / (length_s * length_s);
  motion.value_share = inverse(0, 0);
  motion.value_rate_share = inverse(0, 1) / length_s;
  motion.rate_share = inverse(1, 1) / (length_s * length_s);
  motion.residual_squares.setZero();
  for (std::size_t i = first; i < end; ++i) {
    const double u = (t[i] - at_s) / length_s;
    const Eigen::Vector3d off = series.values[i] - coefficients.transpose() * Eigen::Vector3d(1, u, u * u);
    motion.residual_squares += off.cwiseAbs2();
  }
  motion.first = first;
  motion.samples = end - first;
  return motion;
}

}  // namespace fude
