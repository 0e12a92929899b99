#include "sim/compute/arena.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <set>

namespace fude {
namespace {

TEST(Arena, HandsOutDistinctAlignedZeroBlocksAndTakesThemBack) {
  Arena arena(48, 4);
  std::set<float*> blocks;
  for (int i = 0; i < 10; ++i) {
    float* block = arena.take();
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(block) % 64, 0U);
    for (int k = 0; k < 48; ++k) EXPECT_EQ(block[k], 0);
    EXPECT_TRUE(blocks.insert(block).second);
  }
  const std::size_t bytes = arena.bytes();
  for (float* block : blocks) arena.give_back(block);
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(blocks.contains(arena.take()));
  EXPECT_EQ(arena.bytes(), bytes);
}

TEST(Arena, RefusesBlocksThatSplitCacheLines) { EXPECT_THROW(Arena(17, 4), std::invalid_argument); }

}  // namespace
}  // namespace fude
