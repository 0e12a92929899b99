// A device that comes and goes, read in one thread and woken from another.
#include "drivers/transport/returning_source.h"

#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <thread>

#include "tests/fakes/family_streams.h"
#include "tests/fakes/replay_source.h"
#include "tests/fakes/transfers.h"

namespace fude {
namespace {

using namespace std::chrono_literals;

Result<std::unique_ptr<ByteSource>> away() { return failure(Fault::not_found, "away"); }

// Each opening plays the next of `lives`, each of which ends unplugged.
ReturningSource::Open playing(std::vector<std::vector<Transfer>> lives, std::shared_ptr<std::size_t> opened) {
  return [lives = std::move(lives), opened]() -> Result<std::unique_ptr<ByteSource>> {
    if (*opened == lives.size()) return away();
    Replay replay;
    replay.transfers = lives[(*opened)++];
    replay.transfers.push_back(from_device(TransferKind::unplugged));
    return std::make_unique<ReplaySource>(std::move(replay));
  };
}

TEST(ReturningSource, EachLifeStandsBetweenPluggedAndUnplugged) {
  const auto stream = family_streams(5).front().reports;
  for (std::size_t cut = 0; cut <= stream.size(); ++cut) {
    const auto middle = stream.begin() + static_cast<std::ptrdiff_t>(cut);
    ReturningSource source(
        playing({{stream.begin(), middle}, {middle, stream.end()}}, std::make_shared<std::size_t>(0)), 1ms);
    std::vector<Transfer> got;
    for (std::size_t i = 0; i < stream.size() + 4; ++i) {
      const auto transfer = source.read(std::nullopt);
      ASSERT_TRUE(transfer && *transfer);
      got.push_back(**transfer);
    }
    EXPECT_EQ(got.front().kind, TransferKind::plugged);
    EXPECT_EQ(got[cut + 1].kind, TransferKind::unplugged);
    EXPECT_EQ(got[cut + 2].kind, TransferKind::plugged);
    EXPECT_EQ(got.back().kind, TransferKind::unplugged);
    std::erase_if(got, [](const Transfer& t) { return t.payload.empty(); });
    EXPECT_EQ(got, stream);
    const auto nothing = source.read(monotonic_now());
    EXPECT_TRUE(nothing && !*nothing);  // away: silent, not an error
  }
}

TEST(ReturningSource, WhileItIsAwayNothingCanBeSaid) {
  ReturningSource source(away, 1ms);
  const auto written = source.write({});
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().fault, Fault::device_gone);
}

TEST(ReturningSource, AWaitForItsReturnCanBeEnded) {
  ReturningSource source(away, 1h);
  std::thread waker([&] { source.wake(); });
  const auto transfer = source.read(std::nullopt);
  waker.join();
  EXPECT_TRUE(transfer && !*transfer);
}

TEST(ReturningSource, ADeviceThatStallsCanBeLeft) {
  Replay stalled;
  stalled.transfers = family_streams(3).front().reports;
  stalled.stalls = {1};
  ReturningSource source(
      [&]() -> Result<std::unique_ptr<ByteSource>> { return std::make_unique<ReplaySource>(stalled); });
  ASSERT_EQ((*source.read(std::nullopt))->kind, TransferKind::plugged);
  ASSERT_TRUE(*source.read(std::nullopt));
  std::atomic<bool> ended = false;
  std::thread waker([&] {
    while (!ended) source.wake();
  });
  const auto transfer = source.read(std::nullopt);
  ended = true;
  waker.join();
  EXPECT_TRUE(transfer && !*transfer);
}

}  // namespace
}  // namespace fude
