#include "calibration/pivot.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace fude {
namespace {

constexpr std::size_t fewest_poses = 8;
constexpr std::size_t enough_poses = 150;
constexpr double worst_condition = 40;  // a second plane of turning with 3° of standard deviation
constexpr double poor_condition = 20;
constexpr double good_condition = 10;  // what a person is asked for
constexpr double worst_rms_mm = 5;
constexpr double fair_rms_mm = 1;
constexpr double least_mixed_up_mm = 2;
constexpr double most_outliers = 0.25;
constexpr double longest_brush_m = 1;
constexpr double mm_per_m = 1e3;
constexpr double degrees_per_radian = 180 / std::numbers::pi;

std::vector<double> millimetres(const Eigen::Vector3d& point_m) {
  const Eigen::Vector3d mm = mm_per_m * point_m;
  return {mm.x(), mm.y(), mm.z()};
}

std::vector<double> distances_mm(const PivotFit& fit, std::span<const ToolPose> poses) {
  std::vector<double> lengths;
  for (const ToolPose& pose : poses) lengths.push_back(mm_per_m * residual_of(fit, pose).norm());
  return lengths;
}

void describe(CalibrationReport& report, const std::string& method, const PivotFit& fit,
              std::span<const ToolPose> poses) {
  const double rms = root_mean_square(distances_mm(fit, poses));
  report.detail(method + "_tip_mm", millimetres(fit.tip_m));
  report.detail(method + "_pivot_mm", millimetres(fit.pivot_m));
  report.detail(method + "_rms_mm", rms);
  report.detail(method + "_rms_per_coordinate_mm", rms / std::numbers::sqrt3);
}

// The tip lies within this of the fitted one with 95 % probability: the largest axis of the ellipsoid of
// the normal equations, χ² of three.
double tip_radius95_mm(std::span<const ToolPose> poses, double sigma_mm) {
  Eigen::Matrix3d mean = Eigen::Matrix3d::Zero();
  for (const ToolPose& pose : poses) mean += pose.rotation.toRotationMatrix() / double(poses.size());
  const double sigma_max = mean.jacobiSvd().singularValues()(0);
  const double information = double(poses.size()) * std::max(1e-12, 1 - sigma_max * sigma_max);
  constexpr double chi_of_three = 2.795;
  return chi_of_three * sigma_mm / std::sqrt(information);
}

// Whether transposed rotations explain the poses far better.
bool looks_transposed(std::span<const ToolPose> poses, const PivotFit& fit) {
  std::vector<ToolPose> turned(poses.begin(), poses.end());
  for (ToolPose& pose : turned) pose.rotation = pose.rotation.conjugate();
  return 3 * quantile(distances_mm(robust_pivot(turned).fit, turned), 0.5) <
         quantile(distances_mm(fit, poses), 0.5);
}

struct Spin {
  Eigen::Vector3d axis;
  double wobble_rad = 0;
  bool turned = false;
};

// The direction that the spin leaves where it is: R·axis is the same for all, so the mean rotation keeps
// its length best along it.
Spin spin_of(std::span<const ToolPose> poses) {
  Eigen::Matrix3d mean = Eigen::Matrix3d::Zero();
  for (const ToolPose& pose : poses) mean += pose.rotation.toRotationMatrix() / double(poses.size());
  const auto svd = mean.jacobiSvd(Eigen::ComputeFullU | Eigen::ComputeFullV);
  constexpr double least_turn = 0.03;  // 1 − cos of 14°, the standard deviation of the spin
  const Eigen::Vector3d kept = svd.singularValues();
  return {svd.matrixV().col(0), std::sqrt(std::max(0.0, 2 * (1 - kept(0)))), kept(1) < 1 - least_turn};
}

}  // namespace

Fields to_fields(const PivotCalibration& pivot) {
  Fields fields{{"tool", pivot.tool},
                {"tip_m", std::vector{pivot.tip_m.x(), pivot.tip_m.y(), pivot.tip_m.z()}}};
  if (pivot.axis) fields.push_back({"axis", std::vector{pivot.axis->x(), pivot.axis->y(), pivot.axis->z()}});
  return fields;
}

