#include "rig/stream_meter.h"

#include <gtest/gtest.h>

#include <chrono>

namespace fude {
namespace {

using std::chrono::microseconds;

SampleTime at(Duration host, std::uint64_t tick_us) {
  return {.host = Timestamp(host), .stamped_by = StampedBy::arrival, .sequence = 0, .device_tick = tick_us};
}

TEST(StreamMeter, KnowsAnEvenStreamsRateAndADeviceClocksDrift) {
  StreamMeter meter(DeviceClock{.nominal_tick = 1e-6});
  // The device's clock gains 100 parts in a million: its microseconds are short.
  for (std::uint64_t i = 0; i < 5000; ++i) meter.add(at(microseconds(1000 * i), i * 1000 + i / 10), false);
  const StreamFigures figures = meter.figures();
  EXPECT_EQ(figures.received, 5000);
  EXPECT_EQ(figures.gaps, 0);
  EXPECT_DOUBLE_EQ(figures.rate_hz, 1000);
  EXPECT_EQ(figures.jitter_us.largest, 0);
  ASSERT_EQ(figures.clock.size(), 1U);
  EXPECT_NEAR(figures.clock[0].drift_ppm().value(), -100, 1);
}

TEST(StreamMeter, JitterIsTheDistanceFromTheMedianInterval) {
  StreamMeter meter(std::nullopt);
  Duration host{};
  for (int i = 0; i < 1000; ++i) {
    // One report in a hundred is 300 µs late, and the next comes so much sooner after it.
    host += microseconds(i % 100 == 50 ? 1300 : i % 100 == 51 ? 700 : 1000);
    meter.add({.host = Timestamp(host)}, false);
  }
  const StreamFigures figures = meter.figures();
  EXPECT_DOUBLE_EQ(figures.rate_hz, 1000);
  EXPECT_EQ(figures.jitter_us.p50, 0);
  EXPECT_EQ(figures.jitter_us.p99, 300);
  EXPECT_EQ(figures.jitter_us.largest, 300);
}

TEST(StreamMeter, AbsencesAreGapsAndNoIntervals) {
  StreamMeter meter(std::nullopt);
  for (int i = 0; i < 10; ++i) meter.add({.host = Timestamp(microseconds(1000 * i))}, false);
  for (int i = 0; i < 10; ++i)
    meter.add({.host = Timestamp(std::chrono::hours(1) + microseconds(1000 * i))}, i == 0);
  EXPECT_EQ(meter.figures().gaps, 1);
  EXPECT_EQ(meter.figures().jitter_us.largest, 0);
}

TEST(StreamMeter, SamplesOfOneReportAreOne) {
  StreamMeter meter(std::nullopt);
  for (int i = 0; i < 30; ++i) meter.add({.host = Timestamp(microseconds(15000 * (i / 3)))}, false);
  EXPECT_EQ(meter.figures().received, 30);
  EXPECT_NEAR(meter.figures().rate_hz, 1e6 / 15000, 1e-9);
}

TEST(StreamMeter, OfNothingThereIsNothingToSay) {
  const StreamFigures figures = StreamMeter(DeviceClock{}).figures();
  EXPECT_EQ(figures.rate_hz, 0);
  EXPECT_EQ(figures.received, 0);
}

}  // namespace
}  // namespace fude
