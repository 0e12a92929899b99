// What a real kernel does to a reader of input devices that is slow, or whose device goes away.
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "drivers/tablet/pen_decoder.h"
#include "drivers/transport/evdev_source.h"
#include "tests/lab/attached_pen.h"
#include "tests/lab/patience.h"
#include "tests/lab/replugs.h"
#include "tests/lab/session_recording.h"
#include "tests/lab/uinput_pen.h"

namespace fude::lab {
namespace {

std::vector<PenSample> decoded(PenDecoder& decoder, const std::vector<Transfer>& transfers) {
  std::vector<PenSample> samples;
  for (const Transfer& transfer : transfers)
    if (const auto sample = decoder.decode(transfer)) samples.push_back(*sample);
  return samples;
}

TEST(EvdevFaults, FramesCarryTheKernelsMonotonicTime) {
  std::unique_ptr<UinputPen> pen;
  const DeviceNode found = attached_pen([&] { pen = std::make_unique<UinputPen>("lab pen"); });
  auto source = EvdevSource::open(found.path);
  ASSERT_TRUE(source) << source.error().message;
  const Timestamp before = monotonic_now();
  pen->move(1, 2, 3);
  const Timestamp after = monotonic_now();
  const auto transfer = (*source)->read(patience());
  ASSERT_TRUE(transfer && *transfer);
  EXPECT_EQ((*transfer)->stamped_by, StampedBy::kernel);
  EXPECT_GE((*transfer)->time, before - std::chrono::microseconds(1));  // the kernel gives microseconds
  EXPECT_LE((*transfer)->time, after);
}

// The kernel's buffer holds a few dozen frames; two hundred unread ones overflow it.
TEST(EvdevFaults, AnOverfullBufferIsAGapAndThenTheTruth) {
  constexpr int flood = 200;
  constexpr int quiet = 5;
  std::unique_ptr<UinputPen> pen;
  const DeviceNode found = attached_pen([&] { pen = std::make_unique<UinputPen>("lab pen"); });
  auto source = EvdevSource::open(found.path);
  ASSERT_TRUE(source) << source.error().message;
  SessionRecording recording(found.description);
  for (int i = 1; i <= quiet; ++i) {
    pen->move(i, 2 * i, 100 + i);
    recording.drain(**source);
  }
  ASSERT_EQ(recording.size(), std::size_t{quiet});
  for (int i = 1; i <= flood; ++i) pen->move(1000 + i, 2000 + i, 500 + i);
  recording.drain(**source);
  for (int i = 1; i <= quiet; ++i) {
    pen->move(5000 + i, 6000 + i, 1000 + i);
    recording.drain(**source);
  }
  PenDecoder decoder(found.description);
  const std::vector<PenSample> samples = decoded(decoder, recording.finish());
  EXPECT_GE(decoder.counts().lost, 1u);
  ASSERT_GT(samples.size(), std::size_t{2 * quiet});
  EXPECT_LT(samples.size(), std::size_t{flood});
  int gaps = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    gaps += samples[i].after_gap;
    // Whatever was lost, each sample is one that was sent: y and pressure belong to x.
    const auto x = static_cast<int>(samples[i].x_counts);
    const auto base = x > 5000 ? 5000 : x > 1000 ? 1000 : 0;
    EXPECT_EQ(samples[i].y_counts, base == 0 ? 2 * x : x + 1000);
    EXPECT_EQ(samples[i].pressure_raw, x - base + (base == 5000 ? 1000 : base == 1000 ? 500 : 100));
  }
  EXPECT_EQ(gaps, 1);
  for (int i = 1; i <= quiet; ++i)
    EXPECT_EQ(samples[samples.size() - quiet - 1 + static_cast<std::size_t>(i)].x_counts, 5000 + i);
}

TEST(EvdevFaults, PulledOutAndPutBackInMidStream) {
  constexpr int frames = 12;
  std::unique_ptr<UinputPen> pen;
  DeviceNode found = attached_pen([&] { pen = std::make_unique<UinputPen>("lab pen"); });
  const DeviceDescription described = found.description;
  SessionRecording recording(described);
  std::vector<int> arrived;  // frames of each life that were read
  for (int life = 0; life <= replugs(); ++life) {
    if (life > 0) {
      found = attached_pen([&] { pen = std::make_unique<UinputPen>("lab pen"); });
      ASSERT_EQ(found.description.id, described.id);
      Transfer back;
      back.kind = TransferKind::plugged;
      back.time = monotonic_now();
      recording.add(back);
    }
    auto source = EvdevSource::open(found.path);
    ASSERT_TRUE(source) << source.error().message;
    const std::size_t before = recording.size();
    for (int i = 1; i <= frames; ++i) {
      pen->move(10 * i, life + 1, i);
      if (i == frames / 2) recording.drain(**source);
    }
    const auto first = (*source)->read(monotonic_now());  // half a buffer is read, then the device is gone
    ASSERT_TRUE(first && *first);
    recording.add(**first);
    pen.reset();
    recording.drain_until(**source, before + 2 * frames);
    ASSERT_TRUE(recording.error());
    EXPECT_EQ(recording.error()->fault, Fault::device_gone);
    arrived.push_back(static_cast<int>(recording.size() - before) - 1);
  }
  PenDecoder decoder(described);
  const std::vector<Transfer> transfers = recording.finish();
  std::size_t at = 0;
  for (std::size_t life = 0; life < arrived.size(); ++life) {
    if (life > 0) {
      EXPECT_EQ(transfers.at(at++).kind, TransferKind::plugged);
    }
    EXPECT_GE(arrived[life], frames / 2 + 1);
    for (int i = 1; i <= arrived[life]; ++i, ++at) {
      const auto sample = decoder.decode(transfers.at(at));
      ASSERT_TRUE(sample) << "life " << life << " frame " << i;
      EXPECT_EQ(sample->x_counts, 10 * i);
      EXPECT_EQ(sample->y_counts, static_cast<double>(life + 1));
      EXPECT_EQ(sample->after_gap, life > 0 && i == 1);
    }
    EXPECT_EQ(transfers.at(at).kind, TransferKind::unplugged);
    decoder.decode(transfers.at(at++));
  }
  EXPECT_EQ(at, transfers.size());
  std::printf("figure: a pen pulled out %d times in mid-stream\n", replugs() + 1);
}

}  // namespace
}  // namespace fude::lab
