#include "calibration/delay/running_delay.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/fakes/scripted_strokes.h"

namespace fude {
namespace {

// Both streams in the order in which they arrive.
template <class Heard>
void run(RunningDelay& delay, const std::vector<PenSample>& pens, const std::vector<PoseSample>& poses,
         double late_s, Heard heard) {
  std::size_t next = 0;
  for (const PenSample& pen : pens) {
    const double t = seconds(pen.time.host.time_since_epoch());
    for (; next < poses.size() && seconds(poses[next].time.host.time_since_epoch()) + late_s < t; ++next)
      delay.add(DelaySide::b, poses[next]);
    if (const auto moment = delay.add(DelaySide::a, pen)) heard(*moment);
  }
}

TEST(RunningDelay, FollowsADriftFromWhatWasSeenLately) {
  const ScriptedStrokes script{.strokes = 150, .offset_s = -0.12, .drift = 200e-6};
  const auto seen = script.seen(1);
  RunningDelay delay("tablet", "tracker", {.every_s = 8});
  int moments = 0, covered = 0;
  run(delay, script.pens(seen), script.poses(seen), script.offset_s, [&](const DelayMoment& moment) {
    // The offset of the middle of the window.
    const double middle_s = moment.t_s - std::min(60.0, moment.t_s) / 2;
    const double truth_s = script.offset_s + script.drift * middle_s;
    EXPECT_NEAR(moment.offset_s, truth_s, 4e-3) << moment.t_s;
    ++moments;
    covered += std::abs(moment.offset_s - truth_s) < 1.5e-3 + moment.ci95_s;
  });
  EXPECT_GT(moments, 12);
  EXPECT_GE(covered, moments * 9 / 10);
  EXPECT_TRUE(delay.missing().empty()) << delay.missing();
}

TEST(RunningDelay, SaysWhatIsMissingAndBeginsAnewWithAClock) {
  const ScriptedStrokes script{.strokes = 40};
  const auto seen = script.seen(2);
  auto pens = script.pens(seen);
  const auto poses = script.poses(seen);
  RunningDelay delay("tablet", "tracker", {.every_s = 8});
  delay.add(DelaySide::a, pens.front());
  EXPECT_FALSE(delay.newest());
  EXPECT_FALSE(delay.missing().empty());
  run(delay, pens, poses, script.offset_s, [](const DelayMoment&) {});
  ASSERT_TRUE(delay.newest());
  EXPECT_NEAR(delay.newest()->offset_s, script.offset_s, 1e-3);
  PenSample again = pens.back();
  again.time.host -= std::chrono::seconds(20);
  delay.add(DelaySide::a, again);
  EXPECT_FALSE(delay.newest());
}

}  // namespace
}  // namespace fude
