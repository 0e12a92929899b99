// A recording given back: the same samples at every speed, at the recorded distances, from any place.
#include "rig/session_source.h"

#include <gtest/gtest.h>
#include <linux/input-event-codes.h>

#include <limits>
#include <stdexcept>
#include <thread>
#include <vector>

#include "drivers/tablet/pen_decoder.h"

namespace fude {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Timestamp recorded_at{seconds(5000)};
constexpr int stroke_length = 40;

DeviceDescription pen() {
  DeviceDescription device;
  device.transport = "evdev";
  device.keys = {BTN_TOOL_PEN, BTN_TOUCH};
  device.axes = {
      {ABS_X, 0, 10000, 0, 0, 100, 0}, {ABS_Y, 0, 10000, 0, 0, 100, 0}, {ABS_PRESSURE, 0, 1023, 0, 0, 0, 0}};
  return device;
}

// Near from the first frame, touching from frame 10 to frame 30, at 7, 14, 21 … ms.
std::vector<Transfer> stroke() {
  std::vector<Transfer> transfers;
  for (int i = 0; i < stroke_length; ++i) {
    std::vector<EvdevEvent> events{{EV_ABS, ABS_X, 10 * i}};
    if (i == 0) events.push_back({EV_KEY, BTN_TOOL_PEN, 1});
    if (i == 10) events.push_back({EV_KEY, BTN_TOUCH, 1});
    if (i == 30) events.push_back({EV_KEY, BTN_TOUCH, 0});
    events.push_back({EV_SYN, SYN_REPORT, 0});
    Transfer transfer;
    transfer.time = recorded_at + milliseconds(7 * i);
    transfer.payload = pack_events(events);
    transfers.push_back(transfer);
  }
  return transfers;
}

std::vector<PenSample> as_recorded() {
  PenDecoder decoder(pen());
  std::vector<PenSample> samples;
  for (const Transfer& transfer : stroke())
    if (const auto sample = decoder.decode(transfer)) samples.push_back(*sample);
  return samples;
}

struct Heard {
  std::vector<PenSample> samples;
  std::vector<Duration> after;  // on the clock, since the beginning
};

Heard heard(SessionSource& source, const Clock& clock) {
  const Timestamp began = clock.now();
  PenDecoder decoder(pen());
  Heard heard;
  for (;;) {
    const bool leading = source.leading();
    const auto read = source.read(std::nullopt);
    if (!read) return heard;
    const auto sample = decoder.decode(**read);
    if (!sample || leading) continue;
    heard.samples.push_back(*sample);
    heard.after.push_back(clock.now() - began);
  }
}

TEST(SessionSource, TheSamplesAreThoseOfTheRecordingAtEverySpeed) {
  const std::vector<PenSample> recorded = as_recorded();
  ASSERT_EQ(recorded.size(), std::size_t{stroke_length});
  for (const double speed : {0.0, 0.25, 1.0, 10.0}) {
    const auto clock = std::make_shared<ManualClock>();
    SessionSource source(stroke(), speed, clock);
    const Heard played = heard(source, *clock);
    EXPECT_EQ(played.samples, recorded) << "speed " << speed;
    for (std::size_t i = 0; i < played.after.size(); ++i) {
      // At 0 the source has a clock of its own, and this one is not waited on.
      const double expected_ms = speed == 0 ? 0 : 7.0 * static_cast<double>(i) / speed;
      EXPECT_NEAR(fude::seconds(played.after[i]) * 1000, expected_ms, 1e-6) << "speed " << speed;
    }
  }
}

TEST(SessionSource, ASoughtPlaceBeginsInTheStateOfThatTime) {
  const std::vector<PenSample> recorded = as_recorded();
  const auto clock = std::make_shared<ManualClock>();
  SessionSource source(stroke(), 2, clock);
  source.seek(recorded_at + milliseconds(7 * 20 - 3), clock->now());
  const Heard played = heard(source, *clock);
  ASSERT_EQ(played.samples.size(), 20u);
  EXPECT_TRUE(played.samples.front().in_contact) << "the pen was down";
  EXPECT_EQ(played.samples, std::vector<PenSample>(recorded.begin() + 20, recorded.end()));
  EXPECT_EQ(played.after.front(), std::chrono::microseconds(1500)) << "3 ms at twice the pace";
}

TEST(SessionSource, BeyondTheEndNothingIsInput) {
  const auto clock = std::make_shared<ManualClock>();
  SessionSource source(stroke(), 1, clock);
  source.seek(recorded_at + seconds(10), clock->now());
  EXPECT_TRUE(heard(source, *clock).samples.empty());
  EXPECT_FALSE(source.next_time());
  const auto over = source.read(std::nullopt);
  ASSERT_FALSE(over);
  EXPECT_EQ(over.error().fault, Fault::device_gone);
}

TEST(SessionSource, ADeadlineComesFirstWhereItIsEarlier) {
  const auto clock = std::make_shared<ManualClock>();
  SessionSource source(stroke(), 1, clock);
  ASSERT_TRUE(*source.read(clock->now()));  // the first is due at once
  const auto none = source.read(Timestamp(milliseconds(6)));
  ASSERT_TRUE(none);
  EXPECT_FALSE(*none);
  EXPECT_EQ(clock->now(), Timestamp(milliseconds(6)));
  EXPECT_TRUE(*source.read(Timestamp(milliseconds(7))));
}

TEST(SessionSource, AStampThatGoesBackIsKeptAndNotWaitedFor) {
  std::vector<Transfer> transfers = stroke();
  transfers[5].time = recorded_at - seconds(1);
  const auto clock = std::make_shared<ManualClock>();
  SessionSource source(transfers, 1, clock);
  for (const Transfer& transfer : transfers) {
    const auto read = source.read(std::nullopt);
    ASSERT_TRUE(read && *read);
    EXPECT_EQ(**read, transfer);
  }
  EXPECT_EQ(clock->now(), Timestamp(milliseconds(7 * (stroke_length - 1))));
}

TEST(SessionSource, TimesOfADamagedSessionEndNothing) {
  for (const auto wild : {Timestamp::min(), Timestamp::max()}) {
    PlayTime time;
    time.speed = 0.001;
    time.recorded = wild == Timestamp::min() ? Timestamp::max() : Timestamp::min();
    EXPECT_EQ(time.due(wild) > Timestamp{}, wild == Timestamp::max());
  }
}

TEST(SessionSource, WakeEndsAWaitOnTheMachinesClock) {
  std::vector<Transfer> transfers = stroke();
  transfers.back().time += std::chrono::hours(1);
  SessionSource source({transfers.front(), transfers.back()}, 1, std::make_shared<SystemClock>());
  ASSERT_TRUE(*source.read(std::nullopt));
  std::thread reader([&] {
    const auto woken = source.read(std::nullopt);
    EXPECT_TRUE(woken && !*woken);
  });
  source.wake();
  reader.join();
}

TEST(SessionSource, TakesWhatADriverSendsAndRefusesNoSpeedAtAll) {
  const auto clock = std::make_shared<ManualClock>();
  EXPECT_TRUE(SessionSource(stroke(), 1, clock).write({}));
  for (const double speed : {-1.0, std::numeric_limits<double>::infinity(), std::nan("")})
    EXPECT_THROW(SessionSource(stroke(), speed, clock), std::invalid_argument);
}

TEST(ManualClock, StandsWhereItWasWaitedToAndNeverGoesBack) {
  ManualClock clock;
  Waker waker;
  EXPECT_TRUE(clock.wait(Timestamp(seconds(3)), waker));
  EXPECT_TRUE(clock.wait(Timestamp(seconds(2)), waker));
  EXPECT_EQ(clock.now(), Timestamp(seconds(3)));
  waker.wake();
  EXPECT_FALSE(clock.wait(Timestamp(seconds(9)), waker));
  EXPECT_EQ(clock.now(), Timestamp(seconds(3)));
}

}  // namespace
}  // namespace fude
