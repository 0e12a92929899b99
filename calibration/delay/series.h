// Numbers over time, and what a least-squares parabola says of them about one moment.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

namespace fude {

// Times in seconds, rising; a value each. Fewer than three coordinates: the others are 0.
struct Series {
  std::vector<double> t_s;
  std::vector<Eigen::Vector3d> values;

  std::size_t size() const { return t_s.size(); }
  bool empty() const { return t_s.empty(); }
  double span_s() const { return empty() ? 0 : t_s.back() - t_s.front(); }
  // The usual time from one to the next (the median), s; 0 of fewer than two.
  double interval_s() const;
  void add(double at_s, const Eigen::Vector3d& value) {
    t_s.push_back(at_s);
    values.push_back(value);
  }
};

// The parabola of least squares through the samples of [at − before, at + after].
struct LocalMotion {
  Eigen::Vector3d value, rate, bend;   // and its first and second derivative, at that moment
  double value_share = 0;              // variance of value, and its covariance with rate (1/s) …
  double value_rate_share = 0;         // … of those of one sample's noise
  double rate_share = 0;               // variance of rate likewise, 1/s²
  Eigen::Vector3d residual_squares;    // sum over the samples
  std::size_t first = 0, samples = 0;  // in the series
};

// None where there are fewer than five samples, or the samples leave a quarter of the window at either end or
// half of it within empty.
std::optional<LocalMotion> local_motion(const Series& series, double at_s, double before_s, double after_s);

}  // namespace fude
