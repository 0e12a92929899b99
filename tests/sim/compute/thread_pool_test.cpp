#include "sim/compute/thread_pool.h"

#include <gtest/gtest.h>

#include <atomic>
#include <vector>

namespace fude {
namespace {

TEST(ThreadPool, CallsEveryIndexOnceForAnyNumberOfThreads) {
  for (int threads : {1, 2, 5}) {
    ThreadPool pool(threads);
    EXPECT_EQ(pool.threads(), threads);
    std::vector<std::atomic<int>> calls(1000);
    for (int round = 0; round < 200; ++round) pool.for_each(calls.size(), [&](std::size_t i) { ++calls[i]; });
    for (const auto& count : calls) EXPECT_EQ(count, 200);
  }
}

TEST(ThreadPool, WhatOneRoundWroteTheNextReads) {
  ThreadPool pool(3);
  std::vector<long> from(500, 1);
  std::vector<long> to(500);
  for (int round = 0; round < 100; ++round) {
    pool.for_each(from.size(), [&](std::size_t i) { to[i] = from[i] + from[(i + 1) % from.size()]; });
    std::swap(from, to);
    for (long& x : from) x %= 1000003;
  }
  for (long x : from) EXPECT_EQ(x, from[0]);
}

TEST(ThreadPool, RefusesToHaveNoThread) { EXPECT_THROW(ThreadPool(0), std::invalid_argument); }

}  // namespace
}  // namespace fude
