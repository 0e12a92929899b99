// Pictures on their way to the recording: in their order, and none lost to a slow encoder.
#include "rig/frame_keeper.h"

#include <gtest/gtest.h>

#include <condition_variable>
#include <mutex>
#include <utility>
#include <vector>

namespace fude {
namespace {

Transfer picture(int number) {
  Transfer transfer{.time = Timestamp(Duration(number)), .kind = TransferKind::picture};
  transfer.payload = {static_cast<std::byte>(number)};
  return transfer;
}

CameraFrame yuyv(int number) {
  CameraFrame frame{.time = {Timestamp(Duration(number)), StampedBy::kernel, 0, {}}};
  frame.format = PixelFormat::yuyv;
  return frame;
}

struct Kept {
  std::vector<std::pair<Transfer, std::optional<CameraFrame>>> all;
  FrameKeeper::Keep keep() {
    return [this](Transfer transfer, std::optional<CameraFrame> frame) {
      all.emplace_back(std::move(transfer), std::move(frame));
    };
  }
};

Result<std::vector<std::byte>> doubled(std::span<const std::byte> bytes, CameraFrame& frame) {
  if (bytes[0] == std::byte{3}) return failure(Fault::malformed, "damaged");
  frame.format = PixelFormat::png;
  return std::vector{bytes[0], bytes[0]};
}

TEST(FrameKeeper, PicturesAreEncodedAndWhatCannotBeIsKeptAsSent) {
  Kept kept;
  for (int i = 1; i <= 4; ++i) {
    FrameKeeper keeper(doubled, kept.keep());
    keeper.add(picture(i), yuyv(i));
    EXPECT_EQ(keeper.finish().as_sent, i == 3 ? 1u : 0u);
  }
  ASSERT_EQ(kept.all.size(), 4u);
  EXPECT_EQ(kept.all[0].first.payload, (std::vector{std::byte{1}, std::byte{1}}));
  EXPECT_EQ(kept.all[0].second->format, PixelFormat::png);
  EXPECT_EQ(kept.all[2].first, picture(3));
  EXPECT_EQ(kept.all[2].second, yuyv(3));
}

// The encoder stands still at the first picture until all the others have come.
TEST(FrameKeeper, BehindItKeepsPicturesAsSentAndInTheirOrder) {
  constexpr int pictures = 20;
  Kept kept;
  std::mutex mutex;
  std::condition_variable changed;
  bool begun = false, all_there = false;
  FrameKeeper keeper(
      [&](std::span<const std::byte> bytes, CameraFrame& frame) {
        std::unique_lock lock(mutex);
        begun = true;
        changed.notify_all();
        changed.wait(lock, [&] { return all_there; });
        return doubled(bytes, frame);
      },
      kept.keep());
  keeper.add(picture(10), yuyv(10));
  {
    std::unique_lock lock(mutex);
    changed.wait(lock, [&] { return begun; });
  }
  for (int i = 1; i < pictures; ++i) keeper.add(picture(10 + i), yuyv(10 + i));
  keeper.add({.time = Timestamp(Duration(10 + pictures)), .kind = TransferKind::unplugged}, {});
  {
    const std::lock_guard lock(mutex);
    all_there = true;
  }
  changed.notify_all();
  const auto counts = keeper.finish();
  EXPECT_EQ(counts.as_wished, 2u);  // the first, and one that waited
  EXPECT_EQ(counts.as_sent, pictures - 2u);
  ASSERT_EQ(kept.all.size(), pictures + 1u);
  for (std::size_t i = 0; i < kept.all.size(); ++i) {
    EXPECT_EQ(kept.all[i].first.time, Timestamp(Duration(10 + static_cast<int>(i))));
    if (!kept.all[i].second) continue;
    const bool png = kept.all[i].second->format == PixelFormat::png;
    EXPECT_EQ(png, i < 2);
    EXPECT_EQ(kept.all[i].first.payload.size(), png ? 2u : 1u);
  }
  EXPECT_EQ(kept.all.back().first.kind, TransferKind::unplugged);
}

}  // namespace
}  // namespace fude
