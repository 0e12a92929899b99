// A machine that sleeps, by clocks that the test sets.
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "drivers/transport/returning_source.h"
#include "drivers/transport/sleep_aware_source.h"
#include "tests/fakes/replay_source.h"
#include "tests/fakes/transfers.h"

namespace fude {
namespace {

using std::chrono_literals::operator""h;
using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""s;

// Both clocks of a machine; between two readings time may pass, or the machine sleep.
struct Machine {
  Duration awake = 5s;
  Duration asleep = 3s;
  Duration held_up{};  // passes before each reading
  SleepWatch watch() {
    return SleepWatch(
        [this] {
          awake += held_up;
          return awake;
        },
        [this] {
          awake += held_up;
          return awake + asleep;
        });
  }
};

TEST(SleepWatch, SleepIsSeenOnce) {
  Machine machine;
  SleepWatch watch = machine.watch();
  EXPECT_FALSE(watch.slept());  // what was slept before is not news
  machine.awake += 1h;
  EXPECT_FALSE(watch.slept());
  machine.asleep += 1ms;
  EXPECT_TRUE(watch.slept());
  EXPECT_FALSE(watch.slept());
  machine.asleep += 8h;
  EXPECT_TRUE(watch.slept());
}

TEST(SleepWatch, ABusyMachineIsNotTakenForOneThatSlept) {
  Machine machine;
  SleepWatch watch = machine.watch();
  for (const Duration held_up : {Duration(0), Duration(2s), Duration(1ms), Duration(30s), Duration(0)}) {
    machine.held_up = held_up;
    EXPECT_FALSE(watch.slept());
  }
  machine.asleep += 10ms;
  EXPECT_TRUE(watch.slept());
  machine.held_up = 2s;  // so much, that a short sleep shows only once there is time to look
  machine.asleep += 1s;
  EXPECT_FALSE(watch.slept());
  machine.held_up = Duration(0);
  EXPECT_TRUE(watch.slept());
  EXPECT_FALSE(watch.slept());
}

TEST(SleepWatch, TheMachinesOwnClocksAreThere) {
  SleepWatch watch;
  EXPECT_FALSE(watch.slept());
}

Replay three() {
  Replay replay;
  for (int i = 1; i <= 3; ++i) replay.transfers.push_back(from_device(TransferKind::hid_report, {}, i));
  return replay;
}

std::vector<TransferKind> kinds(const std::vector<Transfer>& transfers) {
  std::vector<TransferKind> all;
  for (const Transfer& transfer : transfers) all.push_back(transfer.kind);
  return all;
}

// The machine sleeps while transfer `before` is awaited.
std::vector<Transfer> all_of(SleepAwareSource& source, Machine& machine, std::size_t before) {
  std::vector<Transfer> all;
  for (;;) {
    if (all.size() == before) machine.asleep += 2s;
    const auto read = source.read(std::nullopt);
    if (!read) return all;
    if (*read) all.push_back(**read);
  }
}

TEST(SleepAwareSource, SleepIsMarkedBeforeWhatComesNext) {
  for (std::size_t before = 0; before < 3; ++before) {
    Machine machine;
    SleepAwareSource source(std::make_unique<ReplaySource>(three()), AfterSleep::goes_on, machine.watch());
    const auto all = all_of(source, machine, before);
    std::vector<TransferKind> expected(3, TransferKind::hid_report);
    expected.insert(expected.begin() + static_cast<std::ptrdiff_t>(before),
                    {TransferKind::suspended, TransferKind::plugged});
    EXPECT_EQ(kinds(all), expected);
    for (std::size_t i = 1; i < all.size(); ++i) EXPECT_LE(all[i - 1].time, all[i].time);
  }
}

TEST(SleepAwareSource, ASilentDeviceIsMarkedToo) {
  Machine machine;
  Replay replay = three();
  replay.stalls = {1};
  SleepAwareSource source(std::make_unique<ReplaySource>(std::move(replay)), AfterSleep::goes_on,
                          machine.watch());
  ASSERT_TRUE(source.read(std::nullopt).value());
  machine.asleep += 2s;
  source.wake();
  EXPECT_EQ(source.read(std::nullopt).value()->kind, TransferKind::suspended);
  EXPECT_EQ(source.read(std::nullopt).value()->kind, TransferKind::plugged);
  EXPECT_EQ(source.read(std::nullopt).value()->kind, TransferKind::hid_report);
}

TEST(SleepAwareSource, WhatWasPulledOutInTheSleepIsUnpluggedAlone) {
  Machine machine;
  Replay replay = three();
  replay.transfers[1].kind = TransferKind::unplugged;
  replay.transfers.pop_back();
  SleepAwareSource source(std::make_unique<ReplaySource>(std::move(replay)), AfterSleep::goes_on,
                          machine.watch());
  EXPECT_EQ(kinds(all_of(source, machine, 1)),
            (std::vector{TransferKind::hid_report, TransferKind::unplugged}));
}

TEST(SleepAwareSource, APeerIsSpokenToAnew) {
  Machine machine;
  int opened = 0;
  ReturningSource source([&]() -> Result<std::unique_ptr<ByteSource>> {
    if (++opened > 2) return failure(Fault::not_found, "no more");
    return std::make_unique<SleepAwareSource>(std::make_unique<ReplaySource>(three()),
                                              AfterSleep::is_opened_anew, machine.watch());
  });
  std::vector<Transfer> all;
  while (all.size() < 8) {
    if (all.size() == 2) machine.asleep += 2s;
    const auto read = source.read(std::nullopt);
    ASSERT_TRUE(read);
    if (*read) all.push_back(**read);
  }
  EXPECT_EQ(opened, 2);
  // What had come before anyone looked belongs to what was before.
  EXPECT_EQ(kinds(all),
            (std::vector{TransferKind::plugged, TransferKind::hid_report, TransferKind::hid_report,
                         TransferKind::suspended, TransferKind::plugged, TransferKind::hid_report,
                         TransferKind::hid_report, TransferKind::hid_report}));
}

}  // namespace
}  // namespace fude
