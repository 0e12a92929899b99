// What was poured is on the paper or has evaporated; nothing else happens to it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/sim/ink/strokes.h"

namespace fude {
namespace {

void expect_balance(const InkTotals& t, double share) {
  EXPECT_NEAR(t.water_evaporated + t.water_left, t.water_deposited, share * t.water_deposited);
  for (std::size_t c = 0; c < concentrations_per_group; ++c)
    EXPECT_NEAR(t.pigment_surface[c] + t.pigment_flow[c] + t.pigment_fixed[c], t.pigment_deposited[c],
                share * t.pigment_deposited[c])
        << c;
}

TEST(Balance, HoldsFromTheFirstDropUntilThePaperIsDry) {
  const auto ink = sheet(25);
  for (std::uint64_t i = 0; i < 30; ++i) {
    const double x = 6 + 0.4 * static_cast<double>(i);
    ink->apply(pour_disc({.strength = {1, 0.3F, 0.05F, 0.2F}, .contact_s = 0.02F}, x, 12, 1.5, i));
    step(*ink, 3);
    expect_balance(ink->totals(), 1e-5);
  }
  EXPECT_GT(ink->totals().water_left, 0.5 * ink->totals().water_deposited);
  int steps = 0;
  for (; !ink->still(); ++steps) {
    ASSERT_LT(steps, 40000);
    ink->step();
  }
  EXPECT_GT(steps, 1000);
  const InkTotals dry = ink->totals();
  expect_balance(dry, 2e-5);
  EXPECT_EQ(dry.water_left, 0);
  for (std::size_t c = 0; c < concentrations_per_group; ++c) {
    EXPECT_GT(dry.pigment_fixed[c], 0);
    EXPECT_EQ(dry.pigment_flow[c], 0);
    EXPECT_EQ(dry.pigment_surface[c], 0);
  }
  // A dry sheet falls asleep.
  step(*ink, 64);
  EXPECT_EQ(ink->active_cells(), 0U);
}

TEST(Balance, HoldsWithoutEvaporationOverThousandsOfSteps) {
  const auto ink = sheet(10, [](InkSetup& setup) {
    setup.paper.evaporation = 0;
    setup.paper.edge_evaporation = 0;
    setup.paper.fix_base = 0;
  });
  ink->apply(pour_disc({.strength = {1, 0.5F, 0, 0.1F}}, 5, 5, 2));
  step(*ink, 5000);
  const InkTotals t = ink->totals();
  expect_balance(t, 1e-5);
  // Fronts that stop short of the threshold of dryness lose a little all the same.
  EXPECT_LT(t.water_evaporated, 0.02 * t.water_deposited);
}

TEST(Balance, HoldsAtTheEdgeOfTheSheetAndWhatFallsOffStaysOnTheBrush) {
  const auto ink = sheet(10);
  ink->apply(pour_disc({}, 0, 5, 3));
  ink->apply(pour_disc({}, 10.01, 10.01, 2, 2));
  ink->apply(pour_disc({}, -20, 5, 2, 3));
  step(*ink, 600);
  expect_balance(ink->totals(), 1e-5);
  const std::vector<Exchange> taken = ink->collect();
  ASSERT_EQ(taken.size(), 3U);
  EXPECT_EQ(taken[0].event, 1U);
  const double whole = PaperSpec{}.film * 9 * 3.14159265;
  EXPECT_NEAR(taken[0].patches[0].water_ul, 0.5 * whole, 0.01 * whole);
  EXPECT_EQ(taken[2].patches[0].water_ul, 0);
  EXPECT_TRUE(ink->collect().empty());
}

TEST(Balance, DryingTheSheetFixesEverything) {
  const auto ink = sheet(10);
  ink->apply(pour_disc({.strength = {1, 0.2F, 0, 0}, .contact_s = 1}, 5, 5, 2));
  step(*ink, 20);
  ink->apply({Duration{}, 2, DryPaper{}});
  EXPECT_TRUE(ink->still());
  const InkTotals t = ink->totals();
  expect_balance(t, 1e-6);
  EXPECT_EQ(t.water_left, 0);
  EXPECT_EQ(t.pigment_flow[0] + t.pigment_surface[0], 0);
}

TEST(Balance, ConstantConcentrationStaysConstant) {
  const auto ink = sheet(16, [](InkSetup& setup) {
    setup.paper.evaporation = 0;
    setup.paper.edge_evaporation = 0;
    setup.paper.fix_base = 0;
    setup.paper.hindrance = 0;
    setup.paper.hindrance_speed = 0;
    setup.paper.fix_dryness = 0;
    setup.paper.fix_glue = 0;
    setup.paper.pin_texture = 0.2;
  });
  ink->apply(pour_disc({.strength = {0.25F, 0, 0, 0}}, 8, 8, 3));
  step(*ink, 400);
  const InkRegion region = ink->read({0, 0, ink->columns(), ink->rows()});
  int wet = 0;
  for (std::size_t i = 0; i < region.pigment.size(); ++i) {
    const float water = region.flow_water[i] + region.surface_water[i];
    if (water < 0.05F) continue;
    ++wet;
    EXPECT_NEAR(region.pigment[i][0] / (water * static_cast<float>(PaperSpec{}.capacity)), 0.25F, 2e-4F);
  }
  EXPECT_GT(wet, 3000);
}

}  // namespace
}  // namespace fude
