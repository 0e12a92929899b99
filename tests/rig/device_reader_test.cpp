#include "rig/device_reader.h"

#include <gtest/gtest.h>
#include <linux/input-event-codes.h>

#include <atomic>
#include <memory>
#include <thread>
#include <vector>

#include "drivers/tablet/tablet_decoder.h"
#include "tests/fakes/replay_source.h"

namespace fude {
namespace {

DeviceDescription pen() {
  DeviceDescription device;
  device.keys = {BTN_TOOL_PEN, BTN_TOUCH};
  device.axes = {
      {ABS_X, 0, 10000, 0, 0, 100, 0}, {ABS_Y, 0, 10000, 0, 0, 100, 0}, {ABS_PRESSURE, 0, 1023, 0, 0, 0, 0}};
  return device;
}

// A stroke of `frames` reports, a millisecond apart.
Replay stroke(int frames) {
  Replay replay;
  for (int i = 0; i < frames; ++i) {
    std::vector<EvdevEvent> events{{EV_ABS, ABS_X, i}, {EV_SYN, SYN_REPORT, 0}};
    if (i == 0) events.insert(events.begin(), {{EV_KEY, BTN_TOOL_PEN, 1}, {EV_KEY, BTN_TOUCH, 1}});
    Transfer transfer;
    transfer.time = Timestamp(std::chrono::milliseconds(i));
    transfer.payload = pack_events(events);
    replay.transfers.push_back(transfer);
  }
  return replay;
}

TEST(DeviceReader, HearsEverythingInOrderUntilTheDeviceIsGone) {
  TabletDecoder decoder(pen());
  std::vector<double> heard;
  std::atomic<int> transfers{0};
  DeviceReader reader(std::make_unique<ReplaySource>(stroke(5000)), decoder,
                      [&](const Transfer&, std::span<const Sample> samples) {
                        for (const Sample& sample : samples)
                          heard.push_back(std::get<PenSample>(sample).x_counts);
                        ++transfers;
                      });
  while (transfers < 5000) std::this_thread::yield();
  EXPECT_TRUE(reader.stop());
  ASSERT_EQ(heard.size(), 5000u);
  for (int i = 0; i < 5000; ++i) EXPECT_EQ(heard[static_cast<std::size_t>(i)], i);
}

TEST(DeviceReader, StopsWhileTheDeviceIsSilent) {
  Replay replay = stroke(10);
  replay.stalls = {4};
  TabletDecoder decoder(pen());
  std::atomic<int> transfers{0};
  DeviceReader reader(std::make_unique<ReplaySource>(std::move(replay)), decoder,
                      [&](const Transfer&, std::span<const Sample>) { ++transfers; });
  while (transfers < 4) std::this_thread::yield();
  EXPECT_FALSE(reader.stop());
  EXPECT_EQ(transfers, 4);
}

}  // namespace
}  // namespace fude
