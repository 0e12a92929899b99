#include "calibration/delay/touch_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "calibration/delay/felt_touch.h"
#include "calibration/delay/smoothing_spline.h"
#include "calibration/report.h"

namespace fude {
namespace {

constexpr double about_s = 0.15;  // of the path, to either side of a touch
constexpr double fewest_intervals = 5;
constexpr double moved_intervals = 0.3;  // from where a spline was made, until it is made anew
constexpr double break_window_s = 0.04;
constexpr double break_intervals = 6;
constexpr double gate = 4;
constexpr double median_of_one = 0.6745;
constexpr double likely_slope = 0.2;
constexpr double furthest_s = 0.1;  // from where the search put it
constexpr double fastest_drift = 1e-3;
constexpr double least_break = 0.2;
constexpr double finest_noise = 1e-6;  // of a path, in its unit

struct Placed {
  std::size_t number;
  double later_s;  // after the reference
  double early_s;
  bool down;
  SplineState motion;

  double value_share() const { return motion.covariance(0, 0); }
  double value_rate_share() const { return motion.covariance(0, 1); }
  double rate_share() const { return motion.covariance(1, 1); }
  double timing_s2() const { return early_s * early_s / 12; }
};

// The path about each touch, as it was where the touch was last put.
struct Sights {
  std::vector<std::optional<SplineAbout>> splines;
  std::vector<double> tried_s;
  double interval_s = 0;  // of the path
  bool in_air = false;    // of a path that breaks off, the part in the air alone
  double noise2 = 0;      // variance of one sample's height

