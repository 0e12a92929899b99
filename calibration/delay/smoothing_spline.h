// What a smoothing spline says of a path about one moment, its stiffness found from the path itself.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "calibration/delay/series.h"

namespace fude {

// Value, rate and bend at a moment: a row each, a coordinate a column; and their covariance as a multiple of
// the variance of one sample's noise.
struct SplineState {
  Eigen::Matrix3d mean;
  Eigen::Matrix3d covariance;
};

// One stiffness, and how well it goes with the third coordinate: for noise of variance v, the log likelihood
// is -(log_volume + squares / v) / 2 less samples / 2 times the logarithm of v.
struct StiffSpline {
  double stiffness = 0;  // variance of the third derivative's white noise over that of a sample, in intervals
  SplineState state;
  double squares = 0;
  double log_volume = 0;
};

// Splines of several stiffnesses about one moment.
struct SplineAbout {
  double at_s = 0;
  double interval_s = 0;
  std::vector<StiffSpline> of_stiffness;
  std::size_t samples = 0;
};

// The quintic smoothing spline as the posterior of a thrice integrated white noise (Wahba, JRSS B 40, 1978),
// by a Kalman filter from either side (Kohn and Ansley, Annals of Statistics 15, 1987), over the samples of
// [at - before, at + after]. None where they are fewer than five, or none lies within three intervals of the
// moment on a side that was asked for.
std::optional<SplineAbout> spline_about(const Series& path, double at_s, double before_s, double after_s);

// The stiffness that is likeliest with noise of that variance.
const StiffSpline& likeliest(const SplineAbout& spline, double noise_variance);

// A little later, or earlier, than where it was asked for, by less than an interval: the mean over all
// stiffnesses, each as likely as the path makes it with noise of that variance.
SplineState averaged(const SplineAbout& spline, double noise_variance, double later_s);

}  // namespace fude
