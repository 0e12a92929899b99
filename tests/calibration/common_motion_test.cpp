#include "calibration/common_motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "calibration/hand_eye.h"
#include "signal/units.h"
#include "tests/fakes/scripted_tracker.h"

namespace fude {
namespace {

const CommonMotion truth{
    {Eigen::Quaterniond(Eigen::AngleAxisd(1.9, Eigen::Vector3d(1, -2, 0.5).normalized())), {0.8, -0.3, 1.7}},
    {Eigen::Quaterniond(Eigen::AngleAxisd(-0.7, Eigen::Vector3d(0.2, 1, 2).normalized())),
     {0.03, -0.06, 0.08}}};

// A hand waves a tool through half a metre and turns it; `flatness` 0: about one axis alone.
Pose<Tracker, Tool> waved(double t, double flatness = 1) {
  const Eigen::Vector3d turn(0.9 * std::sin(1.7 * t), flatness * 0.7 * std::sin(2.3 * t + 1),
                             flatness * 0.8 * std::sin(1.1 * t + 2));
  const Eigen::Vector3d place(0.25 * std::sin(1.3 * t), 0.2 * std::sin(0.9 * t + 0.5),
                              1.2 + 0.15 * std::sin(1.9 * t));
  return {turn.norm() > 0 ? Eigen::Quaterniond(Eigen::AngleAxisd(turn.norm(), turn.normalized()))
                          : Eigen::Quaterniond::Identity(),
          place};
}

struct Scene {
  double seconds = 20;
  double rate_hz = 60, other_rate_hz = 100;
  double lag_s = 0;  // of the other
  double flatness = 1;
  double noise_m = 0.1e-3, noise_rad = 0.5e-3;
  CommonMotion joined = truth;

  std::vector<PoseSample> seen(std::uint32_t seed = 1) const { return stream(seed, rate_hz, 0, false); }
  std::vector<PoseSample> other(std::uint32_t seed = 2) const {
    return stream(seed + 1000, other_rate_hz, lag_s, true);
  }