  Sights(std::size_t touches, const Series& path, bool only_in_air)
      : splines(touches), tried_s(touches, -INFINITY), interval_s(path.interval_s()), in_air(only_in_air) {}
};

// Noise and stiffnesses that are likeliest together.
double noise_variance(const Sights& sights, double start) {
  double noise2 = start;
  constexpr int rounds = 10;
  for (int round = 0; round < rounds; ++round) {
    double squares = 0, freedom = 0;
    for (const auto& spline : sights.splines) {
      if (!spline) continue;
      squares += likeliest(*spline, noise2).squares;
      freedom += double(spline->samples) - 3;
    }
    noise2 = std::max(squares / std::max(1.0, freedom), finest_noise * finest_noise);
  }
  return noise2;
}

std::vector<Placed> place(std::span<const Touch> touches, const Series& path, const DelayLine& line,
                          Sights& sights) {
  const double length_s = std::max(about_s, fewest_intervals * sights.interval_s);
  const auto at_s = [&](const Touch& touch) { return touch.middle_s() - line.at(touch.t_s); };
  bool anew = false;
  for (std::size_t i = 0; i < touches.size(); ++i) {
    const double t_s = at_s(touches[i]);
    if (std::abs(t_s - sights.tried_s[i]) < moved_intervals * sights.interval_s) continue;
    const bool down = touches[i].down;
    sights.splines[i] =
        spline_about(path, t_s, sights.in_air && !down ? 0 : length_s, sights.in_air && down ? 0 : length_s);
    sights.tried_s[i] = t_s;
    anew = true;
  }
  if (anew) sights.noise2 = noise_variance(sights, sights.noise2 > 0 ? sights.noise2 : INFINITY);
  std::vector<Placed> placed;
  placed.reserve(touches.size());
  for (std::size_t i = 0; i < touches.size(); ++i) {
    if (!sights.splines[i]) continue;
    const SplineAbout& spline = *sights.splines[i];
    placed.push_back({i, touches[i].t_s - line.reference_s, touches[i].early_s, touches[i].down,
                      averaged(spline, sights.noise2, at_s(touches[i]) - spline.at_s)});
  }
  return placed;
}

// How much of its speed the path loses at the touch: 0 of one that goes on smoothly, 1 of one that stops
// dead, from the part of |t| that no parabola follows.
double break_at_touch(const Series& path, std::span<const Touch> touches, const DelayLine& line) {
  const double half_s = std::max(break_window_s, break_intervals * path.interval_s()) / 2;
  double with = 0, square = 0;
  for (const Touch& touch : touches) {
    const double at_s = touch.middle_s() - line.at(touch.t_s);
    const auto motion = local_motion(path, at_s, half_s, half_s);
    if (!motion) continue;
    const auto n = Eigen::Index(motion->samples);
    Eigen::MatrixX3d powers(n, 3);
    Eigen::VectorXd corner(n), height(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const std::size_t j = motion->first + std::size_t(i);
      const double u = path.t_s[j] - at_s;
      powers.row(i) << 1, u, u * u;
      corner(i) = std::abs(u);
      height(i) = path.values[j].z();
    }
    corner -= powers * powers.colPivHouseholderQr().solve(corner);
    const double turn = (touch.down ? -1 : 1) * motion->rate.z();
    with += turn * corner.dot(height);
    square += turn * turn * corner.squaredNorm();
  }
  return square > 0 ? with / square : 0;
}

struct Columns {
  Eigen::Index up = -1, slope = -1, offset = -1, drift = -1, count = 1;
  Columns(bool lifts, const TouchModel& model) {
    if (lifts) up = count++;
    if (!model.levelled) slope = count, count += 2;
    offset = count++;
    if (model.drifts) drift = count++;
  }
};

// What is unknown beside the path's own noise: how unevenly a touch is felt, in height, and in time. Until it
// is known roughly where the touches are, they are taken for Gaussian, which is linear.
struct Unevenness {
  double height2 = 0, time2 = 0;
  bool gaussian = false;
};

FeltTouch felt(const Placed& p, double rate, double noise2, const Unevenness& more) {
  const double variance = noise2 * p.value_share() + more.height2 + rate * rate * more.time2;
  const FeltTouch touch{std::abs(rate) * p.early_s / 2,
                        std::sqrt(std::max(variance, finest_noise * finest_noise))};
  return more.gaussian ? FeltTouch{0, std::sqrt(touch.variance())} : touch;
}

// The likeliest, with the residuals as they are.
Unevenness unevenness(const std::vector<Placed>& placed, const std::vector<TouchResidual>& residuals,
                      double noise2) {
  std::vector<double> shares, spans;
  for (const Placed& p : placed) {
    shares.push_back(p.value_share());
    spans.push_back(p.early_s);
  }
  constexpr double least_span_s = 1e-3;
  const double height2 = noise2 * quantile(shares, 0.5);
  const double time_s = std::max(quantile(spans, 0.5), least_span_s);
  Unevenness best;
  double likeliest = -INFINITY;
  for (const double h : {0.0, 1.0, 4.0, 16.0, 64.0})
    for (const double t : {0.0, 0.1, 0.2, 0.4, 0.8, 1.6, 3.2}) {
      const Unevenness more{h * height2, t * t * time_s * time_s};
      double likelihood = 0;
      for (std::size_t i = 0; i < placed.size(); ++i)
        if (residuals[i].agrees)
          likelihood += felt(placed[i], residuals[i].rate, noise2, more).log_density(residuals[i].height_off);
      if (likelihood > likeliest) {
        likeliest = likelihood;
        best = more;
      }
    }
  return best;
}

struct Step {
  Eigen::VectorXd change;      // heights and slopes themselves, change of offset and drift
  Eigen::MatrixXd covariance;  // of the touches' own contributions
  double freedom = 0;
};

// One step of Fisher's scoring from `at` (heights and slopes; 0 of offset and drift); fills height_off, rate,
// weight and agrees. Rates are noisy regressors whose noise is shared with the heights: what that adds to the
// normal equations on the average is taken out again (Fuller, Measurement Error Models, 1987, chapter 2).
Step step(const std::vector<Placed>& placed, const Columns& columns, const Eigen::VectorXd& at,
          std::vector<TouchResidual>& residuals, double noise2, const Unevenness& more,
          const Eigen::Vector2d& centre, const Eigen::Vector2d& levelled_by) {
  const auto n = Eigen::Index(placed.size());
  const Eigen::Vector2d slope =
      columns.slope >= 0 ? Eigen::Vector2d(at.segment<2>(columns.slope)) : Eigen::Vector2d::Zero();
  Eigen::MatrixXd x = Eigen::MatrixXd::Zero(n, columns.count), pull(n, columns.count);
  Eigen::VectorXd information(n);
  Eigen::MatrixXd square = Eigen::MatrixXd::Zero(columns.count, columns.count);
  Eigen::VectorXd moment = Eigen::VectorXd::Zero(columns.count);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Placed& p = placed[std::size_t(i)];
    const Eigen::Matrix3d& m = p.motion.mean;
    const double rate = m(1, 2) - m.row(1).head<2>().dot(slope);
    const double bend = m(2, 2) - m.row(2).head<2>().dot(slope);
    Eigen::VectorXd moves = Eigen::VectorXd::Zero(columns.count);
    moves(columns.offset) = 1;
    if (columns.drift >= 0) moves(columns.drift) = p.later_s;
    x.row(i) = rate * moves;
    x(i, p.down || columns.up < 0 ? 0 : columns.up) = 1;
    if (columns.slope >= 0) x.block<1, 2>(i, columns.slope) = m.row(0).head<2>() - centre.transpose();
    TouchResidual& r = residuals[std::size_t(i)];
    r.rate = rate;
    r.height_off = m(0, 2) - 0.5 * bend * p.timing_s2() - x.row(i).dot(at);
    const FeltTouch touch = felt(p, rate, noise2, more);
    r.weight = 1 / touch.variance();
    information(i) = touch.information();
    const double shared = information(i) * (p.value_rate_share() * noise2 + rate * bend * p.timing_s2());
    pull.row(i) = touch.score(r.height_off) * x.row(i) - shared * moves.transpose();
    if (!r.agrees) continue;
    square += information(i) *
              (x.row(i).transpose() * x.row(i) - p.rate_share() * noise2 * moves * moves.transpose());
    moment += pull.row(i).transpose();
  }
  if (columns.slope >= 0)
    for (const Eigen::Index i : {0, 1}) {
      square(columns.slope + i, columns.slope + i) += 1 / (likely_slope * likely_slope);
      moment(columns.slope + i) -= (slope(i) + levelled_by(i)) / (likely_slope * likely_slope);
    }
  // Columns differ in size by their units.
  const Eigen::VectorXd scale = square.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd even = scale.asDiagonal() * square * scale.asDiagonal();
  const Eigen::MatrixXd inverse =
      scale.asDiagonal() * even.completeOrthogonalDecomposition().pseudoInverse() * scale.asDiagonal();
  Step result;
  result.change = inverse * moment;
  double used = 0;
  Eigen::MatrixXd scores = Eigen::MatrixXd::Zero(columns.count, columns.count);
  for (Eigen::Index i = 0; i < n; ++i) {
    if (!residuals[std::size_t(i)].agrees) continue;
    constexpr double heaviest = 0.9;
    const double lever =
        std::clamp(information(i) * x.row(i).dot(inverse * x.row(i).transpose()), 0.0, heaviest);
    scores += pull.row(i).transpose() * pull.row(i) / (1 - lever);
    ++used;
  }
  result.freedom = std::max(1.0, used - double(columns.count));
  // Scores of touches that are felt evenly are few that count, and their scatter alone may look too small.
  const Eigen::MatrixXd shown = inverse * scores * inverse.transpose();
  result.covariance = inverse * std::max(1.0, shown(columns.offset, columns.offset) /
                                                  inverse(columns.offset, columns.offset));
  return result;
}

// Those within the gate of the others; true where it changed none.
bool reject(std::vector<TouchResidual>& residuals) {
  std::vector<double> sizes;
  for (const TouchResidual& r : residuals) sizes.push_back(std::abs(r.height_off) * std::sqrt(r.weight));
  const double scale = quantile(sizes, 0.5) / median_of_one;
  bool settled = true;
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    const bool agrees = sizes[i] <= gate * scale;
    settled = settled && agrees == residuals[i].agrees;
    residuals[i].agrees = agrees;
  }
  return settled;
}

