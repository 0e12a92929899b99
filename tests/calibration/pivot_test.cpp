#include "calibration/pivot.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/fakes/scripted_tracker.h"

namespace fude {
namespace {

Calibration<PivotCalibration> pivot_of(const std::vector<PoseSample>& samples) {
  PivotProcedure procedure;
  for (const PoseSample& sample : samples) procedure.add(sample);
  return procedure.finish();
}

std::vector<ToolPose> poses_of(const std::vector<PoseSample>& samples) {
  std::vector<ToolPose> poses;
  for (const PoseSample& sample : samples) poses.push_back(sample.tracker_from_tool);
  return poses;
}

TEST(Pivot, ExactPosesGiveTheTipByEveryFit) {
  const ScriptedPivot script;
  const auto poses = poses_of(script.samples());
  for (const PivotFit& fit : {algebraic_pivot(poses), sphere_pivot(poses), robust_pivot(poses).fit}) {
    EXPECT_LT((fit.tip_m - script.tip_m).norm(), 1e-9);
    EXPECT_LT((fit.pivot_m - script.pivot_m).norm(), 1e-9);
  }
}

// The singular values of the stacked [R, −1] themselves.
TEST(Pivot, ConditionIsThatOfTheEquations) {
  const auto poses = poses_of(ScriptedPivot{.lean_rad = 0.4, .poses = 40}.samples());
  Eigen::MatrixXd stacked(120, 6);
  for (Eigen::Index i = 0; i < 40; ++i)
    stacked.middleRows<3>(3 * i) << poses[std::size_t(i)].rotation.toRotationMatrix(),
        -Eigen::Matrix3d::Identity();
  const Eigen::VectorXd s = stacked.jacobiSvd().singularValues();
  EXPECT_NEAR(pivot_condition(poses), s(0) / s(5), 1e-6);
}

TEST(Pivot, TheStatedRadiusHoldsTheTruth) {
  const ScriptedPivot script{.noise_m = 0.3e-3};
  int within = 0;
  for (std::uint32_t seed = 0; seed < 40; ++seed) {
    const auto pivot = pivot_of(script.samples(seed));
    ASSERT_TRUE(pivot) << pivot.error().reason;
    EXPECT_NEAR(pivot->report.rms, 0.3 * std::sqrt(3), 0.06);
    within += 1e3 * (pivot->value.tip_m - script.tip_m).norm() < (*pivot->report.ci95)[1];
  }
  EXPECT_GE(within, 36);  // the radius is that of the worst direction: at least 95 % on the average
}

TEST(Pivot, OutliersAreNamedAndDoNotMoveTheTip) {
  const ScriptedPivot script{.noise_m = 0.1e-3};
  auto samples = script.samples();
  for (const std::size_t i : {20U, 21U, 77U, 150U})
    samples[i].tracker_from_tool.translation += Eigen::Vector3d(0.01, -0.02, 0.005);
  const auto pivot = pivot_of(samples);
  ASSERT_TRUE(pivot) << pivot.error().reason;
  EXPECT_LT((pivot->value.tip_m - script.tip_m).norm(), 1e-4);
  EXPECT_FALSE(pivot->report.warnings.empty());
  for (const Field& field : pivot->report.details)
    if (field.key == "outliers") {
      const auto& names = std::get<std::vector<std::string>>(field.value);
      ASSERT_EQ(names.size(), 4U);
      EXPECT_TRUE(names[2].starts_with("sample 77 at 2.567 s")) << names[2];
    }
}

TEST(Pivot, ProgressAsksForASecondDirection) {
  PivotProcedure procedure;
  EXPECT_LT(procedure.add(ScriptedPivot{}.samples().front()).covered, 0.01);
  Progress progress;
  for (const PoseSample& s : ScriptedPivot{.flatness = 0}.samples()) progress = procedure.add(s);
  EXPECT_LT(progress.covered, 1);
  EXPECT_NE(progress.missing.find("second direction"), std::string::npos);
  for (const PoseSample& s : ScriptedPivot{}.samples()) progress = procedure.add(s);
  EXPECT_EQ(progress.covered, 1);
  EXPECT_TRUE(progress.missing.empty());
}

TEST(Pivot, ASpinGivesTheAxisUpTheHandle) {
  const ScriptedPivot script{.noise_m = 0.1e-3};
  const Eigen::Vector3d axis = Eigen::Vector3d(0.1, -1, 0.05).normalized();
  PivotProcedure procedure;
  for (const PoseSample& s : script.samples()) procedure.add(s);
  procedure.begin_spin();
  Noise noise(3);
  const Eigen::Quaterniond rest(Eigen::AngleAxisd(0.7, Eigen::Vector3d(0, 1, 1).normalized()));
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d sway = noise.vector(0.005);
    const Eigen::Quaterniond q =
        rest * Eigen::AngleAxisd(0.05 * i, axis) * Eigen::AngleAxisd(sway.norm(), sway.normalized());
    procedure.add(pose_sample({q, script.pivot_m - q * script.tip_m}, 10 + i / 30.0));
  }
  const auto pivot = procedure.finish();
  ASSERT_TRUE(pivot);
  ASSERT_TRUE(pivot->value.axis);
  EXPECT_LT((*pivot->value.axis - axis).norm(), 0.003);
}

TEST(Pivot, ASpinThatDoesNotTurnLeavesTheAxisOut) {
  PivotProcedure procedure;
  for (const PoseSample& s : ScriptedPivot{}.samples()) procedure.add(s);
  procedure.begin_spin();
  for (const PoseSample& s : ScriptedPivot{.lean_rad = 0.02}.samples()) procedure.add(s);
  const auto pivot = procedure.finish();
  ASSERT_TRUE(pivot);
  EXPECT_FALSE(pivot->value.axis);
  EXPECT_NE(pivot->report.warnings.back().find("no axis"), std::string::npos);
}

TEST(Pivot, ResultsReadBack) {
  const PivotCalibration pivot{"brush", {0.01, 0.02, 0.03}, Eigen::Vector3d(0, 0.6, 0.8)};
  const auto read = pivot_from(to_fields(pivot));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->tip_m, pivot.tip_m);
  EXPECT_EQ(read->tool, "brush");
  EXPECT_LT((*read->axis - *pivot.axis).norm(), 1e-15);
  EXPECT_FALSE(pivot_from({{"tip_m", std::vector{1.0, 2.0}}}));
}

