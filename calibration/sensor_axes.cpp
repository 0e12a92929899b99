#include "calibration/sensor_axes.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "calibration/block_jackknife.h"
#include "calibration/fusion/motion_state.h"
#include "calibration/pose_fields.h"
#include "calibration/turned_path.h"
#include "signal/units.h"

namespace fude {
namespace {

constexpr Duration window = std::chrono::milliseconds(250);
constexpr Duration longest_window = std::chrono::milliseconds(350);
constexpr std::size_t fewest_turns = 40, most_turns = 4000, enough_readings = 1000;
constexpr double least_turn_deg = 2;    // root mean square of a window's
constexpr double worst_condition = 15;  // of the turns: a second axis with a fifteenth of the first
constexpr double poor_condition = 8;
constexpr double worst_rms_deg = 5, worst_interval_deg = 5, fair_interval_deg = 1;
constexpr double most_outliers = 0.25;
constexpr double longest_lag_s = 0.2;
constexpr double explains = 3;

constexpr int turn = 0, bias = 3, lag = 6, unknowns = 7;
using Equations = NormalEquations<unknowns>;

double in_deg(double radians) { return in_degrees(Radians(radians)); }
Duration duration(double s) { return std::chrono::duration_cast<Duration>(std::chrono::duration<double>(s)); }

// What the tracker saw of the tool's turning.
struct SeenTurn {
  Timestamp from{}, to{};
  Eigen::Quaterniond rotation;  // of the tool's axes at the end, in those at the start
};

std::vector<SeenTurn> turns_of(const std::vector<PoseSample>& poses) {
  std::vector<SeenTurn> turns;
  const std::size_t stride = poses.size() / most_turns + 1;
  std::size_t end = 0;
  for (std::size_t i = 0; i < poses.size(); i += stride) {
    const Timestamp from = poses[i].time.host;
    while (end < poses.size() && poses[end].time.host < from + window) ++end;
    if (end == poses.size()) break;
    if (poses[end].time.host - from > longest_window) continue;
    turns.push_back(
        {from, poses[end].time.host,
         poses[i].tracker_from_tool.rotation.conjugate() * poses[end].tracker_from_tool.rotation});
  }
  return turns;
}

struct TurnPair {
  std::size_t number = 0;  // of the turn
  Eigen::Quaterniond seen;
  MeasuredTurn measured;
};

std::vector<TurnPair> pairs_of(const std::vector<SeenTurn>& turns, const TurnedPath& path, double lag_s) {
  std::vector<TurnPair> pairs;
  for (std::size_t i = 0; i < turns.size(); ++i)
    if (const auto measured = path.between(turns[i].from + duration(lag_s), turns[i].to + duration(lag_s)))
      pairs.push_back({i, turns[i].rotation, *measured});
  return pairs;
}

double angle_of(const Eigen::Quaterniond& q) { return turn_of(q).norm(); }

// How far the unit's clock is behind: the angle of a turn is the same in all axes.
double coarse_lag(const std::vector<SeenTurn>& turns, const TurnedPath& path) {
  constexpr double step_s = 0.01;
  double best_s = 0, least = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= 2 * int(longest_lag_s / step_s); ++i) {
    const double lag_s = step_s * (i % 2 == 0 ? i / 2 : -(i + 1) / 2);  // the nearest first
    std::vector<double> apart;
    for (const TurnPair& pair : pairs_of(turns, path, lag_s))
      apart.push_back(std::abs(angle_of(pair.seen) - angle_of(pair.measured.rotation)));
    if (apart.size() < fewest_turns) continue;
    if (const double half = quantile(std::move(apart), 0.5); half < least) {
      least = half;
      best_s = lag_s;
    }
  }
  return best_s;
}

// The axes of turns in both frames, weighted by half their sines: of q and −q those whose angles agree.
struct TurnAxes {
  Eigen::Matrix3d across = Eigen::Matrix3d::Zero();  // Σ seen · measuredᵀ
  Eigen::Matrix3d seen = Eigen::Matrix3d::Zero();    // Σ seen · seenᵀ
  double length = 0;                                 // Σ |seen|² + |measured|²
};
TurnAxes axes_of(const std::vector<TurnPair>& pairs) {
  constexpr double half_turn = 0.2;  // of the quaternion's scalar: nearer to 180 degrees the sign is a guess
  TurnAxes axes;
  for (const TurnPair& pair : pairs) {
    const Eigen::Quaterniond &a = pair.seen, &b = pair.measured.rotation;
    if (std::abs(a.w()) < half_turn || std::abs(b.w()) < half_turn) continue;
    const double sign = (a.w() < 0) == (b.w() < 0) ? 1 : -1;
    axes.across += sign * a.vec() * b.vec().transpose();
    axes.seen += a.vec() * a.vec().transpose();
    axes.length += a.vec().squaredNorm() + b.vec().squaredNorm();
  }
  return axes;
}

struct Wahba {
  Eigen::Quaterniond rotation;
  bool mirrored_is_better = false;
};
Wahba first_guess(const TurnAxes& axes) {
  const auto svd = axes.across.jacobiSvd(Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double side = svd.matrixU().determinant() * svd.matrixV().determinant();
  const Eigen::Vector3d sign(1, 1, side);
  const Eigen::Vector3d s = svd.singularValues();
  const double proper = std::max(0.0, axes.length - 2 * s.dot(sign));
  const double mirrored = std::max(0.0, axes.length - 2 * (s(0) + s(1) - side * s(2)));
  return {Eigen::Quaterniond(svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose()).normalized(),
          explains * explains * mirrored < proper};
}

struct Fitted {
  Eigen::Quaterniond tool_from_sensor;
  Eigen::Vector3d bias_radps = Eigen::Vector3d::Zero();
  double lag_s = 0;
};

Eigen::Vector3d residual_of(const Fitted& fit, const TurnPair& pair) {
  const Eigen::Quaterniond& x = fit.tool_from_sensor;
  return turn_of(pair.seen.conjugate() * (x * pair.measured.rotation * x.conjugate()));
}

void add_pair(Equations& equations, const Fitted& fit, const TurnPair& pair, double weight) {
  const Eigen::Matrix3d x = fit.tool_from_sensor.toRotationMatrix();
  const Eigen::Matrix3d back = pair.measured.rotation.conjugate().toRotationMatrix();
  Eigen::Matrix<double, 3, unknowns> rows;
  rows.middleCols<3>(turn) = x * back * x.transpose() - Eigen::Matrix3d::Identity();
  rows.middleCols<3>(bias) = -x * pair.measured.by_bias;
  rows.col(lag) = x * (pair.measured.rate_after - back * pair.measured.rate_before);
  equations.add<3>(residual_of(fit, pair), rows, weight);
}

// Offsets of a gyroscope and lags are small; this only decides what the turns do not.
Equations belief(const Fitted& fit) {
  constexpr double believed_bias_radps = 0.1, believed_lag_s = 0.1;
  Equations equations;
  const double of_bias = 1 / (believed_bias_radps * believed_bias_radps);
  const double of_lag = 1 / (believed_lag_s * believed_lag_s);
  equations.information.diagonal().segment<3>(bias).array() += of_bias;
  equations.information(lag, lag) += of_lag;
  equations.gradient.segment<3>(bias) = -of_bias * fit.bias_radps;
  equations.gradient(lag) = -of_lag * fit.lag_s;
  return equations;
}

double scale_of(const std::vector<TurnPair>& pairs, const Fitted& fit) {
  constexpr double median_of_three = 1.538, finest_rad = 1e-6;
  std::vector<double> lengths;
  for (const TurnPair& pair : pairs) lengths.push_back(residual_of(fit, pair).norm());
  return std::max(quantile(std::move(lengths), 0.5) / median_of_three, finest_rad);
}

struct Refined {
  Fitted fit;
  std::vector<TurnPair> pairs;
  std::vector<bool> agrees;
  std::vector<double> left_out_rad;  // of those that agree
  double interval_rad = 0, lag_deviation_s = 0;
};

Refined refine(const std::vector<SeenTurn>& turns, std::span<const ImuSample> readings, Fitted fit) {
  constexpr double gate = 4;
  constexpr std::size_t blocks = 20;
  Refined r{.fit = fit};
  double scale = 0;
  for (int round = 0; round < 12; ++round) {
    r.pairs = pairs_of(turns, TurnedPath(readings, r.fit.bias_radps), r.fit.lag_s);
    if (r.pairs.size() < fewest_turns) return r;
    scale = scale_of(r.pairs, r.fit);
    r.agrees.assign(r.pairs.size(), false);
    Equations equations = belief(r.fit);
    for (std::size_t i = 0; i < r.pairs.size(); ++i)
      if ((r.agrees[i] = residual_of(r.fit, r.pairs[i]).norm() < gate * scale))
        add_pair(equations, r.fit, r.pairs[i], 1 / (scale * scale));
    const auto step = equations.step();
    r.fit.tool_from_sensor = (rotation_of(step.segment<3>(turn)) * r.fit.tool_from_sensor).normalized();
    r.fit.bias_radps += step.segment<3>(bias);
    r.fit.lag_s += step(lag);
    if (step.norm() < 1e-8) break;
  }
  std::vector<Equations> of_block(blocks);
  Equations all = belief(r.fit);
  for (std::size_t i = 0; i < r.pairs.size(); ++i)
    if (r.agrees[i])
      add_pair(of_block[block_of(i, r.pairs.size(), blocks)], r.fit, r.pairs[i], 1 / (scale * scale));
  for (Equations& block : of_block) {
    all += block;
    block.information += belief(r.fit).information / double(blocks);
  }
  const auto steps = steps_without<unknowns>(of_block);
  const auto jackknife = jackknife_covariance<unknowns>(steps);
  const Eigen::Matrix<double, unknowns, unknowns> own =
      all.information.ldlt().solve(Eigen::Matrix<double, unknowns, unknowns>::Identity());
  const auto widest = [](const Eigen::Matrix3d& m) {
    return std::sqrt(m.selfadjointView<Eigen::Lower>().eigenvalues().maxCoeff());
  };
  constexpr double chi_of_three = 2.795;
  r.interval_rad =
      chi_of_three * std::max(widest(own.topLeftCorner<3, 3>()), widest(jackknife.topLeftCorner<3, 3>()));
  r.lag_deviation_s = std::sqrt(std::max(own(lag, lag), jackknife(lag, lag)));
  for (std::size_t i = 0; i < r.pairs.size(); ++i) {
    if (!r.agrees[i]) continue;
    Fitted without = r.fit;
    without.tool_from_sensor =
        rotation_of(steps[block_of(i, r.pairs.size(), blocks)].segment<3>(turn)) * without.tool_from_sensor;
    r.left_out_rad.push_back(residual_of(without, r.pairs[i]).norm());
  }
  return r;
}

// What the tracker saw it turn in a second, over the turns.
double seen_rate_radps(const std::vector<SeenTurn>& turns) {
  double turned = 0, lasted = 0;
  for (const SeenTurn& t : turns) {
    turned += angle_of(t.rotation);
    lasted += seconds(t.to - t.from);
  }
  return turned / std::max(1e-9, lasted);
}

}  // namespace

Fields to_fields(const SensorAxes& axes) {
  const Eigen::Quaterniond& q = axes.tool_from_sensor;
  return {{"tool_from_sensor_q", std::vector{q.w(), q.x(), q.y(), q.z()}}};
}

std::optional<SensorAxes> sensor_axes_from(const Fields& fields) {
  const auto rotation = rotation_in(fields, "tool_from_sensor_q");
  return rotation ? std::optional(SensorAxes{*rotation}) : std::nullopt;
}

Progress SensorAxesProcedure::add(const ImuSample& sample) {
  readings_.push_back(sample);
  if (sample.valid && sample.turn_rate_radps.allFinite())
    turning_ += sample.turn_rate_radps * sample.turn_rate_radps.transpose();
  return progress();
}

Progress SensorAxesProcedure::add(const PoseSample& sample) {
  if (tool_.empty()) tool_ = sample.tool;
  const bool unusable = screen_.look(sample) == PoseScreen::Finding::unusable;
  if (!unusable && (poses_.empty() || sample.time.host > poses_.back().time.host)) poses_.push_back(sample);
  return progress();
}

Progress SensorAxesProcedure::progress() const {
  Progress progress{.samples = readings_.size()};
  const Eigen::Vector3d strength =
      turning_.selfadjointView<Eigen::Lower>().eigenvalues().cwiseMax(0).cwiseSqrt();
  const double shape = strength(2) > 0 ? std::min(1.0, poor_condition * strength(1) / strength(2)) : 0;
  progress.covered = std::min(shape, std::min(1.0, double(readings_.size()) / double(enough_readings)));
  if (shape < 1)
    progress.missing = "turn it about another axis too";
  else if (progress.covered < 1)
    progress.missing = "go on turning";
  return progress;
}

Calibration<SensorAxes> SensorAxesProcedure::finish() const {
  CalibrationReport report;
  report.procedure = "imu-axes";
  report.to_frame = "tool " + tool_;
  report.from_frame = "inertial unit";
  report.unit = "deg";
  screen_.warn(report);
  if (screen_.frozen())
    return refusal(report, "all poses are the same: the tracker is frozen, or the handle was never turned");
  const std::vector<SeenTurn> turns = turns_of(poses_);
  const TurnedPath path(readings_, Eigen::Vector3d::Zero());
  const double lag_s = coarse_lag(turns, path);
  const std::vector<TurnPair> pairs = pairs_of(turns, path, lag_s);
  report.n = pairs.size();
  if (pairs.size() < fewest_turns)
    return refusal(report, "only " + std::to_string(pairs.size()) + " turns were seen by both, " +
                               std::to_string(fewest_turns) +
                               " are the fewest: record the tracker and the inertial unit at once");
  std::vector<double> angles;
  for (const TurnPair& pair : pairs) angles.push_back(in_deg(angle_of(pair.seen)));
  if (root_mean_square(angles) < least_turn_deg)
    return refusal(report, "the tracker saw hardly any turning: turn the handle, faster and about all axes");
  if (const double ratio = path.turned_rad() / std::max(1e-9, path.lasted_s()) / seen_rate_radps(turns);
      ratio > 10 || ratio < 0.1)
    return refusal(report, "the unit turned " + in_words(ratio, 3) + " times as far as the tracker saw" +
                               (ratio > 30 && ratio < 110 ? ": its rates look like degrees a second"
                                                          : ": are both on one handle?"));
  const TurnAxes axes = axes_of(pairs);
  const Eigen::Vector3d strength =
      axes.seen.selfadjointView<Eigen::Lower>().eigenvalues().cwiseMax(0).cwiseSqrt();
  report.condition = strength(2) / std::max(1e-12, strength(1));
  if (*report.condition > worst_condition)
    return refusal(report, "it turned about one axis only: turn it about another axis too");
  const Wahba guess = first_guess(axes);
  if (guess.mirrored_is_better)
    return refusal(report,
                   "the unit's axes look like the mirror image of the tool's: an axis has the wrong sign");

  const Refined r = refine(turns, readings_, {guess.rotation, Eigen::Vector3d::Zero(), lag_s});
  if (r.pairs.size() < fewest_turns || std::abs(r.fit.lag_s) > longest_lag_s + 0.02)
    return refusal(report, "the two clocks seem more than 0.2 s apart: find their offset first");
  std::vector<double> lengths, held_out;
  std::vector<std::string> outliers;
  for (std::size_t i = 0; i < r.pairs.size(); ++i) {
    const double off = in_deg(residual_of(r.fit, r.pairs[i]).norm());
    if (r.agrees[i])
      lengths.push_back(off);
    else
      outliers.push_back("at " + in_words(seconds(turns[r.pairs[i].number].from.time_since_epoch()), 3) +
                         " s, " + in_words(off) + " degrees off");
  }
  for (const double off : r.left_out_rad) held_out.push_back(in_deg(off));
  summarise(report, lengths, 3);
  report.held_out_rms = root_mean_square(held_out);
  const double interval = in_deg(r.interval_rad);
  report.ci95 = {0, interval};
  report.detail("gyro_bias_radps", std::vector<double>(r.fit.bias_radps.begin(), r.fit.bias_radps.end()));
  report.detail("lag_s", r.fit.lag_s);
  report.detail("lag_ci95_s", 1.96 * r.lag_deviation_s);
  report.detail("turn_rms_deg", root_mean_square(angles));
  report.detail("outliers", outliers);
  const std::string loose = ": are the unit and the markers on one handle, and does the tracker flip?";
  if (double(outliers.size()) > most_outliers * double(r.pairs.size()))
    return refusal(report, std::to_string(outliers.size()) + " of " + std::to_string(r.pairs.size()) +
                               " turns do not agree with the others" + loose);
  if (report.rms > worst_rms_deg)
    return refusal(report, "the turns differ by " + in_words(report.rms, 1) + " degrees" + loose);
  if (!(interval < worst_interval_deg))
    return refusal(report, "the axes are known to " + in_words(interval, 1) +
                               " degrees only: turn it further, and about another axis too");
  if (!outliers.empty())
    report.warnings.push_back(std::to_string(outliers.size()) +
                              " turns are outliers and were left out; the first " + outliers[0]);
  if (std::abs(r.fit.lag_s) > std::max(5e-3, 3 * r.lag_deviation_s))
    report.warnings.push_back("the unit shows a turn " + in_words(1e3 * std::abs(r.fit.lag_s), 1) + " ms " +
                              (r.fit.lag_s > 0 ? "later" : "earlier") +
                              " than the tracker; this was taken out here");
  if (interval > fair_interval_deg || *report.condition > poor_condition)
    report.warnings.push_back("known to " + in_words(interval, 1) +
                              " degrees: turn it further about a second axis next time");
  report.accepted = true;
  report.reason = "the axes are known to within " + in_words(interval) + " degrees (95 %)";
  return Calibrated<SensorAxes>{{r.fit.tool_from_sensor}, report};
}

}  // namespace fude
