// The rules of one cell, straight from the kernel text.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/ink/kernels/lang_cpp.h"
#include "sim/ink/lattice_numbers.h"

namespace fude {
namespace {

// clang-format off
#include "sim/ink/kernels/numeric.k"
#include "sim/ink/kernels/site.k"
#include "sim/ink/kernels/link.k"
#include "sim/ink/kernels/dry.k"
#include "sim/ink/kernels/deposit.k"
// clang-format on

LatticeNumbers numbers(void (*change)(PaperSpec&) = nullptr) {
  PaperSpec paper;
  if (change != nullptr) change(paper);
  return lattice_numbers(paper, 0.1);
}

Site site(const LatticeNumbers& k, float water, float pigment, float glue, float grain = 0.2F,
          float fixed_ink = 0) {
  return site_of(k, water, {pigment * water, 0, 0, glue * water}, fixed_ink, 0.3F, grain, 0.1F);
}

// Chu 3.8.3: the transfer is faster in a drier stroke and with more glue, and complete when it is dry.
TEST(Fixture, MeetsItsThreeConditions) {
  const LatticeNumbers k = numbers([](PaperSpec& p) {
    p.fix_base = 0;
    p.fix_dryness = 0.5;
    p.fix_glue = 0.4;
  });
  const auto share = [&](float water, float glue) {
    const float before = water + 0.001F;
    return fixed_share(k, before, reciprocal(before), water, glue);
  };
  EXPECT_GT(share(0.1F, 0), share(0.2F, 0));
  EXPECT_GT(share(0.2F, 0), share(0.4F, 0));
  EXPECT_EQ(share(0.6F, 0), 0);
  EXPECT_GT(share(0.4F, 0.5F), share(0.4F, 0));
  EXPECT_GT(share(0.6F, 1), 0);
  // All of the loss is fixed where the dryness is full.
  EXPECT_NEAR(share(0.001F, 0), 0.5F, 1e-4F);

  const Site before = site(k, 1.5e-4F, 0.7F, 0.1F);
  vec4 mass{0.3F, 0.2F, 0.1F, 0.05F};
  float surface = 0;
  vec4 surface_mass{};
  vec4 fixed{};
  float gone = 0;
  float keep, seep, water;
  dry_and_seep(k, before, 0.9e-4F, mass, surface, surface_mass, fixed, gone, keep, seep, water);
  EXPECT_EQ(water, 0);
  EXPECT_EQ(keep, 0);
  EXPECT_EQ(mass.x + mass.y + mass.z + mass.w, 0);
  EXPECT_EQ(fixed.x, 0.3F);
  EXPECT_NEAR(gone, 0.9e-4F, 1e-10F);
}

TEST(Fixture, WithoutDryingItIsTheBaseRate) {
  const LatticeNumbers k = numbers([](PaperSpec& p) { p.fix_base = 1.2; });
  EXPECT_NEAR(fixed_share(k, 0.3F, reciprocal(0.3F), 0.3F, 0), 0.01F, 1e-8F);
}

TEST(Seepage, FillsThePaperAndTakesItsShareOfThePigment) {
  const LatticeNumbers k = numbers([](PaperSpec& p) {
    p.evaporation = 0;
    p.fix_base = 0;
  });
  const Site here = site(k, 0.4F, 0.5F, 0);
  vec4 mass{0.2F, 0, 0, 0};
  float surface = 0.8F;
  vec4 surface_mass{0.4F, 0, 0, 0.08F};
  vec4 fixed{};
  float gone = 0;
  float keep, seep, water;
  dry_and_seep(k, here, 0.4F, mass, surface, surface_mass, fixed, gone, keep, seep, water);
  EXPECT_NEAR(seep, 0.6F, 1e-7F);
  EXPECT_NEAR(surface, 0.2F, 1e-7F);
  EXPECT_NEAR(water, 1, 1e-7F);
  EXPECT_NEAR(mass.x, 0.2F + 0.3F, 1e-6F);
  EXPECT_NEAR(surface_mass.x, 0.1F, 1e-6F);
  EXPECT_NEAR(mass.w, 0.06F, 1e-6F);
  EXPECT_EQ(gone, 0);
  // Full paper takes nothing; the last of the surface takes all of its pigment along.
  dry_and_seep(k, here, 1.3F, mass, surface, surface_mass, fixed, gone, keep, seep, water);
  EXPECT_EQ(seep, 0);
  dry_and_seep(k, here, 0.1F, mass, surface, surface_mass, fixed, gone, keep, seep, water);
  EXPECT_EQ(surface, 0);
  EXPECT_EQ(surface_mass.x, 0);
  EXPECT_EQ(surface_mass.w, 0);
}

TEST(Link, BothEndsTakeTheSameBitsWithOppositeSign) {
  const LatticeNumbers k = numbers();
  for (float water_there : {0.0F, 0.05F, 0.3F, 0.9F})
    for (float water_here : {0.0F, 0.1F, 0.7F}) {
      const Site here = site(k, water_here, 0.3F, 0.6F, 0.1F);
      const Site there = site(k, water_there, 0.8F, 0.1F, 0.4F);
      const Crossing in = crossing(k, here, there, here.head, there.head, k.pace_straight,
                                   0.01F + 0.1F * water_here, 0.1F * water_there);
      const Crossing out = crossing(k, there, here, there.head, here.head, k.pace_straight,
                                    0.1F * water_there, 0.01F + 0.1F * water_here);
      EXPECT_EQ(in.water, -out.water);
      EXPECT_EQ(in.mass.x, -out.mass.x);
      EXPECT_EQ(in.mass.w, -out.mass.w);
      EXPECT_EQ(in.edge, out.edge);
    }
}

// Equation 9 with every term: the ink and glue of the wet cell, the textures of the dry one.
TEST(Link, AFrontEntersADryCellAboveItsThreshold) {
  const LatticeNumbers k = numbers([](PaperSpec& p) {
    p.pin_base = 0.1;
    p.pin_fixed = 0.5;
    p.toe_glue = 0.4;
  });
  const Site dry = site(k, 0, 0, 0, 0.2F);  // grain 0.2, toe 0.1
  const auto opens = [&](float water, float glue, float fixed_ink, bool diagonal) {
    const Site wet = site(k, water, 0.5F, glue, 0, fixed_ink);
    const float head = diagonal ? wet.diagonal_head : wet.head;
    return crossing(k, wet, dry, head, diagonal ? dry.diagonal_head : dry.head, k.pace_straight, 0.1F, 0)
               .water < 0;
  };
  EXPECT_FALSE(opens(0.299F, 0, 0, false));
  EXPECT_TRUE(opens(0.301F, 0, 0, false));
  EXPECT_FALSE(opens(0.423F, 0, 0, true));
  EXPECT_TRUE(opens(0.426F, 0, 0, true));
  EXPECT_FALSE(opens(0.399F, 1, 0, false));  // glue: the pinning texture, 0.1 more
  EXPECT_TRUE(opens(0.401F, 1, 0, false));
  EXPECT_FALSE(opens(0.349F, 0.2F, 0, false));  // half of it, by the smoothstep
  EXPECT_TRUE(opens(0.351F, 0.2F, 0, false));
  EXPECT_FALSE(opens(0.399F, 0, 0.2F, false));  // ink in the paper
  EXPECT_TRUE(opens(0.401F, 0, 0.2F, false));
}

TEST(Link, GlueAndFixedInkBlockUpToFullyAndNoFurther) {
  const LatticeNumbers k = numbers([](PaperSpec& p) {
    p.block_glue = 0.5;
    p.block_fixed = 0.25;
  });
  EXPECT_NEAR(site(k, 0.5F, 0, 0).blocking, 0.3F, 1e-6F);
  EXPECT_NEAR(site(k, 0.5F, 0, 0.4F).blocking, 0.5F, 1e-6F);
  EXPECT_NEAR(site(k, 0.5F, 0, 0, 0, 0.8F).blocking, 0.5F, 1e-6F);
  EXPECT_EQ(site(k, 0.5F, 0, 7, 0, 9).blocking, 1);
}

TEST(Link, HindranceKeepsPigmentBackInSlowWater) {
  const LatticeNumbers k = numbers([](PaperSpec& p) {
    p.hindrance = 0.25;
    p.hindrance_speed = 1.2;
  });
  const Site here = site(k, 0.5F, 0.4F, 0);
  const auto share = [&](float difference) {
    const Crossing c =
        crossing(k, here, here, here.head, here.head, k.pace_straight, 0.1F, 0.1F + difference);
    return c.mass.x / (c.water * 0.4F);
  };
  // 1.2 mm/s is 0.1 cells a step, which sends 6/9 of that over a straight link; the gate is 0.7.
  EXPECT_NEAR(share(0.1F * 6 / 9 / 0.7F), 0.75F, 1e-4F);
  EXPECT_NEAR(share(0.05F * 6 / 9 / 0.7F), 0.375F, 1e-4F);
  EXPECT_EQ(share(1e-6F), 0);
}

TEST(Touch, LeavesAFilmByWetnessCoverAndReceptivity) {
  const LatticeNumbers k = numbers([](PaperSpec& p) {
    p.capacity = 0.05;
    p.film = 0.04;
    p.receptivity = 0.5;
    p.receptivity_floor = 0.1;
  });
  const auto given = [&](float water, float wetness, float fresh) {
    float surface = 0;
    vec4 mass{};
    float taken;
    vec4 taken_mass;
    touch(k, water, wetness, {0.5F, 0, 0, 0.25F}, fresh, 0, surface, mass, taken, taken_mass);
    EXPECT_EQ(taken, surface);
    EXPECT_NEAR(taken_mass.x, 0.5F * taken, 1e-7F);
    EXPECT_NEAR(mass.w, 0.25F * taken, 1e-7F);
    return taken;
  };
  EXPECT_NEAR(given(0, 1, 1), 0.8F, 1e-6F);
  EXPECT_NEAR(given(0, 0.5F, 0.25F), 0.1F, 1e-6F);
  EXPECT_NEAR(given(0.25F, 1, 1), 0.4F, 1e-6F);
  EXPECT_NEAR(given(0.9F, 1, 1), 0.08F, 1e-6F);
}

TEST(Touch, ExchangeBringsTheStandingWaterIntoBalanceFromBothSides) {
  const LatticeNumbers k = numbers([](PaperSpec& p) {
    p.capacity = 0.05;
    p.standing = 0.05;
    p.exchange = 2;
  });
  const auto after = [&](float surface, float wetness, float contact) {
    vec4 mass{surface * 0.6F, 0, 0, 0};
    const float before = surface;
    float taken;
    vec4 taken_mass;
    touch(k, 0, wetness, {1, 0, 0, 0}, 0, contact, surface, mass, taken, taken_mass);
    EXPECT_EQ(taken, surface - before);
    // What is given has the strength of the brush, what is lifted that of the paper.
    const float share = 1 - std::exp(-2 * contact);
    EXPECT_NEAR(taken_mass.x, wetness * share - 0.6F * before * share, 1e-5F);
    return surface;
  };
  EXPECT_NEAR(after(0, 1, 0.5F), 1 - std::exp(-1.0F), 1e-5F);
  EXPECT_NEAR(after(0, 1, 1e6F), 1, 1e-5F);
  EXPECT_NEAR(after(0.8F, 0, 0.5F), 0.8F * std::exp(-1.0F), 1e-5F);
  EXPECT_NEAR(after(0.8F, 0.25F, 1e6F), 0.25F, 1e-5F);
}

}  // namespace
}  // namespace fude