void expect_refused(const std::vector<PoseSample>& samples, const std::string& cause) {
  const auto pivot = pivot_of(samples);
  ASSERT_FALSE(pivot) << "accepted, where it should name: " << cause;
  EXPECT_FALSE(pivot.error().accepted);
  EXPECT_NE(pivot.error().reason.find(cause), std::string::npos) << pivot.error().reason;
}

TEST(PivotRefuses, TooFewPoses) { expect_refused(ScriptedPivot{.poses = 7}.samples(), "fewest"); }

TEST(PivotRefuses, NoPosesAtAll) { expect_refused({}, "0 poses"); }

TEST(PivotRefuses, AFrozenTracker) {
  auto samples = ScriptedPivot{}.samples();
  for (PoseSample& s : samples) s.tracker_from_tool = samples[0].tracker_from_tool;
  expect_refused(samples, "frozen");
}

TEST(PivotRefuses, AConstantOrientation) {
  auto samples = ScriptedPivot{.noise_m = 1e-3}.samples();
  for (PoseSample& s : samples) s.tracker_from_tool.rotation = samples[0].tracker_from_tool.rotation;
  expect_refused(samples, "orientation hardly changes");
}

TEST(PivotRefuses, RockingInOnePlane) {
  expect_refused(ScriptedPivot{.flatness = 0}.samples(), "in one plane");
  expect_refused(ScriptedPivot{.flatness = 0.05, .noise_m = 0.2e-3}.samples(), "in one plane");
}

TEST(PivotRefuses, TransposedMatrices) {
  auto samples = ScriptedPivot{.noise_m = 0.2e-3}.samples();
  for (PoseSample& s : samples) s.tracker_from_tool.rotation = s.tracker_from_tool.rotation.conjugate();
  expect_refused(samples, "is the matrix transposed?");
}

TEST(PivotRefuses, PosesTheOtherWayAbout) {
  auto samples = ScriptedPivot{.noise_m = 0.2e-3}.samples();
  for (PoseSample& s : samples) {
    const auto back = s.tracker_from_tool.inverse();
    s.tracker_from_tool = {back.rotation, back.translation};
  }
  expect_refused(samples, "inverted");
}

TEST(PivotRefuses, ATipThatSlides) {
  auto samples = ScriptedPivot{}.samples();
  for (std::size_t i = 0; i < samples.size(); ++i)
    samples[i].tracker_from_tool.translation.x() += 0.03 * std::sin(0.05 * double(i));
  const auto pivot = pivot_of(samples);
  ASSERT_FALSE(pivot);
  EXPECT_FALSE(pivot.error().reason.empty());
}

TEST(PivotRefuses, ATrackerThatFlipsBetweenTwoSolutions) {
  auto samples = ScriptedPivot{.noise_m = 0.1e-3}.samples();
  for (std::size_t i = 0; i < samples.size(); ++i)
    if (i % 5 < 2)
      samples[i].tracker_from_tool.rotation =
          samples[i].tracker_from_tool.rotation * Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitX());
  expect_refused(samples, "flips");
}

TEST(PivotSurvives, NumbersThatAreNoneTimesThatGoBackAndAStall) {
  const ScriptedPivot script{.noise_m = 0.1e-3};
  auto samples = script.samples();
  samples[3].tracker_from_tool.translation.x() = std::numeric_limits<double>::quiet_NaN();
  samples[4].tracker_from_tool.rotation.coeffs().setConstant(std::numeric_limits<double>::quiet_NaN());
  samples[5].tracker_from_tool.rotation.coeffs() *= 2;
  samples[6].valid = false;
  for (std::size_t i = 50; i < 60; ++i) samples[i].tracker_from_tool = samples[50].tracker_from_tool;
  for (std::size_t i = 100; i < samples.size(); ++i) samples[i].time.host -= std::chrono::seconds(5);
  const auto pivot = pivot_of(samples);
  ASSERT_TRUE(pivot) << pivot.error().reason;
  EXPECT_LT((pivot->value.tip_m - script.tip_m).norm(), 1e-4);
  std::string all;
  for (const std::string& w : pivot->report.warnings) all += w + "\n";
  EXPECT_NE(all.find("4 of 200 poses were left out"), std::string::npos) << all;
  EXPECT_NE(all.find("9 of 200 poses repeat"), std::string::npos) << all;
  EXPECT_NE(all.find("went backwards 1 times"), std::string::npos) << all;
}

}  // namespace
}  // namespace fude
