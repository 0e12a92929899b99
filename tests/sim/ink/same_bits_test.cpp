// One picture whatever it was computed with: instruction set, threads, tiles or dense, asleep or awake.
#include <gtest/gtest.h>

#include <iostream>

#include "tests/sim/ink/strokes.h"

namespace fude {
namespace {

// Fronts that cross many tiles, meet, dry and are wetted again; some ink reaches the edge of the sheet.
std::uint64_t performance(Ink& ink) {
  for (std::uint64_t i = 0; i < 12; ++i) {
    ink.apply(pour_disc({.strength = {1, 0.2F, 0, 0.3F}, .contact_s = 0.1F}, 2 + 1.3 * static_cast<double>(i),
                        9, 1.2, i));
    step(ink, 5);
  }
  step(ink, 150);
  ink.apply(pour_disc({.strength = {0, 1, 0, 0}, .contact_s = 0.3F}, 9, 11, 2, 20));
  step(ink, 150);
  return ink.hash();
}

constexpr double side_mm = 18;

std::unique_ptr<Ink> quick_drying(const std::function<void(InkSetup&)>& change = {}) {
  return sheet(side_mm, [&](InkSetup& setup) {
    setup.paper.evaporation = 0.02;
    if (change) change(setup);
  });
}

TEST(SameBits, OverInstructionSets) {
  const std::uint64_t want =
      performance(*quick_drying([](InkSetup& s) { s.instruction_set = InstructionSet::sse2; }));
  for (InstructionSet set : {InstructionSet::avx2, InstructionSet::avx512}) {
    if (!processor_has(set)) {
      std::cout << "this processor has no " << name_of(set) << "\n";
      continue;
    }
    EXPECT_EQ(performance(*quick_drying([&](InkSetup& s) { s.instruction_set = set; })), want)
        << name_of(set);
  }
}

TEST(SameBits, OverThreads) {
  const std::uint64_t want = performance(*quick_drying());
  for (int threads : {2, 3})
    EXPECT_EQ(performance(*quick_drying([&](InkSetup& s) { s.threads = threads; })), want);
}

TEST(SameBits, TilesThatWakeAndSleepAgainstADenseSheet) {
  const auto tiled = quick_drying();
  const auto dense = quick_drying([](InkSetup& s) { s.dense = true; });
  EXPECT_EQ(performance(*tiled), performance(*dense));
  const std::size_t while_wet = tiled->active_cells();
  EXPECT_LT(while_wet, dense->active_cells());
  for (int i = 0; i < 40; ++i) {
    step(*tiled, 25);
    step(*dense, 25);
    ASSERT_EQ(tiled->hash(), dense->hash()) << i;
  }
  EXPECT_LT(tiled->active_cells(), while_wet);
  EXPECT_NEAR(tiled->totals().water_evaporated, dense->totals().water_evaporated, 1e-9);
}

TEST(SameBits, AfterGoingBackToASnapshot) {
  const auto ink = quick_drying();
  performance(*ink);
  const InkSnapshot then = ink->snapshot();
  const std::uint64_t hash_then = ink->hash();
  const auto go_on = [&] {
    ink->apply(pour_disc({}, 4, 4, 2, 30));
    step(*ink, 100);
    return ink->hash();
  };
  const std::uint64_t once = go_on();
  const InkTotals totals = ink->totals();
  ink->restore(then);
  EXPECT_EQ(ink->hash(), hash_then);
  EXPECT_EQ(go_on(), once);
  EXPECT_EQ(ink->totals().water_evaporated, totals.water_evaporated);
  EXPECT_EQ(ink->totals().pigment_deposited, totals.pigment_deposited);
  EXPECT_EQ(ink->collect().size(), 14U);
}

TEST(SameBits, OnlyTheSeedChangesThePaper) {
  const std::uint64_t want = performance(*quick_drying());
  EXPECT_EQ(performance(*quick_drying([](InkSetup& s) { s.seed = 1; })), want);
  EXPECT_NE(performance(*quick_drying([](InkSetup& s) { s.seed = 2; })), want);
}

}  // namespace
}  // namespace fude