void describe_speeds(TouchFit& fit, const std::vector<Placed>& placed, double noise2) {
  double weight = 0, squares = 0, down = 0, down_sum = 0, up = 0, up_sum = 0, noise = 0;
  for (std::size_t i = 0; i < placed.size(); ++i) {
    const TouchResidual& r = fit.residuals[i];
    if (!r.agrees) continue;
    weight += r.weight;
    squares += r.weight * r.rate * r.rate;
    (placed[i].down ? down : up) += r.weight;
    (placed[i].down ? down_sum : up_sum) += r.weight * r.rate;
    noise += r.weight * placed[i].rate_share() * noise2;
  }
  fit.speed = std::sqrt(squares / weight);
  double among = squares - noise;
  if (down > 0) among -= down_sum * down_sum / down;
  if (up > 0) among -= up_sum * up_sum / up;
  fit.speed_spread = std::sqrt(std::max(0.0, among) / squares);
}

std::optional<TouchFit> fit_with(std::span<const Touch> touches, const Series& path, const DelayLine& start,
                                 const TouchModel& model, bool in_air) {
  const bool lifts = std::any_of(touches.begin(), touches.end(), [](const Touch& t) { return !t.down; });
  const Columns columns(lifts, model);
  TouchFit fit;
  fit.line = start;
  fit.stops = in_air;
  Sights sights(touches.size(), path, in_air);
  // Over the surface as far as it is known: else the way along it passes for one in height.
  Series level;
  if (columns.slope >= 0) level = path;
  const Series& over = columns.slope >= 0 ? level : path;
  Eigen::Vector2d levelled_by = Eigen::Vector2d::Zero();
  Eigen::VectorXd at = Eigen::VectorXd::Zero(columns.count);
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  Unevenness more{.gaussian = true};
  std::vector<bool> agrees(touches.size(), true);
  double damping = 1, last_s = 0;
  constexpr int most_rounds = 40, surely = 3;
  for (int round = 0; round < most_rounds; ++round) {
    const auto placed = place(touches, over, fit.line, sights);
    if (placed.size() < fewest_touches) return std::nullopt;
    if (round == 0)
      for (const Placed& p : placed)
        centre += p.motion.mean.row(0).head<2>().transpose() / double(placed.size());
    fit.residuals.clear();
    for (const Placed& p : placed) fit.residuals.push_back({.touch = p.number, .agrees = agrees[p.number]});
    const Step found = step(placed, columns, at, fit.residuals, sights.noise2, more, centre, levelled_by);
    // Where the likelihood is steeper than on the average, scoring steps to and fro.
    const double moved_s = found.change(columns.offset);
    if (moved_s * last_s < 0 && std::abs(moved_s) > std::abs(last_s) / 2) damping /= 2;
    last_s = moved_s;
    at += damping * found.change;
    fit.line.offset_s += at(columns.offset);
    at(columns.offset) = 0;
    if (columns.drift >= 0) {
      fit.line.drift += at(columns.drift);
      at(columns.drift) = 0;
    }
    if (!(std::abs(fit.line.offset_s - start.offset_s) < furthest_s)) return std::nullopt;
    if (std::abs(fit.line.drift) > fastest_drift) return std::nullopt;
    const bool same = reject(fit.residuals);
    for (const TouchResidual& r : fit.residuals) agrees[r.touch] = r.agrees;
    if (fit.used() < fewest_touches) return std::nullopt;
    constexpr double settled_s = 1e-7;
    if ((same && round > 2 * surely && std::abs(moved_s) < settled_s) || round + 1 == most_rounds) {
      fit.down_height = at(0);
      if (columns.up >= 0) fit.up_height = at(columns.up);
      fit.freedom = found.freedom;
      fit.offset_sd_s = std::sqrt(found.covariance(columns.offset, columns.offset));
      if (columns.drift >= 0) fit.drift_sd = std::sqrt(found.covariance(columns.drift, columns.drift));
      if (columns.slope >= 0) fit.slope = levelled_by + at.segment<2>(columns.slope);
      fit.centre = centre;
      describe_speeds(fit, placed, sights.noise2);
      break;
    }
    constexpr double sloping = 1e-3;
    if (columns.slope >= 0 && at.segment<2>(columns.slope).norm() > sloping && round <= 2 * surely) {
      const Eigen::Vector2d by = at.segment<2>(columns.slope);
      for (Eigen::Vector3d& point : level.values) point.z() -= by.dot(point.head<2>() - centre);
      levelled_by += by;
      at.segment<2>(columns.slope).setZero();
      sights = Sights(touches.size(), level, in_air);
    }
    if (round >= surely && round < 3 * surely) more = unevenness(placed, fit.residuals, sights.noise2);
  }
  return fit;
}

}  // namespace

