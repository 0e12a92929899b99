// How sure a least-squares fit is whose errors hang together in time: what it becomes when one stretch of the
// samples after another is left out (Künsch 1989). Neighbouring errors of a tracker are alike, and counting
// each sample as news would promise too much.
#pragma once

#include <Eigen/Dense>
#include <span>
#include <vector>

namespace fude {

// Of residual = r + J·x with weights W: JᵀWJ and −JᵀWr.
template <int N>
struct NormalEquations {
  Eigen::Matrix<double, N, N> information = Eigen::Matrix<double, N, N>::Zero();
  Eigen::Matrix<double, N, 1> gradient = Eigen::Matrix<double, N, 1>::Zero();

  template <int Rows>
  void add(const Eigen::Matrix<double, Rows, 1>& residual, const Eigen::Matrix<double, Rows, N>& jacobian,
           double weight = 1) {
    information += weight * jacobian.transpose() * jacobian;
    gradient -= weight * jacobian.transpose() * residual;
  }
  NormalEquations& operator+=(const NormalEquations& other) {
    information += other.information;
    gradient += other.gradient;
    return *this;
  }
  Eigen::Matrix<double, N, 1> step() const { return information.ldlt().solve(gradient); }
};

// Which of `blocks` stretches sample `i` of `n` lies in.
inline std::size_t block_of(std::size_t i, std::size_t n, std::size_t blocks) { return i * blocks / n; }

// The step from the solution of all to that without each block in turn.
template <int N>
std::vector<Eigen::Matrix<double, N, 1>> steps_without(std::span<const NormalEquations<N>> blocks) {
  std::vector<Eigen::Matrix<double, N, 1>> steps;
  for (std::size_t left = 0; left < blocks.size(); ++left) {
    NormalEquations<N> rest;
    for (std::size_t b = 0; b < blocks.size(); ++b)
      if (b != left) rest += blocks[b];
    steps.push_back(rest.step());
  }
  return steps;
}

template <int N>
Eigen::Matrix<double, N, N> jackknife_covariance(const std::vector<Eigen::Matrix<double, N, 1>>& steps) {
  const double count = double(steps.size());
  Eigen::Matrix<double, N, 1> mean = Eigen::Matrix<double, N, 1>::Zero();
  for (const auto& step : steps) mean += step / count;
  Eigen::Matrix<double, N, N> covariance = Eigen::Matrix<double, N, N>::Zero();
  for (const auto& step : steps)
    covariance += (count - 1) / count * (step - mean) * (step - mean).transpose();
  return covariance;
}

}  // namespace fude
