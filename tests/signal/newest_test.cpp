#include "signal/newest.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <thread>

namespace fude {
namespace {

TEST(Newest, IsWhatWasPutLast) {
  Newest<int> newest;
  EXPECT_EQ(newest.look(), 0);
  newest.put(1);
  EXPECT_EQ(newest.look(), 1);
  EXPECT_EQ(newest.look(), 1);
  for (int i = 2; i < 9; ++i) newest.put(i);
  EXPECT_EQ(newest.look(), 8);
  newest.put(9);
  EXPECT_EQ(newest.look(), 9);
}

// Never half of one and half of another, never an older one after a newer, and the last one in the end.
TEST(Newest, IsWholeAndNeverGoesBackBetweenThreads) {
  constexpr std::uint64_t last = 200'000;
  using Value = std::array<std::uint64_t, 40>;
  Newest<Value> newest;
  std::atomic<bool> done{false};
  std::thread putting([&] {
    Value value;
    for (std::uint64_t i = 1; i <= last; ++i) {
      value.fill(i);
      newest.put(value);
    }
    done = true;
  });
  std::uint64_t before = 0;
  bool whole = true, forward = true;
  while (before != last) {
    const bool was_done = done;
    const Value& value = newest.look();
    for (const std::uint64_t part : value) whole = whole && part == value.front();
    forward = forward && value.front() >= before;
    before = value.front();
    if (was_done) break;
  }
  putting.join();
  EXPECT_TRUE(whole);
  EXPECT_TRUE(forward);
  EXPECT_EQ(before, last);
}

}  // namespace
}  // namespace fude
