// A real recording with faults put in: what can be decoded is, and every loss shows.
#include <gtest/gtest.h>

#include <optional>
#include <thread>
#include <vector>

#include "capture/import/import.h"
#include "drivers/tablet/pen_decoder.h"
#include "tests/fakes/recordings.h"
#include "tests/fakes/replay_source.h"

namespace fude {
namespace {

constexpr const char* drag = "evdev/Wacom_Intuos4_6x9.stylus-drag.events";

struct Played {
  std::vector<PenSample> samples;
  DecodeCounts counts;
};

Played play(const DeviceDescription& device, Replay replay) {
  ReplaySource source(std::move(replay));
  PenDecoder decoder(device);
  Played played;
  for (auto read = source.read(std::nullopt); read; read = source.read(std::nullopt))
    if (*read)
      if (const auto sample = decoder.decode(**read)) played.samples.push_back(*sample);
  played.counts = decoder.counts();
  return played;
}

class Faults : public testing::Test {
 protected:
  void SetUp() override {
    REQUIRE_RECORDING(drag);
    auto imported = import_file(recordings() / drag, {});
    ASSERT_TRUE(imported);
    device_ = *imported->recordings.at(0).device;
    whole_.transfers = imported->recordings.at(0).transfers;
    before_ = play(device_, whole_);
    while (!before_.samples.at(middle_).in_contact) ++middle_;
    middle_ += 20;  // frames and samples run in step until the pen leaves
  }
  DeviceDescription device_;
  Replay whole_;
  Played before_;
  std::size_t middle_ = 0;
};

// The samples of the untouched run, from number `first` on, but for their running numbers and marks.
void expect_rejoins(const std::vector<PenSample>& samples, const std::vector<PenSample>& whole,
                    std::size_t tail) {
  for (std::size_t i = 1; i <= tail; ++i) {
    PenSample a = samples.at(samples.size() - i);
    PenSample b = whole.at(whole.size() - i);
    a.time.sequence = b.time.sequence = 0;
    EXPECT_EQ(a, b) << i << " from the end";
  }
}

TEST_F(Faults, UnplugInMidStrokeEndsTheStroke) {
  const Played played = play(device_, unplugged(whole_, middle_, 10));
  ASSERT_EQ(played.samples.size(), middle_ + 1);  // after the plug no tool key says that a pen is near
  EXPECT_TRUE(played.samples.at(middle_ - 1).in_contact);
  EXPECT_EQ(played.samples.back().tool, PenTool::none);
}

TEST_F(Faults, ADropIsOneGapAndTheRestIsTheSame) {
  const Played played = play(device_, dropped(whole_, middle_, 5));
  EXPECT_EQ(played.counts.lost, 1u);
  EXPECT_TRUE(played.samples.at(middle_).after_gap);
  EXPECT_GT(played.samples.at(middle_).time.sequence, played.samples.at(middle_ - 1).time.sequence + 1);
  EXPECT_EQ(played.samples.size(), before_.samples.size() - 6);  // five lost, one stale
  expect_rejoins(played.samples, before_.samples, 20);
}

TEST_F(Faults, GarbageIsHeldAndTheNextFramesMendIt) {
  const Played played = play(device_, garbage(whole_, middle_));
  EXPECT_GT(played.counts.out_of_range, 0u);
  ASSERT_EQ(played.samples.size(), before_.samples.size() + 1);
  const PenSample& hostile = played.samples.at(middle_);
  EXPECT_GE(hostile.pressure.value, 0);
  EXPECT_LE(hostile.pressure.value, 1);
  EXPECT_EQ(played.counts.strokes, before_.counts.strokes);
}

TEST_F(Faults, AShortReadIsOneGap) {
  const Played played = play(device_, cut(whole_, middle_));
  EXPECT_EQ(played.counts.malformed, 1u);
  EXPECT_EQ(played.samples.size(), before_.samples.size() - 1);
  EXPECT_TRUE(played.samples.at(middle_).after_gap);
}

TEST_F(Faults, AStallIsWaitedOutAndEndsByWaking) {
  Replay stalling = whole_;
  stalling.stalls = {middle_};
  ReplaySource source(std::move(stalling));
  std::size_t transfers = 0;
  std::size_t woken = 0;
  std::thread reader([&] {
    for (auto read = source.read(std::nullopt); read; read = source.read(std::nullopt))
      ++(*read ? transfers : woken);
  });
  source.wake();
  reader.join();
  EXPECT_EQ(transfers, whole_.transfers.size());
  EXPECT_EQ(woken, 1u);
}

}  // namespace
}  // namespace fude