std::size_t TouchFit::used() const {
  return std::size_t(
      std::count_if(residuals.begin(), residuals.end(), [](const TouchResidual& r) { return r.agrees; }));
}

std::optional<TouchFit> fit_touches(std::span<const Touch> touches, const Series& path,
                                    const DelayLine& start, const TouchModel& model) {
  DelayLine line = start;
  if (!touches.empty()) {
    line.reference_s = (touches.front().t_s + touches.back().t_s) / 2;
    line.offset_s = start.at(line.reference_s);
  }
  const auto smooth = fit_with(touches, path, line, model, false);
  if (!smooth || std::abs(break_at_touch(path, touches, smooth->line)) < least_break) return smooth;
  return fit_with(touches, path, smooth->line, model, true);
}

std::vector<double> residual_times(const TouchFit& fit) {
  std::vector<double> times;
  for (const TouchResidual& r : fit.residuals)
    if (r.agrees) times.push_back(std::abs(r.height_off) / fit.speed);
  return times;
}

std::vector<TouchResidual> residuals_against(const TouchFit& fit, std::span<const Touch> others,
                                             const Series& path, double most_s) {
  std::vector<TouchResidual> residuals;
  Series level = path;
  for (Eigen::Vector3d& point : level.values) point.z() -= fit.slope.dot(point.head<2>() - fit.centre);
  Sights sights(others.size(), level, fit.stops);
  for (const Placed& p : place(others, level, fit.line, sights)) {
    const double off = p.motion.mean(0, 2) - (p.down ? fit.down_height : fit.up_height);
    residuals.push_back(
        {.touch = p.number, .height_off = off, .agrees = std::abs(off) < gate * most_s * fit.speed});
  }
  return residuals;
}

}  // namespace fude
