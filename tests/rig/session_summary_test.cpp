#include "rig/session_summary.h"

#include <gtest/gtest.h>

namespace fude {
namespace {

TEST(SessionSummary, RatesGapsAndTimesAreThoseOfTheSamples) {
  Session s;
  DeviceDescription d;
  d.name = "tablet";
  d.transport = "evdev";
  s.devices.push_back({4, d});
  for (int i = 0; i < 11; ++i) {
    RecordedPen pen;
    pen.device = 4;
    pen.sample.in_proximity = i != 10;  // the last one says that the pen has left
    pen.sample.after_gap = i == 5;
    pen.sample.time.host = Timestamp(std::chrono::milliseconds(1000 + 5 * i));
    s.pens.push_back(pen);
  }
  const SessionSummary summary = summarise(s);
  ASSERT_EQ(summary.streams.size(), 1U);
  EXPECT_EQ(summary.streams[0].samples, 10);
  EXPECT_DOUBLE_EQ(summary.streams[0].rate_hz, 200);
  EXPECT_EQ(summary.streams[0].gaps, 1);
  EXPECT_DOUBLE_EQ(summary.streams[0].start_s, 0);
  EXPECT_DOUBLE_EQ(summary.streams[0].end_s, 0.045);
  EXPECT_DOUBLE_EQ(summary.duration_s, 0.045);
}

TEST(SessionSummary, EachToolOfATrackerIsAStreamWithItsRateAndGaps) {
  Session s;
  DeviceDescription d;
  d.name = "tracker";
  d.transport = "network";
  s.devices.push_back({1, d});
  for (int i = 0; i < 20; ++i) {
    PoseSample pose;
    pose.time.host = Timestamp(std::chrono::milliseconds(25 * i));
    pose.tool = i % 2 == 0 ? "probe" : "ref";
    pose.after_gap = i == 7;
    s.samples.push_back({1, pose, i});
  }
  const SessionSummary summary = summarise(s);
  ASSERT_EQ(summary.streams.size(), 2U);
  EXPECT_EQ(summary.streams[0].name, "tracker/probe");
  EXPECT_EQ(summary.streams[0].kind, "pose");
  EXPECT_EQ(summary.streams[0].samples, 10);
  EXPECT_DOUBLE_EQ(summary.streams[0].rate_hz, 20);
  EXPECT_EQ(summary.streams[0].gaps, 0);
  EXPECT_EQ(summary.streams[1].gaps, 1);
  EXPECT_DOUBLE_EQ(summary.duration_s, 0.475);
}

TEST(SessionSummary, AnEmptySessionHasNoDuration) {
  const SessionSummary summary = summarise({});
  EXPECT_TRUE(summary.streams.empty());
  EXPECT_EQ(summary.duration_s, 0);
}

}  // namespace
}  // namespace fude
