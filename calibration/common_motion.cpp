#include "calibration/common_motion.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "calibration/fusion/motion_state.h"
#include "calibration/motion_pairs.h"
#include "calibration/pivot_fit.h"
#include "calibration/pose_fields.h"
#include "signal/units.h"

namespace fude {
namespace {

constexpr double mm_per_m = 1e3;
constexpr std::size_t enough_pairs = 200;
constexpr double worst_condition = 40, poor_condition = 20;  // as of a pivot
constexpr double still = 2e-3;                               // 1 − σ of the mean rotation: 3.6° in all
constexpr double worst_rms_mm = 5, fair_rms_mm = 1;
constexpr double worst_turn_deg = 3;
constexpr double most_outliers = 0.25;
constexpr double explains = 3;  // times smaller a residual that another reading must leave

std::vector<ToolPose> poses_of(const std::vector<MotionPair>& pairs) {
  std::vector<ToolPose> poses;
  for (const MotionPair& pair : pairs) poses.push_back(pair.seen);
  return poses;
}

double median_shift_m(const std::vector<MotionPair>& pairs, const HandEye& fit) {
  std::vector<double> shifts;
  for (const MotionPair& pair : pairs) shifts.push_back(residual_of(fit, pair).shift_m.norm());
  return quantile(std::move(shifts), 0.5);
}

// Whether the other's poses fit far better when taken as tracker from tool for tool from tracker.
bool looks_inverted(const std::vector<MotionPair>& pairs, const HandEye& fit) {
  std::vector<MotionPair> turned = pairs;
  for (MotionPair& pair : turned) {
    const auto back = pair.other.inverse();
    pair.other = {back.rotation, back.translation};
    pair.other_turn_radps.setZero();
    pair.other_velocity_mps.setZero();
  }
  return explains * median_shift_m(turned, robust_hand_eye(turned).fit) < median_shift_m(pairs, fit);
}

// 95 in 100: what the frame's uncertainty makes of a point that the other tracker saw, at the worst of them.
double radius95_mm(const std::vector<MotionPair>& pairs, const RobustHandEye& robust) {
  constexpr double chi_of_three = 2.795;
  double worst = 0;
  for (const MotionPair& pair : pairs) {
    Eigen::Matrix<double, 3, 6> jacobian;
    jacobian << -cross_matrix(robust.fit.tracker_from_other.rotation * pair.other.translation),
        Eigen::Matrix3d::Identity();
    const Eigen::Matrix3d covariance = jacobian * robust.covariance_y * jacobian.transpose();
    worst = std::max(worst, covariance.selfadjointView<Eigen::Lower>().eigenvalues().maxCoeff());
  }
  return chi_of_three * mm_per_m * std::sqrt(worst);
}

double deviation(const Eigen::Matrix3d& covariance) {
  return std::sqrt(covariance.selfadjointView<Eigen::Lower>().eigenvalues().maxCoeff());
}

double in_deg(double radians) { return in_degrees(Radians(radians)); }

}  // namespace

Fields to_fields(const CommonMotion& motion) {
  Fields fields;
  put_pose(fields, "tracker_from_other_tracker", motion.tracker_from_other);
  put_pose(fields, "tool_from_other_tool", motion.tool_from_other);
  return fields;
}

std::optional<CommonMotion> common_motion_from(const Fields& fields) {
  const auto trackers = pose_in<Tracker, OtherTracker>(fields, "tracker_from_other_tracker");
  const auto tools = pose_in<Tool, OtherTool>(fields, "tool_from_other_tool");
  if (!trackers || !tools) return std::nullopt;
  return CommonMotion{*trackers, *tools};
}

void CommonMotionProcedure::Stream::add(const PoseSample& sample) {
  if (tool.empty()) tool = sample.tool;
  samples.push_back(sample);
  if (screen.look(sample) == PoseScreen::Finding::unusable) samples.back().valid = false;
}

Progress CommonMotionProcedure::add(const PoseSample& sample) {
  seen_.add(sample);
  if (seen_.samples.back().valid) rotation_sum_ += sample.tracker_from_tool.rotation.toRotationMatrix();
  return progress();
}

Progress CommonMotionProcedure::add_other(const PoseSample& sample) {
  other_.add(sample);
  return progress();
}

Progress CommonMotionProcedure::progress() const {
  Progress progress{.samples = std::min(seen_.samples.size(), other_.samples.size())};
  if (seen_.samples.empty() || other_.samples.empty()) {
    progress.missing = "move what both trackers see, turning it about every axis";
    return progress;
  }
  const double sigma = (rotation_sum_ / double(seen_.samples.size())).jacobiSvd().singularValues()(0);
  const double condition = std::sqrt((1 + sigma) / std::max(1e-12, 1 - sigma));
  const double shape = std::min(1.0, poor_condition / condition);
  progress.covered = std::min(shape, std::min(1.0, double(progress.samples) / double(enough_pairs)));
  if (shape < 1)
    progress.missing = "turn it about another axis too";
  else if (progress.covered < 1)
    progress.missing = "go on moving and turning";
  return progress;
}

Calibration<CommonMotion> CommonMotionProcedure::finish() const {
  CalibrationReport report;
  report.procedure = "common-motion";
  report.to_frame = "tracker of " + seen_.tool;
  report.from_frame = "tracker of " + other_.tool;
  for (const Stream* stream : {&seen_, &other_}) {
    if (stream->samples.empty())
      return refusal(report, "one of the two tools was never seen: record both at once");
    if (stream->screen.frozen())
      return refusal(report, "all poses of " + stream->tool +
                                 " are the same: its tracker is frozen, or it was never moved");
    CalibrationReport of_stream;
    stream->screen.warn(of_stream);
    for (const std::string& warning : of_stream.warnings)
      report.warnings.push_back(stream->tool + ": " + warning);
  }
  const PairedMotion f = pair_motion(seen_.samples, other_.samples);
  report.n = f.pairs.size();
  if (f.pairs.size() < fewest_motion_pairs)
    return refusal(report, "only " + std::to_string(f.pairs.size()) + " moments were seen by both, " +
                               std::to_string(fewest_motion_pairs) +
                               " are the fewest: record both at once, and keep both in view");
  const std::vector<ToolPose> poses = poses_of(f.pairs);
  const double condition = pivot_condition(poses);
  report.condition = condition;
  Eigen::Matrix3d mean = Eigen::Matrix3d::Zero();
  for (const ToolPose& pose : poses) mean += pose.rotation.toRotationMatrix() / double(poses.size());
  if (mean.jacobiSvd().singularValues()(2) > 1 - still)
    return refusal(report, "the orientation hardly changes: turn it, do not only move it");
  if (condition > worst_condition)
    return refusal(report, "turn it about another axis too: the condition number " + in_words(condition, 0) +
                               " says that it turned about one only");

  const RobustHandEye& robust = f.robust;
  std::vector<double> shifts, turns, held_out;
  std::vector<std::string> outliers;
  for (std::size_t i = 0; i < f.pairs.size(); ++i) {
    const HandEyeResidual r = residual_of(robust.fit, f.pairs[i]);
    if (robust.agrees[i]) {
      shifts.push_back(mm_per_m * r.shift_m.norm());
      turns.push_back(in_deg(r.turn_rad.norm()));
      held_out.push_back(mm_per_m * robust.left_out[i].shift_m.norm());
    } else {
      outliers.push_back("at " + in_words(seconds(f.pairs[i].time.time_since_epoch()), 3) + " s, " +
                         in_words(mm_per_m * r.shift_m.norm()) + " mm and " +
                         in_words(in_deg(r.turn_rad.norm())) + " degrees off");
    }
  }
  summarise(report, shifts, 3);
  const double turn_rms = root_mean_square(turns);
  report.held_out_rms = root_mean_square(held_out);
  report.ci95 = {0, radius95_mm(f.pairs, robust)};
  const double lag_s = f.lag_s;
  report.detail("turn_rms_deg", turn_rms);
  report.detail("turn_p95_deg", quantile(turns, 0.95));
  report.detail("turn_ci95_deg", 2.795 * in_deg(deviation(robust.covariance_y.topLeftCorner<3, 3>())));
  report.detail("tool_from_other_tool_ci95_mm",
                2.795 * mm_per_m * deviation(robust.covariance_x.bottomRightCorner<3, 3>()));
  report.detail("tool_from_other_tool_turn_ci95_deg",
                2.795 * in_deg(deviation(robust.covariance_x.topLeftCorner<3, 3>())));
  report.detail("lag_s", lag_s);
  report.detail("lag_ci95_s", 1.96 * robust.lag_deviation_s);
  report.detail("outliers", outliers);

  if (report.rms > fair_rms_mm) {
    if (looks_inverted(f.pairs, robust.fit))
      return refusal(
          report, "inverted, the poses of " + other_.tool + " fit far better: are they tool from tracker?");
    if (const double ratio = length_ratio(f.pairs, robust.fit); !(std::abs(ratio - 1) < 0.3))
      return refusal(report, "lengths of the other tracker, times " + in_words(ratio, 3) +
                                 ", would fit: are they in another unit?");
  }
  const std::string loose = ": the two are not rigidly joined, or a tracker flips between two solutions";
  if (double(outliers.size()) > most_outliers * double(f.pairs.size()))
    return refusal(report, std::to_string(outliers.size()) + " of " + std::to_string(f.pairs.size()) +
                               " moments do not agree with the others" + loose);
  if (turn_rms > worst_turn_deg)
    return refusal(report, "the two turn differently, by " + in_words(turn_rms, 1) + " degrees" + loose);
  if (report.rms > worst_rms_mm)
    return refusal(report, "residual " + in_words(report.rms, 1) + " mm" + loose);
  if (std::abs(lag_s) > longest_motion_lag_s)
    return refusal(report, "the two clocks seem more than 0.2 s apart: find their offset first");

  if (!outliers.empty())
    report.warnings.push_back(std::to_string(outliers.size()) +
                              " moments are outliers and were left out; the first " + outliers[0]);
  if (std::abs(lag_s) > std::max(2e-3, 3 * robust.lag_deviation_s))
    report.warnings.push_back("the poses of " + other_.tool + " come " + in_words(1e3 * std::abs(lag_s), 1) +
                              " ms " + (lag_s > 0 ? "later" : "earlier") + " than those of " + seen_.tool +
                              "; this was taken out here");
  if (report.rms > fair_rms_mm)
    report.warnings.push_back("residual " + in_words(report.rms) + " mm: is everything rigid?");
  if (condition > poor_condition)
    report.warnings.push_back("condition " + in_words(condition, 0) +
                              ": turn it further about a second axis next time");
  report.accepted = true;
  report.reason =
      "points that the other tracker saw are known to within " + in_words((*report.ci95)[1]) + " mm (95 %)";
  return Calibrated<CommonMotion>{{robust.fit.tracker_from_other, robust.fit.tool_from_other}, report};
}

}  // namespace fude
