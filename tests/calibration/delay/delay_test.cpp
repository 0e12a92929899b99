#include "calibration/delay/delay.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/fakes/scripted_strokes.h"

namespace fude {
namespace {

Calibration<DelayCalibration> delay_of(const std::vector<PenSample>& pens,
                                       const std::vector<PoseSample>& poses, bool pen_first = true) {
  WitnessReader pen("tablet"), tracker("tracker");
  DelayProcedure procedure(pen_first ? pen : tracker, pen_first ? tracker : pen);
  for (const PenSample& sample : pens) procedure.add(pen_first ? DelaySide::a : DelaySide::b, sample);
  for (const PoseSample& sample : poses) procedure.add(pen_first ? DelaySide::b : DelaySide::a, sample);
  return procedure.finish();
}

Calibration<DelayCalibration> delay_of(const ScriptedStrokes& script, std::uint32_t seed = 1) {
  const auto seen = script.seen(seed);
  return delay_of(script.pens(seen), script.poses(seen));
}

double number(const CalibrationReport& report, const char* key) {
  const auto numbers = numbers_in(report.details, key);
  EXPECT_TRUE(numbers && numbers->size() == 1) << key;
  return numbers ? numbers->front() : NAN;
}

void expect_refused(const Calibration<DelayCalibration>& delay, const std::string& cause) {
  ASSERT_FALSE(delay) << "accepted, where it should name: " << cause << "; " << delay->report.reason;
  EXPECT_NE(delay.error().reason.find(cause), std::string::npos) << delay.error().reason;
}

TEST(Delay, TouchesGiveTheOffsetOfATrackerWhateverTheHeight) {
  for (const double threshold_mm : {0.0, 0.5, 2.0}) {
    const ScriptedStrokes script{.threshold_mm = threshold_mm};
    const auto delay = delay_of(script);
    ASSERT_TRUE(delay) << delay.error().reason;
    EXPECT_NEAR(delay->value.offset_s, script.offset_s, 0.5e-3);
    EXPECT_FALSE(delay->value.drift_ppm);
    const CalibrationReport& r = delay->report;
    EXPECT_EQ(r.unit, "ms");
    EXPECT_LT((*r.ci95)[0], 1e3 * script.offset_s);
    EXPECT_GT((*r.ci95)[1], 1e3 * script.offset_s);
    EXPECT_NEAR(number(r, "lift_below_touch_mm"), script.lift_lower_mm, 0.15);
    ASSERT_TRUE(r.held_out_rms);
    EXPECT_NEAR(*r.held_out_rms, r.rms, 0.3 * r.rms);
    EXPECT_LT(r.rms, 1.5);
  }
}

TEST(Delay, TheOtherWayRoundItIsTheOpposite) {
  const ScriptedStrokes script;
  const auto seen = script.seen(2);
  const auto there = delay_of(script.pens(seen), script.poses(seen));
  const auto back = delay_of(script.pens(seen), script.poses(seen), false);
  ASSERT_TRUE(there && back);
  EXPECT_NEAR(there->value.offset_s, -back->value.offset_s, 1e-9);
  EXPECT_EQ(back->value.a, "tracker");
}

TEST(Delay, LongDelaysToEitherSideAreFound) {
  for (const double offset_s : {-0.2976, 0.31, 1.2, -1.7}) {
    const ScriptedStrokes script{.offset_s = offset_s};
    const auto delay = delay_of(script, 5);
    ASSERT_TRUE(delay) << offset_s << ": " << delay.error().reason;
    EXPECT_NEAR(delay->value.offset_s, offset_s, 0.5e-3);
  }
}

TEST(Delay, ADriftIsFoundAndItsCourseTold) {
  const ScriptedStrokes script{.strokes = 200, .drift = 80e-6};
  const auto delay = delay_of(script, 3);
  ASSERT_TRUE(delay) << delay.error().reason;
  ASSERT_TRUE(delay->value.drift_ppm);
  const CalibrationReport& r = delay->report;
  EXPECT_NEAR(*delay->value.drift_ppm, 80, number(r, "drift_ci95_ppm") * 1.5);
  EXPECT_LT(number(r, "drift_ci95_ppm"), 10);
  EXPECT_NEAR(delay->value.offset_s, script.offset_s + 80e-6 * delay->value.reference_s, 0.5e-3);
  const auto times = numbers_in(r.details, "course_t_s"), course = numbers_in(r.details, "course_offset_ms"),
             intervals = numbers_in(r.details, "course_ci95_ms");
  ASSERT_GE(times->size(), 20U);
  int within = 0;
  for (std::size_t i = 0; i < times->size(); ++i)
    within += std::abs((*course)[i] - 1e3 * (script.offset_s + 80e-6 * (*times)[i])) < (*intervals)[i] + 0.3;
  EXPECT_GE(double(within), 0.9 * double(times->size()));
}

TEST(Delay, AHardPenThatStopsDeadIsNotSmoothedOver) {
  const auto delay = delay_of(ScriptedStrokes{.hard = true}, 4);
  ASSERT_TRUE(delay) << delay.error().reason;
  EXPECT_NEAR(delay->value.offset_s, 0.0137, 1e-3);
  EXPECT_EQ(text_in(delay->report.details, "way_stops_at_touch"), "yes");
}

TEST(Delay, AFewWildTouchesAreLeftOut) {
  const ScriptedStrokes script;
  auto seen = script.seen(6);
  for (const std::size_t i : {10U, 11U, 40U, 41U}) seen.touches[i].t_s += 0.05;
  const auto delay = delay_of(script.pens(seen), script.poses(seen));
  ASSERT_TRUE(delay) << delay.error().reason;
  EXPECT_NEAR(delay->value.offset_s, script.offset_s, 0.5e-3);
  EXPECT_GE(number(delay->report, "touches_left_out"), 4);
}

TEST(Delay, ResultsReadBack) {
  const DelayCalibration delay{"pen", "tracker", -0.2976, 12.5, 30};
  const auto read = delay_from(to_fields(delay));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->a, "pen");
  EXPECT_EQ(read->b, "tracker");
  EXPECT_EQ(read->offset_s, delay.offset_s);
  EXPECT_EQ(read->drift_ppm, delay.drift_ppm);
  EXPECT_EQ(read->reference_s, 30);
  EXPECT_FALSE(delay_from({{"offset_s", std::numeric_limits<double>::quiet_NaN()}}));
}

TEST(DelayRefuses, TooFewStrokes) {
  expect_refused(delay_of(ScriptedStrokes{.strokes = 6}), "make 4 more at least");
}

TEST(DelayRefuses, TouchesAtOneSpeed) {
  auto script = ScriptedStrokes{.slowest_s = 0.2, .fastest_s = 0.2, .one_way = true};
  expect_refused(delay_of(script), "vary your speed");
}

TEST(DelayRefuses, EvenStrokesThatCouldBePairedOtherwise) {
  expect_refused(delay_of(ScriptedStrokes{.period_s = 1.2}), "vary the time between strokes");
}

TEST(DelayRefuses, StreamsThatDoNotSeeTheSame) {
  const ScriptedStrokes script;
  const auto one = script.seen(1), other = script.seen(2);
  expect_refused(delay_of(script.pens(one), script.poses(other)), "do not see the same");
}

TEST(DelayRefuses, StreamsThatNeverOverlap) {
  const ScriptedStrokes script;
  const auto seen = script.seen(1);
  auto poses = script.poses(seen);
  for (PoseSample& pose : poses) pose.time.host += std::chrono::seconds(500);
  expect_refused(delay_of(script.pens(seen), poses), "never overlap");
}

TEST(DelayRefuses, AClockThatStartsAnew) {
  const ScriptedStrokes script;
  const auto seen = script.seen(1);
  auto poses = script.poses(seen);
  for (std::size_t i = poses.size() / 2; i < poses.size(); ++i)
    poses[i].time.host -= std::chrono::seconds(30);
  expect_refused(delay_of(script.pens(seen), poses), "started anew");
  poses = script.poses(seen);
  for (std::size_t i = poses.size() / 2; i < poses.size(); ++i)
    poses[i].time.host += std::chrono::milliseconds(200);
  expect_refused(delay_of(script.pens(seen), poses), "started anew");
}

TEST(DelayRefuses, FrozenEmptyAndNumberlessStreams) {
  const ScriptedStrokes script;
  const auto seen = script.seen(1);
  auto poses = script.poses(seen);
  for (PoseSample& pose : poses) pose.tracker_from_tool = poses.front().tracker_from_tool;
  expect_refused(delay_of(script.pens(seen), poses), "tracker is frozen");
  for (PoseSample& pose : poses) pose.tracker_from_tool.translation.x() = std::nan("");
  expect_refused(delay_of(script.pens(seen), poses), "hold no numbers");
  expect_refused(delay_of(script.pens(seen), {}), "tracker has no samples");
}

TEST(Delay, SomeSamplesWithoutNumbersAreCountedAndPassedOver) {
  const ScriptedStrokes script;
  const auto seen = script.seen(1);
  auto poses = script.poses(seen);
  for (std::size_t i = 0; i < poses.size(); i += 50)
    poses[i].tracker_from_tool.translation.y() = std::numeric_limits<double>::infinity();
  const auto delay = delay_of(script.pens(seen), poses);
  ASSERT_TRUE(delay) << delay.error().reason;
  EXPECT_NEAR(delay->value.offset_s, script.offset_s, 0.5e-3);
  EXPECT_NE(delay->report.warnings.front().find("hold no numbers"), std::string::npos);
}

}  // namespace
}  // namespace fude