std::optional<PivotCalibration> pivot_from(const Fields& fields) {
  const auto tip = numbers_in(fields, "tip_m");
  if (!tip || tip->size() != 3) return std::nullopt;
  PivotCalibration pivot{text_in(fields, "tool").value_or(""), Eigen::Vector3d(tip->data()), std::nullopt};
  if (!pivot.tip_m.allFinite()) return std::nullopt;
  if (const auto axis = numbers_in(fields, "axis"); axis && axis->size() == 3)
    pivot.axis = Eigen::Vector3d(axis->data()).normalized();
  return pivot;
}

Progress PivotProcedure::add(const PoseSample& sample) {
  const PoseScreen::Finding finding = screen_.look(sample);
  if (tool_.empty()) tool_ = sample.tool;
  if (finding == PoseScreen::Finding::sound) {
    if (spinning_) {
      spins_.push_back(sample.tracker_from_tool);
    } else {
      turns_.push_back({sample.tracker_from_tool, sample.time.host, screen_.seen() - 1});
      rotation_sum_ += sample.tracker_from_tool.rotation.toRotationMatrix();
    }
  }
  return progress();
}

Progress PivotProcedure::progress() const {
  Progress progress{.samples = turns_.size() + spins_.size()};
  if (screen_.frozen()) {
    progress.missing = "the tracker says the same pose all the time";
    return progress;
  }
  if (turns_.empty()) {
    progress.missing = "rest the tip in one place and turn the brush about it";
    return progress;
  }
  const double sigma = (rotation_sum_ / double(turns_.size())).jacobiSvd().singularValues()(0);
  const double condition = std::sqrt((1 + sigma) / std::max(1e-12, 1 - sigma));
  const double shape = std::min(1.0, good_condition / condition);
  const double count = std::min(1.0, double(turns_.size()) / double(enough_poses));
  progress.covered = std::min(shape, count);
  if (shape < 1)
    progress.missing = "lean it further, and in a second direction";
  else if (count < 1)
    progress.missing = "go on turning";
  return progress;
}

