// Which of two models foretells what it has not seen.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace fude {

// Of errors of the same samples by two models, each left out in its turn: the first are smaller in the mean
// of their squares by more than two standard deviations of that mean, so that chance does not explain it.
inline bool clearly_smaller(const Eigen::MatrixXd& errors, const Eigen::MatrixXd& than) {
  const Eigen::ArrayXXd gain = than.array().square() - errors.array().square();
  const double mean = gain.mean();
  const double n = double(gain.size());
  const double deviation = std::sqrt((gain - mean).square().sum() / std::max(1.0, n - 1) / n);
  return mean > 2 * deviation;
}

}  // namespace fude
