#include "calibration/delay/touch_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "calibration/report.h"

namespace fude {
namespace {

constexpr double shortest_s = 0.04;  // window of a parabola
constexpr double shortest_in_air_s = 0.025;
constexpr double fewest_intervals = 6;  // of the path's samples in it
constexpr double fewest_in_air = 5;
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
  double timing_s2;
  bool down;
  LocalMotion motion;
};

// About a touch; of a path that breaks off, the part in the air alone.
struct Window {
  double length_s;
  bool in_air;
  double before(bool down) const { return in_air ? (down ? length_s : 0) : length_s / 2; }
  double after(bool down) const { return in_air ? (down ? 0 : length_s) : length_s / 2; }
};

double variance_about_parabola(const LocalMotion& motion) {
  return motion.residual_squares.z() / (double(motion.samples) - 2.9);
}

// A touch that is over between two samples of the path follows no parabola.
void drop_unresolved(std::vector<Placed>& placed) {
  constexpr double usual = 9;
  std::vector<double> variances;
  for (const Placed& p : placed) variances.push_back(variance_about_parabola(p.motion));
  const double most = usual * quantile(variances, 0.5) + finest_noise * finest_noise;
  std::erase_if(placed, [&](const Placed& p) { return variance_about_parabola(p.motion) > most; });
}

std::vector<Placed> place(std::span<const Touch> touches, const Series& path, const DelayLine& line,
                          const Window& window) {
  std::vector<Placed> placed;
  placed.reserve(touches.size());
  for (std::size_t i = 0; i < touches.size(); ++i) {
    const Touch& touch = touches[i];
    const double t_s = touch.middle_s() - line.at(touch.t_s);
    if (auto motion = local_motion(path, t_s, window.before(touch.down), window.after(touch.down)))
      placed.push_back({i, touch.t_s - line.reference_s, touch.variance_s2(), touch.down, *motion});
  }
  drop_unresolved(placed);
  return placed;
}

// Variance of one sample's height about its parabola.
double noise_variance(const std::vector<Placed>& placed) {
  double squares = 0, freedom = 0;
  for (const Placed& p : placed) {
    squares += p.motion.residual_squares.z();
    freedom += double(p.motion.samples) - 3;
  }
  return std::max(squares / std::max(1.0, freedom), finest_noise * finest_noise);
}

// How much of its speed the path loses at the touch: 0 of one that goes on smoothly, 1 of one that stops
// dead, from the part of |t| that no parabola follows.
double break_at_touch(const std::vector<Placed>& placed, const Series& path, std::span<const Touch> touches,
                      const DelayLine& line) {
  double with = 0, square = 0;
  for (const Placed& p : placed) {
    const Touch& touch = touches[p.number];
    const double at_s = touch.middle_s() - line.at(touch.t_s);
    const auto n = Eigen::Index(p.motion.samples);
    Eigen::MatrixX3d powers(n, 3);
    Eigen::VectorXd corner(n), height(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const std::size_t j = p.motion.first + std::size_t(i);
      const double u = path.t_s[j] - at_s;
      powers.row(i) << 1, u, u * u;
      corner(i) = std::abs(u);
      height(i) = path.values[j].z();
    }
    corner -= powers * powers.colPivHouseholderQr().solve(corner);
    const double turn = (touch.down ? -1 : 1) * p.motion.rate.z();
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

struct Step {
  Eigen::VectorXd change;      // heights and slopes themselves, change of offset and drift
  Eigen::MatrixXd covariance;  // for noise as the weights say
  double freedom = 0;
};

// One Gauss-Newton step; fills height_off, rate, weight and agrees. Rates are noisy regressors whose noise is
// shared with the heights: what that adds to the normal equations on the average is taken out again (Fuller,
// Measurement Error Models, 1987, chapter 2), and the covariance is that of the touches' own contributions.
Step step(const std::vector<Placed>& placed, const Columns& columns, std::vector<TouchResidual>& residuals,
          double noise2, const Eigen::Vector2d& slope, const Eigen::Vector2d& centre) {
  const auto n = Eigen::Index(placed.size());
  Eigen::MatrixXd x = Eigen::MatrixXd::Zero(n, columns.count);
  Eigen::VectorXd y(n), w(n), shared(n);
  Eigen::MatrixXd square = Eigen::MatrixXd::Zero(columns.count, columns.count);
  Eigen::VectorXd moment = Eigen::VectorXd::Zero(columns.count);
  const auto moving = [&](double later_s) {
    Eigen::VectorXd column = Eigen::VectorXd::Zero(columns.count);
    column(columns.offset) = 1;
    if (columns.drift >= 0) column(columns.drift) = later_s;
    return column;
  };
  for (Eigen::Index i = 0; i < n; ++i) {
    const Placed& p = placed[std::size_t(i)];
    const LocalMotion& m = p.motion;
    const double rate = m.rate.z() - slope.dot(m.rate.head<2>());
    const double bend = m.bend.z() - slope.dot(m.bend.head<2>());
    const Eigen::VectorXd moves = moving(p.later_s);
    x.row(i) = rate * moves;
    x(i, p.down || columns.up < 0 ? 0 : columns.up) = 1;
    if (columns.slope >= 0) x.block<1, 2>(i, columns.slope) = (m.value.head<2>() - centre).transpose();
    y(i) = m.value.z() - 0.5 * bend * p.timing_s2;
    if (columns.slope < 0) y(i) -= slope.dot(m.value.head<2>() - centre);
    w(i) = 1 / (noise2 * m.value_share + rate * rate * p.timing_s2);
    shared(i) = w(i) * (m.value_rate_share * noise2 + rate * bend * p.timing_s2);
    TouchResidual& r = residuals[std::size_t(i)];
    r.rate = rate;
    r.weight = w(i);
    if (!r.agrees) continue;
    square += w(i) * (x.row(i).transpose() * x.row(i) - m.rate_share * noise2 * moves * moves.transpose());
    moment += w(i) * y(i) * x.row(i).transpose() - shared(i) * moves;
  }
  if (columns.slope >= 0)
    for (const Eigen::Index i : {columns.slope, columns.slope + 1})
      square(i, i) += 1 / (likely_slope * likely_slope);
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
    const double off = y(i) - x.row(i).dot(result.change);
    residuals[std::size_t(i)].height_off = off;
    if (!residuals[std::size_t(i)].agrees) continue;
    const Eigen::VectorXd score =
        w(i) * off * x.row(i).transpose() - shared(i) * moving(placed[std::size_t(i)].later_s);
    constexpr double heaviest = 0.9;
    const double lever = std::clamp(w(i) * x.row(i).dot(inverse * x.row(i).transpose()), 0.0, heaviest);
    scores += score * score.transpose() / (1 - lever);
    ++used;
  }
  result.freedom = std::max(1.0, used - double(columns.count));
  result.covariance = inverse * scores * inverse.transpose();
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
    noise += r.weight * placed[i].motion.rate_share * noise2;
  }
  fit.speed = std::sqrt(squares / weight);
  double among = squares - noise;
  if (down > 0) among -= down_sum * down_sum / down;
  if (up > 0) among -= up_sum * up_sum / up;
  fit.speed_spread = std::sqrt(std::max(0.0, among) / squares);
}

std::optional<TouchFit> fit_with(std::span<const Touch> touches, const Series& path, const DelayLine& start,
                                 const TouchModel& model, const Window& window) {
  const bool lifts = std::any_of(touches.begin(), touches.end(), [](const Touch& t) { return !t.down; });
  const Columns columns(lifts, model);
  TouchFit fit;
  fit.line = start;
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();
  std::vector<bool> agrees(touches.size(), true);
  constexpr int most_rounds = 20;
  for (int round = 0; round < most_rounds; ++round) {
    const auto placed = place(touches, path, fit.line, window);
    if (placed.size() < fewest_touches) return std::nullopt;
    fit.residuals.clear();
    for (const Placed& p : placed) fit.residuals.push_back({.touch = p.number, .agrees = agrees[p.number]});
    Eigen::Vector2d centre = Eigen::Vector2d::Zero();
    for (const Placed& p : placed) centre += p.motion.value.head<2>() / double(placed.size());
    const double noise2 = noise_variance(placed);
    const Step found = step(placed, columns, fit.residuals, noise2, slope, centre);
    if (columns.slope >= 0) slope = found.change.segment<2>(columns.slope);
    fit.line.offset_s += found.change(columns.offset);
    if (columns.drift >= 0) fit.line.drift += found.change(columns.drift);
    if (!(std::abs(fit.line.offset_s - start.offset_s) < furthest_s)) return std::nullopt;
    if (std::abs(fit.line.drift) > fastest_drift) return std::nullopt;
    const bool same = reject(fit.residuals);
    for (const TouchResidual& r : fit.residuals) agrees[r.touch] = r.agrees;
    if (fit.used() < fewest_touches) return std::nullopt;
    constexpr double settled_s = 1e-7;
    if ((same && round > 1 && std::abs(found.change(columns.offset)) < settled_s) ||
        round + 1 == most_rounds) {
      fit.down_height = found.change(0);
      if (columns.up >= 0) fit.up_height = found.change(columns.up);
      fit.freedom = found.freedom;
      fit.offset_sd_s = std::sqrt(found.covariance(columns.offset, columns.offset));
      if (columns.drift >= 0) fit.drift_sd = std::sqrt(found.covariance(columns.drift, columns.drift));
      fit.stops = window.in_air;
      fit.window_s = window.length_s;
      fit.slope = slope;
      fit.centre = centre;
      describe_speeds(fit, placed, noise2);
      break;
    }
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
  const double interval_s = path.interval_s();
  const Window about{std::max(shortest_s, fewest_intervals * interval_s), false};
  DelayLine line = start;
  if (!touches.empty()) {
    line.reference_s = (touches.front().t_s + touches.back().t_s) / 2;
    line.offset_s = start.at(line.reference_s);
  }
  const auto smooth = fit_with(touches, path, line, model, about);
  if (!smooth) return std::nullopt;
  const auto placed = place(touches, path, smooth->line, about);
  if (std::abs(break_at_touch(placed, path, touches, smooth->line)) < least_break) return smooth;
  const Window in_air{std::max(shortest_in_air_s, fewest_in_air * interval_s), true};
  return fit_with(touches, path, smooth->line, model, in_air);
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
  for (const Placed& p : place(others, path, fit.line, {fit.window_s, fit.stops})) {
    const Eigen::Vector3d& value = p.motion.value;
    const double height = p.down ? fit.down_height : fit.up_height;
    const double off = value.z() - height - fit.slope.dot(value.head<2>() - fit.centre);
    residuals.push_back(
        {.touch = p.number, .height_off = off, .agrees = std::abs(off) < gate * most_s * fit.speed});
  }
  return residuals;
}

}  // namespace fude
