#include "signal/clock_fit.h"

#include <gtest/gtest.h>

#include <charconv>
#include <cmath>
#include <fstream>
#include <random>
#include <string>

#include "tests/fakes/recordings.h"

namespace fude {
namespace {

Timestamp at(double s) { return Timestamp(Duration(std::llround(s * 1e9))); }

// A device whose clock counts `tick_s` long ticks, read every `step` of them; each reading comes up to
// `delay_s` later, evenly distributed.
struct Device {
  double start_s = 100;
  double tick_s = 1e-3;
  std::uint64_t step = 10;
  double delay_s = 0;
  std::uint64_t first_tick = 5000;
  int counter_bits = 64;

  std::vector<ClockReading> read(std::size_t count, unsigned seed = 1) const {
    std::mt19937 random(seed);
    std::vector<ClockReading> readings;
    for (std::size_t i = 0; i < count; ++i) {
      const double late = delay_s * static_cast<double>(random()) / 0x1p32;
      const std::uint64_t tick = first_tick + i * step;
      readings.push_back({at(start_s + tick_s * static_cast<double>(i * step) + late),
                          counter_bits < 64 ? tick & ((std::uint64_t{1} << counter_bits) - 1) : tick});
    }
    return readings;
  }
};

double off_s(Timestamp fitted, double truth_s) { return seconds(fitted - at(truth_s)); }

TEST(ClockFit, APerfectClockIsFoundToTheNanosecond) {
  const Device device{.tick_s = 1.000123e-3};
  const ClockFitOptions options{.clock = {.nominal_tick = 1e-3}};
  const ClockFit fit = fit_clock(device.read(1000), options);
  ASSERT_EQ(fit.lines.size(), 1U);
  EXPECT_NEAR(fit.lines[0].tick_s, device.tick_s, 1e-13);
  EXPECT_NEAR(*fit.lines[0].drift_ppm(), 123, 1e-3);
  EXPECT_NEAR(off_s(fit.lines[0].offset, device.start_s), 0, 2e-9);
  EXPECT_LT(fit.lines[0].residual_s.largest, 2e-9);
  EXPECT_EQ(fit.lines[0].outliers, 0U);
}

TEST(ClockFit, OneSidedDelaysLeaveTheDriftAndMoveTheOffsetByTheirMiddle) {
  // Even delays of 0 to 4 ms: standard deviation 1.15 ms, so the slope's is 1.15 ms · √12 / (√N · 100 s).
  const Device device{.tick_s = 1e-3 * (1 - 50e-6), .delay_s = 4e-3};
  const ClockFitOptions options{.clock = {.nominal_tick = 1e-3}};
  const ClockFit fit = fit_clock(device.read(10'000), options);
  ASSERT_EQ(fit.lines.size(), 1U);
  const double slope_deviation_ppm = 4e-3 / 100.0 / 100.0 * 1e6;
  EXPECT_NEAR(*fit.lines[0].drift_ppm(), -50, 4 * slope_deviation_ppm);
  EXPECT_NEAR(off_s(fit.lines[0].offset, device.start_s), 2e-3, 1e-4);
  EXPECT_NEAR(fit.lines[0].residual_s.p50, 1e-3, 1e-4);
  EXPECT_LT(fit.lines[0].residual_s.largest, 2.2e-3);
  EXPECT_EQ(fit.lines[0].outliers, 0U);
}

TEST(ClockFit, AReadingThatCameFarTooLateIsFlaggedAndMovesNothing) {
  const Device device{.delay_s = 1e-3};
  std::vector<ClockReading> readings = device.read(2000);
  const ClockFit clean = fit_clock(readings, {});
  for (std::size_t i = 50; i < readings.size(); i += 100)
    readings[i].host += std::chrono::milliseconds(i % 200 == 50 ? 20 : 900);
  const ClockFit fit = fit_clock(readings, {});
  ASSERT_EQ(fit.lines.size(), 1U);
  EXPECT_EQ(fit.lines[0].outliers, 20U);
  for (std::size_t i = 0; i < readings.size(); ++i) EXPECT_EQ(fit.readings[i].outlier, i % 100 == 50) << i;
  EXPECT_NEAR(fit.lines[0].tick_s, clean.lines[0].tick_s, 2e-9);
  EXPECT_LT(std::abs(seconds(fit.lines[0].offset - clean.lines[0].offset)), 5e-5);
}

TEST(ClockFit, ARestartedClockBeginsALineOfItsOwn) {
  Device device{.tick_s = 1.00002e-3, .delay_s = 1e-3};
  std::vector<ClockReading> readings = device.read(1000);
  device.start_s = 115;  // after a pause of 5 s it counts from 7
  device.first_tick = 7;
  const std::vector<ClockReading> later = device.read(500, 2);
  readings.insert(readings.end(), later.begin(), later.end());
  for (const int bits : {64, 32}) {
    const ClockFit fit = fit_clock(readings, {.clock = {.counter_bits = bits, .nominal_tick = 1e-3}});
    ASSERT_EQ(fit.lines.size(), 2U) << bits;
    EXPECT_EQ(fit.lines[1].first_reading, 1000U);
    EXPECT_EQ(fit.lines[1].first_tick, 7U);
    EXPECT_NEAR(fit.lines[0].tick_s, 1.00002e-3, 1e-7);
    EXPECT_NEAR(off_s(fit.lines[1].offset, 115), 0.5e-3, 1e-4);
    EXPECT_LT(fit.lines[1].residual_s.largest, 1e-3);
  }
}

TEST(ClockFit, WhatPiledUpWhileTheHostWasBusyIsNoRestart) {
  const Device device{.tick_s = 1e-3, .step = 4};
  std::vector<ClockReading> readings = device.read(3000);
  const Timestamp awake = readings[1250].host;  // nothing was read for a second, then all of it at once
  for (std::size_t i = 1000; i < 1250; ++i) readings[i].host = awake + Duration(static_cast<int>(i) * 1000);
  const ClockFit fit = fit_clock(readings, {});
  ASSERT_EQ(fit.lines.size(), 1U);
  EXPECT_NEAR(fit.lines[0].tick_s, 1e-3, 1e-9);
  EXPECT_TRUE(fit.readings[1000].outlier);
}

TEST(ClockFit, CountersOf8And16And32BitsAreUnwound) {
  struct Case {
    int bits;
    double tick_s;
    std::uint64_t step;
  };
  for (const Case c : {Case{8, 5e-3, 3}, Case{16, 1e-5, 1000}, Case{32, 1e-6, 2'000'000}}) {
    Device device{
        .tick_s = c.tick_s, .step = c.step, .delay_s = 1e-3, .first_tick = 250, .counter_bits = c.bits};
    std::vector<ClockReading> readings = device.read(6000);
    // A loss of more than one turn of the smallest counter.
    readings.erase(readings.begin() + 3000, readings.begin() + 3300);
    const ClockFit fit = fit_clock(readings, {.clock = {.counter_bits = c.bits}});
    ASSERT_EQ(fit.lines.size(), 1U) << c.bits;
    EXPECT_NEAR(fit.lines[0].tick_s / c.tick_s, 1, 1e-5) << c.bits;
    EXPECT_LT(fit.lines[0].residual_s.largest, 0.7e-3) << c.bits;
    EXPECT_EQ(fit.lines[0].ticks(readings.back().tick, readings.back().host),
              static_cast<std::int64_t>(5999 * c.step));
  }
}

TEST(ClockFit, OneReadingAtATimeEndsWhereTheWholeStreamDoes) {
  const Device device{.tick_s = 1e-3 * (1 + 80e-6), .delay_s = 2e-3};
  std::vector<ClockReading> readings = device.read(20'000);
  for (std::size_t i = 500; i < readings.size(); i += 500) readings[i].host += std::chrono::milliseconds(30);
  const ClockFitOptions options{.clock = {.nominal_tick = 1e-3}};
  ClockFitter fitter(options);
  std::size_t outliers = 0;
  for (const ClockReading& r : readings) outliers += fitter.add(r).outlier;
  const ClockFit whole = fit_clock(readings, options);
  ASSERT_EQ(fitter.lines().size(), 1U);
  const ClockLine line = fitter.lines()[0];
  EXPECT_NEAR(*line.drift_ppm(), *whole.lines[0].drift_ppm(), 0.5);
  EXPECT_NEAR(*line.drift_ppm(), 80, 1);
  EXPECT_LT(
      std::abs(seconds(line.host(readings.back().tick, readings.back().host) - whole.readings.back().fitted)),
      1e-4);
  EXPECT_EQ(outliers, 39U);
  EXPECT_EQ(whole.lines[0].outliers, 39U);
}

TEST(ClockFit, TimesAndTicksOfAnyKindAreSafe) {
  std::mt19937_64 random(7);
  for (const int bits : {8, 16, 32, 64}) {
    std::vector<ClockReading> readings;
    for (int i = 0; i < 3000; ++i)
      readings.push_back({Timestamp(Duration(static_cast<std::int64_t>(random()))), random()});
    const ClockFit fit = fit_clock(readings, {.clock = {.counter_bits = bits}});
    EXPECT_EQ(fit.readings.size(), readings.size());
    for (const ClockLine& line : fit.lines) EXPECT_TRUE(std::isfinite(line.tick_s));
  }
  EXPECT_TRUE(fit_clock({}, {}).lines.empty());
  const std::vector<ClockReading> still(100, ClockReading{at(3), 9});
  EXPECT_EQ(fit_clock(still, {}).readings.back().fitted, at(3));
}

// PLUS's recording of a frame grabber: see the recordings' README for the published figures.
class FrameGrabber : public testing::Test {
 protected:
  void SetUp() override {
    REQUIRE_RECORDING("tracker/plus_timestamp_filtering.csv");
    std::ifstream file(recordings() / "tracker/plus_timestamp_filtering.csv");
    std::string line;
    std::getline(file, line);
    while (std::getline(file, line)) {
      const std::size_t second = line.find(',');
      const std::size_t third = line.find(',', second + 1);
      readings_.push_back(
          {at(std::stod(line.substr(third + 1)) - 1840000), std::stoull(line.substr(0, second))});
    }
    ASSERT_EQ(readings_.size(), 500U);
  }

  // Standard deviation of the time from frame to frame, for each frame counted.
  template <class Time>
  double deviation_of_steps(Time time) const {
    double sum = 0, squares = 0;
    for (std::size_t i = 1; i < readings_.size(); ++i) {
      const double step =
          seconds(time(i) - time(i - 1)) / static_cast<double>(readings_[i].tick - readings_[i - 1].tick);
      sum += step;
      squares += step * step;
    }
    const auto n = static_cast<double>(readings_.size() - 1);
    return std::sqrt(squares / n - sum / n * (sum / n));
  }

  std::vector<ClockReading> readings_;
};

TEST_F(FrameGrabber, ThePublishedSlopeAndResidualComeOut) {
  const ClockFit fit = fit_clock(readings_, {});
  ASSERT_EQ(fit.lines.size(), 1U);
  EXPECT_NEAR(fit.lines[0].tick_s, 0.017855, 0.00001);
  double squares = 0;
  for (std::size_t i = 0; i < readings_.size(); ++i)
    squares += std::pow(seconds(readings_[i].host - fit.readings[i].fitted), 2);
  EXPECT_NEAR(std::sqrt(squares / 500), 0.0158, 0.0008);
}

TEST_F(FrameGrabber, FittedTimesStepThreeTimesAsEvenly) {
  const double raw = deviation_of_steps([&](std::size_t i) { return readings_[i].host; });
  const ClockFit fit = fit_clock(readings_, {});
  EXPECT_LT(deviation_of_steps([&](std::size_t i) { return fit.readings[i].fitted; }), raw / 3);

  ClockFitter fitter({});
  std::vector<Timestamp> live;
  for (const ClockReading& r : readings_) live.push_back(fitter.add(r).fitted);
  EXPECT_LT(deviation_of_steps([&](std::size_t i) { return live[i]; }), raw / 3);
  for (std::size_t i = 0; i < live.size(); ++i)
    EXPECT_LT(std::abs(seconds(live[i] - readings_[i].host)), 0.08) << i;
}

}  // namespace
}  // namespace fude
