#include "rig/ink_thread.h"

#include <gtest/gtest.h>

#include <chrono>
#include <stdexcept>
#include <thread>

#include "rig/snapshot_memory.h"
#include "sim/ink/tile_layout.h"

namespace fude {
namespace {

InkSetup small_sheet() {
  InkSetup setup;
  setup.width_mm = setup.height_mm = 6.4;
  setup.threads = 2;
  return setup;
}

InkEvent drop(std::uint64_t id) {
  Deposit deposit;
  deposit.map = {2, 2, 0.1, 4, 4, {}, {}, {}};
  deposit.map.fresh.assign(16, 1.0F);
  deposit.map.contact_s.assign(16, 1.0F);
  deposit.map.patch.assign(16, 0);
  deposit.patches = {{1, {0.5F, 0, 0, 0}}};
  return {.at = {}, .id = id, .what = std::move(deposit)};
}

TEST(InkThread, IsTheSameInkAsOneThatIsWaitedFor) {
  const auto alone = open_ink(small_sheet()).value();
  InkThread thread(open_ink(small_sheet()).value());
  std::vector<Exchange> expected;
  for (std::uint64_t i = 1; i <= 40; ++i) {
    alone->apply(drop(i));
    alone->step();
    for (Exchange& e : alone->collect()) expected.push_back(std::move(e));
    thread.post([i](Ink& ink) { ink.apply(drop(i)); });
    thread.step();
  }
  EXPECT_EQ(thread.caught_up().hash(), alone->hash());
  EXPECT_EQ(thread.behind(), 0);
  EXPECT_EQ(thread.step_ms().size(), 40U);
  EXPECT_TRUE(thread.step_ms().empty());
  const std::vector<Exchange> answers = thread.answers();
  ASSERT_EQ(answers.size(), expected.size());
  for (std::size_t i = 0; i < answers.size(); ++i) {
    EXPECT_EQ(answers[i].event, expected[i].event);
    EXPECT_EQ(answers[i].patches[0].water_ul, expected[i].patches[0].water_ul);
  }
}

TEST(InkThread, AnswersOrSaysThatNothingWillCome) {
  InkThread thread(open_ink(small_sheet()).value());
  EXPECT_TRUE(thread.wait_for_answers().empty());
  thread.post([](Ink& ink) { ink.apply(drop(7)); });
  const std::vector<Exchange> answers = thread.wait_for_answers();
  ASSERT_EQ(answers.size(), 1U);
  EXPECT_EQ(answers[0].event, 7U);
}

TEST(InkThread, DoesWhatItWasAskedForBeforeItEnds) {
  int done = 0;
  {
    InkThread thread(open_ink(small_sheet()).value());
    for (int i = 0; i < 100; ++i) thread.step();
    thread.post([&done](const Ink& ink) { done = static_cast<int>(ink.steps()); });
  }
  EXPECT_EQ(done, 100);
}

TEST(InkThread, ThrowsWhatTheInkThrew) {
  InkThread thread(open_ink(small_sheet()).value());
  thread.post([](Ink&) { throw std::runtime_error("the card has gone"); });
  EXPECT_THROW(thread.caught_up(), std::runtime_error);
  EXPECT_THROW(thread.step(), std::runtime_error);
  EXPECT_THROW(thread.answers(), std::runtime_error);
}

TEST(SnapshotMemory, ChangesNothingButWhereASnapshotLies) {
  const auto ink = open_ink(small_sheet()).value();
  ink->apply(drop(1));
  ink->step();
  const InkSnapshot fresh = ink->snapshot();

  SnapshotMemory memory;
  EXPECT_TRUE(memory.take().tiles.empty());
  memory.prepare(3 * tile::cells);
  InkSnapshot used;
  while (used.tiles.empty()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    used = memory.take();
  }
  used.tiles[0].planes.assign(used.tiles[0].planes.size(), 9.0F);
  used.steps = 99;
  const InkSnapshot again = ink->snapshot(std::move(used));
  ASSERT_EQ(again.tiles.size(), fresh.tiles.size());
  EXPECT_EQ(again.steps, fresh.steps);
  for (std::size_t i = 0; i < fresh.tiles.size(); ++i) {
    EXPECT_EQ(again.tiles[i].wet, fresh.tiles[i].wet);
    EXPECT_EQ(again.tiles[i].planes, fresh.tiles[i].planes);
  }
}

}  // namespace
}  // namespace fude