Calibration<PivotCalibration> PivotProcedure::finish() const {
  CalibrationReport report;
  report.procedure = "pivot";
  report.to_frame = report.from_frame = "tool " + tool_;
  report.n = turns_.size();
  screen_.warn(report);
  if (screen_.frozen())
    return refusal(report, "all poses are the same: the tracker is frozen, or the brush was never moved");
  if (turns_.size() < fewest_poses)
    return refusal(report, "only " + std::to_string(turns_.size()) + " poses can be used, " +
                               std::to_string(fewest_poses) + " are the fewest: turn longer");

  std::vector<ToolPose> poses;
  for (const Turn& turn : turns_) poses.push_back(turn.pose);
  const double condition = pivot_condition(poses);
  report.condition = condition;
  const Eigen::Vector3d kept = (rotation_sum_ / double(poses.size())).jacobiSvd().singularValues();
  constexpr double still = 2e-3;  // 1 − σ of the mean rotation: 3.6° in all
  if (kept(2) > 1 - still)
    return refusal(report,
                   "the orientation hardly changes: turn the brush about its tip, do not only move it");
  if (condition > worst_condition)
    return refusal(report, "turn more: the condition number " + in_words(condition, 0) +
                               " says that you only rocked the brush in one plane");

  const PivotFit plain = algebraic_pivot(poses);
  const RobustPivot robust = robust_pivot(poses);
  std::vector<ToolPose> used, halves[2];
  std::vector<std::string> outliers;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (robust.agrees[i]) {
      halves[i % 2].push_back(poses[i]);
      used.push_back(poses[i]);
      continue;
    }
    outliers.push_back("sample " + std::to_string(turns_[i].number) + " at " +
                       in_words(seconds(turns_[i].time.time_since_epoch()), 3) + " s, " +
                       in_words(mm_per_m * residual_of(robust.fit, poses[i]).norm()) + " mm off");
  }
  const PivotFit sphere = sphere_pivot(used);
  summarise(report, distances_mm(robust.fit, used), 3);
  report.ci95 = {0, tip_radius95_mm(used, report.rms_per_coordinate)};
  const double disagreement = mm_per_m * (sphere.tip_m - robust.fit.tip_m).norm();
  report.detail("tip_mm", millimetres(robust.fit.tip_m));
  report.detail("pivot_mm", millimetres(robust.fit.pivot_m));
  describe(report, "plain", plain, poses);
  describe(report, "plain_sphere", sphere_pivot(poses), poses);
  describe(report, "sphere", sphere, used);
  report.detail("disagreement_mm", disagreement);
  report.detail("outliers", outliers);

  if (report.rms > least_mixed_up_mm && looks_transposed(poses, robust.fit))
    return refusal(report, "residual " + in_words(report.rms, 0) + " mm: is the matrix transposed?");
  if (double(outliers.size()) > most_outliers * double(poses.size()))
    return refusal(report, std::to_string(outliers.size()) + " of " + std::to_string(poses.size()) +
                               " poses do not agree with one tip: it slid, or the tracker flips between two "
                               "solutions");
  if (report.rms > worst_rms_mm)
    return refusal(report, "residual " + in_words(report.rms, 1) +
                               " mm: the tip did not rest in one place, or the markers move on the handle");

  // Inverted poses fit as well as sound ones, with tip and pivot exchanged.
  if (robust.fit.tip_m.norm() > longest_brush_m)
    return refusal(report,
                   "the tip would lie " + in_words(robust.fit.tip_m.norm(), 1) +
                       " m from the markers: are the poses inverted, tool from tracker, or in another unit?");

  const PivotFit of_half[] = {algebraic_pivot(halves[0]), algebraic_pivot(halves[1])};
  std::vector<double> held_out = distances_mm(of_half[0], halves[1]);
  const std::vector<double> others = distances_mm(of_half[1], halves[0]);
  held_out.insert(held_out.end(), others.begin(), others.end());
  report.held_out_rms = root_mean_square(held_out);
  const double halves_apart = mm_per_m * (of_half[0].tip_m - of_half[1].tip_m).norm();
  report.detail("half_tips_mm", [&] {
    std::vector<double> both = millimetres(of_half[0].tip_m);
    for (const double v : millimetres(of_half[1].tip_m)) both.push_back(v);
    return both;
  }());
  report.detail("halves_apart_mm", halves_apart);
  if (halves_apart > worst_rms_mm)
    return refusal(report, "either half of the poses gives another tip, " + in_words(halves_apart, 1) +
                               " mm apart: turn longer and further");

  if (!outliers.empty())
    report.warnings.push_back(std::to_string(outliers.size()) +
                              " poses are outliers and were left out; the report names them");
  if (report.rms > fair_rms_mm)
    report.warnings.push_back("residual " + in_words(report.rms) +
                              " mm; a good tracker and a tip that rests give less than " +
                              in_words(fair_rms_mm, 0) + " mm");
  if (condition > poor_condition)
    report.warnings.push_back("condition " + in_words(condition, 0) + ": lean the brush further next time");
  if (disagreement > std::max(1.0, 2 * report.rms))
    report.warnings.push_back("the sphere fit puts the tip " + in_words(disagreement, 1) + " mm away");

  PivotCalibration pivot{tool_, robust.fit.tip_m, std::nullopt};
  if (spinning_) {
    const Spin spin = spin_of(spins_);
    constexpr double widest_wobble = 0.1;
    report.detail("axis_wobble_deg", spin.wobble_rad * degrees_per_radian);
    if (!spin.turned || spin.wobble_rad > widest_wobble) {
      report.warnings.push_back(spin.turned ? "no axis: the handle swayed while it was spun"
                                            : "no axis: spin the handle further about itself");
    } else {
      const double side = spin.axis.dot(-pivot.tip_m) < 0 ? -1 : 1;
      pivot.axis = side * spin.axis;
    }
  }
  report.accepted = true;
  report.reason = "the tip is known to within " + in_words((*report.ci95)[1]) + " mm (95 %)";
  return Calibrated<PivotCalibration>{pivot, report};
}

}  // namespace fude