 private:
  std::vector<PoseSample> stream(std::uint32_t seed, double rate, double lag, bool is_other) const {
    Noise noise(seed);
    std::vector<PoseSample> samples;
    for (int i = 0; i < int(seconds * rate); ++i) {
      const double t = (i + (is_other ? 0.37 : 0)) / rate;
      Pose<Tracker, Tool> pose = waved(t - lag, flatness);
      if (is_other) {
        const auto from_other = joined.tracker_from_other.inverse() * pose * joined.tool_from_other;
        pose = {from_other.rotation, from_other.translation};
      }
      const Eigen::Vector3d turn = noise.vector(noise_rad);
      pose.translation += noise.vector(noise_m);
      if (turn.norm() > 0) pose.rotation = Eigen::AngleAxisd(turn.norm(), turn.normalized()) * pose.rotation;
      samples.push_back(pose_sample(pose, 5 + t));
      samples.back().tool = is_other ? "wand" : "brush";
    }
    return samples;
  }
};

Calibration<CommonMotion> found(const std::vector<PoseSample>& seen, const std::vector<PoseSample>& other) {
  CommonMotionProcedure procedure;
  for (const PoseSample& sample : seen) procedure.add(sample);
  for (const PoseSample& sample : other) procedure.add_other(sample);
  return procedure.finish();
}
Calibration<CommonMotion> found(const Scene& scene, std::uint32_t seed = 1) {
  return found(scene.seen(seed), scene.other(seed));
}

// Of a point in the middle of the motion, as the other tracker has it.
double off_mm(const CommonMotion& result) {
  const Eigen::Vector3d seen = truth.tracker_from_other.inverse() * Eigen::Vector3d(0, 0, 1.2);
  return 1e3 * (result.tracker_from_other * seen - truth.tracker_from_other * seen).norm();
}

TEST(HandEye, TheClosedFormOfExactPairsIsExact) {
  std::vector<MotionPair> pairs;
  for (int i = 0; i < 8; ++i) {
    MotionPair& pair = pairs.emplace_back();
    pair.seen = waved(0.4 * i);
    pair.other = truth.tracker_from_other.inverse() * pair.seen * truth.tool_from_other;
  }
  const HandEye fit = closed_hand_eye(pairs);
  EXPECT_LT(fit.tracker_from_other.rotation.angularDistance(truth.tracker_from_other.rotation), 1e-7);
  EXPECT_LT(fit.tool_from_other.rotation.angularDistance(truth.tool_from_other.rotation), 1e-7);
  EXPECT_LT((fit.tracker_from_other.translation - truth.tracker_from_other.translation).norm(), 1e-9);
  EXPECT_LT((fit.tool_from_other.translation - truth.tool_from_other.translation).norm(), 1e-9);
  EXPECT_NEAR(length_ratio(pairs, fit), 1, 1e-9);
}

TEST(CommonMotion, TwoStreamsOfOtherTimesGiveBothTransforms) {
  const auto result = found(Scene{});
  ASSERT_TRUE(result) << result.error().reason;
  const double tool_mm =
      1e3 * (result->value.tool_from_other.translation - truth.tool_from_other.translation).norm();
  const double turn_deg = in_degrees(
      Radians(result->value.tracker_from_other.rotation.angularDistance(truth.tracker_from_other.rotation)));
  std::printf(
      "figure: common motion, 0.1 mm and 0.03 degrees of noise: trackers %.3f mm and %.4f degrees off, "
      "tools %.3f mm, within %.3f mm stated\n",
      off_mm(result->value), turn_deg, tool_mm, (*result->report.ci95)[1]);
  EXPECT_LT(off_mm(result->value), 0.05);
  EXPECT_LT(tool_mm, 0.05);
  EXPECT_LT(turn_deg, 0.01);
  EXPECT_LT((*result->report.ci95)[1], 0.2);
  EXPECT_LT(*result->report.held_out_rms, 1.2 * result->report.rms);
  EXPECT_TRUE(result->report.warnings.empty()) << result->report.warnings[0];
  EXPECT_NE(result->report.from_frame.find("wand"), std::string::npos);
}

TEST(CommonMotion, TheStatedRadiusHoldsTheTruth) {
  int within = 0, all = 0;
  for (std::uint32_t seed = 0; seed < 30; ++seed) {
    const Scene scene{.seconds = 3, .rate_hz = 30, .other_rate_hz = 40, .noise_m = 0.5e-3};
    const auto result = found(scene, seed);
    ASSERT_TRUE(result) << result.error().reason;
    within += off_mm(result->value) < (*result->report.ci95)[1];
    ++all;
  }
  std::printf("figure: common motion: the stated radius held the truth in %d of %d\n", within, all);
  EXPECT_GE(within, 27);
}

TEST(CommonMotion, TheDenserStreamMayBeEither) {
  const auto result = found(Scene{.rate_hz = 200, .other_rate_hz = 50});
  ASSERT_TRUE(result) << result.error().reason;
  EXPECT_LT(off_mm(result->value), 0.05);
}

TEST(CommonMotion, ALagOfOneIsFoundAndTakenOut) {
  for (const double lag_s : {0.03, -0.05}) {
    const auto result = found(Scene{.lag_s = lag_s});
    ASSERT_TRUE(result) << result.error().reason;
    EXPECT_NEAR(numbers_in(result->report.details, "lag_s")->front(), lag_s, 5e-4);
    EXPECT_LT(off_mm(result->value), 0.05);
    ASSERT_FALSE(result->report.warnings.empty());
    EXPECT_NE(result->report.warnings[0].find(lag_s > 0 ? "ms later" : "ms earlier"), std::string::npos)
        << result->report.warnings[0];
  }
}

TEST(CommonMotion, FlipsAndLossesAreNamedAndLeftOut) {
  const Scene scene;
  auto other = scene.other();
  for (std::size_t i = 300; i < 360; ++i) {
    other[i].tracker_from_tool.rotation =
        other[i].tracker_from_tool.rotation * Eigen::Quaterniond(0, 0, 0, 1);
    other[i].tracker_from_tool.translation.x() += 0.02;
  }
  for (std::size_t i = 900; i < 1000; ++i) other[i].valid = false;
  const auto result = found(scene.seen(), other);
  ASSERT_TRUE(result) << result.error().reason;
  EXPECT_LT(off_mm(result->value), 0.05);
  bool named = false, lost = false;
  for (const std::string& warning : result->report.warnings) {
    named = named || warning.find("moments are outliers") != std::string::npos;
    lost = lost || warning.find("wand: 100 of") != std::string::npos;
  }
  EXPECT_TRUE(named);
  EXPECT_TRUE(lost);
}

TEST(CommonMotion, ResultsReadBack) {
  const auto read = common_motion_from(to_fields(truth));
  ASSERT_TRUE(read);
  EXPECT_LT(read->tool_from_other.rotation.angularDistance(truth.tool_from_other.rotation), 1e-9);
  EXPECT_EQ(read->tracker_from_other.translation, truth.tracker_from_other.translation);
  EXPECT_FALSE(common_motion_from({}));
}

void expect_refused(const std::vector<PoseSample>& seen, const std::vector<PoseSample>& other,
                    const std::string& cause) {
  const auto result = found(seen, other);
  ASSERT_FALSE(result) << "accepted, where it should name: " << cause;
  EXPECT_NE(result.error().reason.find(cause), std::string::npos) << result.error().reason;
}

TEST(CommonMotionRefuses, TurningAboutOneAxis) {
  const Scene scene{.flatness = 0};
  expect_refused(scene.seen(), scene.other(), "turn it about another axis too");
}

TEST(CommonMotionRefuses, StreamsThatDoNotMeetOrStandStill) {
  const Scene scene{.seconds = 3};
  expect_refused(scene.seen(), {}, "never seen");
  auto later = scene.other();
  for (PoseSample& sample : later) sample.time.host += std::chrono::seconds(60);
  expect_refused(scene.seen(), later, "only 0 moments were seen by both");
  auto frozen = scene.other();
  for (PoseSample& sample : frozen) sample.tracker_from_tool = frozen[0].tracker_from_tool;
  expect_refused(scene.seen(), frozen, "all poses of wand are the same");
}

TEST(CommonMotionRefuses, MillimetresForMetres) {
  const Scene scene;
  auto other = scene.other();
  for (PoseSample& sample : other) sample.tracker_from_tool.translation *= 1e3;
  expect_refused(scene.seen(), other, "in another unit?");
}

TEST(CommonMotionRefuses, InvertedPoses) {
  const Scene scene;
  auto other = scene.other();
  for (PoseSample& sample : other) {
    const auto back = sample.tracker_from_tool.inverse();
    sample.tracker_from_tool = {back.rotation, back.translation};
  }
  expect_refused(scene.seen(), other, "are they tool from tracker?");
}

TEST(CommonMotionRefuses, ToolsThatAreNotJoined) {
  const Scene scene;
  auto other = scene.other();
  for (std::size_t i = 0; i < other.size(); ++i)
    other[i].tracker_from_tool.rotation =
        other[i].tracker_from_tool.rotation *
        Eigen::AngleAxisd(0.5 * std::sin(0.011 * double(i)), Eigen::Vector3d::UnitX());
  expect_refused(scene.seen(), other, "rigidly joined");
}

}  // namespace
}  // namespace fude
