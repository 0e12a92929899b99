#include "calibration/delay/smoothing_spline.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace fude {
namespace {

constexpr std::size_t fewest = 5;
constexpr double nearest_intervals = 3;
constexpr double unknown = 1e10;  // variance at first, of one sample's
constexpr double softest = 3e5, stiffest = 1e-7, apart = 30;

// A path's state in units of one interval, from one end of the window to the moment asked for. Written out,
// as this is where the time goes.
struct Filter {
  Eigen::RowVector3d value = Eigen::RowVector3d::Zero(), rate = value, bend = value;
  double vv = unknown, vr = 0, vb = 0, rr = unknown, rb = 0, bb = unknown;  // covariance
  double squares = 0, log_volume = 0, volume = 1;  // the latter not yet in the former

  void go(double d, double stiffness) {
    const double half = d * d / 2, d2 = d * d, d3 = d2 * d;
    value += d * rate + half * bend;
    rate += d * bend;
    vv += 2 * d * vr + 2 * half * vb + d2 * rr + 2 * d * half * rb + half * half * bb;
    vr += d * rr + half * rb + d * vb + d2 * rb + d * half * bb;
    vb += d * rb + half * bb;
    rr += 2 * d * rb + d2 * bb;
    rb += d * bb;
    vv += stiffness * d3 * d2 / 20;
    vr += stiffness * d2 * d2 / 8;
    vb += stiffness * d3 / 6;
    rr += stiffness * d3 / 3;
    rb += stiffness * d2 / 2;
    bb += stiffness * d;
  }
  void see(const Eigen::Vector3d& seen) {
    const double variance = vv + 1, gv = vv / variance, gr = vr / variance, gb = vb / variance;
    const Eigen::RowVector3d off = seen.transpose() - value;
    value += gv * off;
    rate += gr * off;
    bend += gb * off;
    rr -= gr * vr;
    rb -= gr * vb;
    bb -= gb * vb;
    vv = gv;
    vr = gr;
    vb = gb;
    squares += off.z() * off.z() / variance;
    volume *= variance;
    if (volume > 1e100) close();
  }
  void close() {
    log_volume += std::log(volume);
    volume = 1;
  }
  // Backwards in time rates have the other sign.
  SplineState state(double direction) const {
    SplineState s;
    s.mean << value, direction * rate, bend;
    s.covariance << vv, direction * vr, vb, direction * vr, rr, direction * rb, vb, direction * rb, bb;
    return s;
  }
};

StiffSpline spline_of(const Series& path, std::size_t first, std::size_t end, double at_s, double interval_s,
                      double stiffness) {
  const auto middle = std::size_t(std::lower_bound(path.t_s.begin() + std::ptrdiff_t(first),
                                                   path.t_s.begin() + std::ptrdiff_t(end), at_s) -
                                  path.t_s.begin());
  const Eigen::Vector3d centre = path.values[std::min(middle, end - 1)];
  Filter before, after;
  for (std::size_t i = first; i < middle; ++i) {
    before.see(path.values[i] - centre);
    const double next_s = i + 1 < middle ? path.t_s[i + 1] : at_s;
    before.go((next_s - path.t_s[i]) / interval_s, stiffness);
  }
  for (std::size_t i = end; i-- > middle;) {
    after.see(path.values[i] - centre);
    const double next_s = i > middle ? path.t_s[i - 1] : at_s;
    after.go((path.t_s[i] - next_s) / interval_s, stiffness);
  }
  before.close();
  after.close();
  const SplineState early = before.state(1), late = after.state(-1);
  const Eigen::Matrix3d both = early.covariance + late.covariance;
  const Eigen::Matrix3d inverse = both.inverse();
  const Eigen::Matrix3d off = late.mean - early.mean, gain = early.covariance * inverse;
  StiffSpline spline{.stiffness = stiffness};
  spline.squares = before.squares + after.squares + off.col(2).dot(inverse * off.col(2));
  spline.log_volume = before.log_volume + after.log_volume + std::log(both.determinant());
  const Eigen::Vector3d units(1, 1 / interval_s, 1 / (interval_s * interval_s));
  spline.state.mean = units.asDiagonal() * (early.mean + gain * off);
  spline.state.mean.row(0) += centre.transpose();
  spline.state.covariance =
      units.asDiagonal() * (early.covariance - gain * early.covariance) * units.asDiagonal();
  return spline;
}

}  // namespace

std::optional<SplineAbout> spline_about(const Series& path, double at_s, double before_s, double after_s) {
  const auto& t = path.t_s;
  const auto first = std::size_t(std::lower_bound(t.begin(), t.end(), at_s - before_s) - t.begin());
  const auto end = std::size_t(std::upper_bound(t.begin(), t.end(), at_s + after_s) - t.begin());
  if (end < first + fewest) return std::nullopt;
  SplineAbout about{.at_s = at_s, .interval_s = (t[end - 1] - t[first]) / double(end - 1 - first)};
  const double near_s = nearest_intervals * about.interval_s;
  const auto next = std::size_t(std::lower_bound(t.begin(), t.end(), at_s) - t.begin());
  if (before_s > 0 && !(next > first && at_s - t[next - 1] < near_s)) return std::nullopt;
  if (after_s > 0 && !(next < end && t[next] - at_s < near_s)) return std::nullopt;
  about.samples = end - first;
  for (double stiffness = stiffest; stiffness <= softest; stiffness *= apart)
    about.of_stiffness.push_back(spline_of(path, first, end, at_s, about.interval_s, stiffness));
  return about;
}

const StiffSpline& likeliest(const SplineAbout& spline, double noise_variance) {
  return *std::min_element(spline.of_stiffness.begin(), spline.of_stiffness.end(),
                           [&](const StiffSpline& a, const StiffSpline& b) {
                             return a.log_volume + a.squares / noise_variance <
                                    b.log_volume + b.squares / noise_variance;
                           });
}

SplineState averaged(const SplineAbout& spline, double noise_variance, double later_s) {
  const StiffSpline& best = likeliest(spline, noise_variance);
  const auto cost = [&](const StiffSpline& s) { return s.log_volume + s.squares / noise_variance; };
  Eigen::Matrix3d by;
  by << 1, later_s, later_s * later_s / 2, 0, 1, later_s, 0, 0, 1;
  double sum = 0;
  SplineState all{Eigen::Matrix3d::Zero(), Eigen::Matrix3d::Zero()};
  for (const bool spread : {false, true})
    for (const StiffSpline& one : spline.of_stiffness) {
      const double weight = std::exp((cost(best) - cost(one)) / 2);
      if (weight < 1e-3) continue;
      if (!spread) {
        sum += weight;
        all.mean += weight * by * one.state.mean;
        continue;
      }
      const Eigen::Vector3d off = by * one.state.mean.col(2) - all.mean.col(2) / sum;
      all.covariance +=
          weight * (by * one.state.covariance * by.transpose() + off * off.transpose() / noise_variance);
    }
  all.mean /= sum;
  all.covariance /= sum;
  return all;
}

}  // namespace fude
