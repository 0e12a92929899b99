#include "sim/brush/dipping.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

namespace fude {
namespace {

const Tuft& goat() {
  static const Tuft tuft = make_tuft(BrushSpec{});
  return tuft;
}

Loading clear_water() {
  Loading loading = dry_loading(goat());
  fill(loading, 1, {});
  return loading;
}

const LoadedPatch& at(const Loading& loading, int along, int around) {
  return loading.patches[static_cast<std::size_t>(along * patches_around + around)];
}
double strength(const LoadedPatch& part, std::size_t channel = 0) {
  return part.pigment_ul[channel] / part.water_ul;
}
double pigment(const Loading& loading) {
  double sum = 0;
  for (const LoadedPatch& patch : loading.patches) sum += patch.pigment_ul[0];
  for (const LoadedPatch& row : loading.inside) sum += row.pigment_ul[0];
  return sum;
}

TEST(Grade, GoesFromStopToStopInAStraightLine) {
  Loading loading = dry_loading(goat());
  const GradeBrush ramps{{{0.25F, 0.5F, {0, 0, 0, 0.1F}}, {0.75F, 1, {1, 0, 0, 0.1F}}}, {}};
  grade(loading, ramps, {});
  for (int i = 0; i < patches_along; ++i) {
    const double along = (i + 0.5) / patches_along;
    const double t = std::clamp((along - 0.25) / 0.5, 0.0, 1.0);
    for (int j = 0; j < patches_around; ++j) {
      EXPECT_NEAR(at(loading, i, j).water_ul / at(loading, i, j).capacity_ul, 0.5 + 0.5 * t, 1e-7);
      EXPECT_NEAR(strength(at(loading, i, j)), t, 1e-7);
      EXPECT_NEAR(strength(at(loading, i, j), glue_channel), 0.1, 1e-7);
    }
    EXPECT_NEAR(strength(loading.inside[static_cast<std::size_t>(i)]), t, 1e-7);
  }
}

TEST(Grade, GoesAcrossFromOneSideToTheOther) {
  Loading loading = dry_loading(goat());
  const GradeBrush ramps{{{0, 1, {1, 0, 0, 0}}}, {{0, 1, {0, 1, 0, 0}}}};
  grade(loading, ramps, {});
  for (int j = 0; j < patches_around; ++j) {
    const double across = std::cos(2 * std::acos(-1) * (j + 0.5) / patches_around);
    EXPECT_NEAR(strength(at(loading, 5, j), 0), 0.5 + 0.5 * across, 1e-6);
    EXPECT_NEAR(strength(at(loading, 5, j), 1), 0.5 - 0.5 * across, 1e-6);
  }
  // A tuft that stands in the far third of its brush has the far third of the ramp.
  grade(loading, ramps, {-1, -1.0 / 3});
  EXPECT_NEAR(strength(loading.inside[3], 1), 5.0 / 6, 1e-6);
}

TEST(Dip, GoesAsDeepAsTheBrushDoes) {
  Loading loading = clear_water();
  const HairFlow flow = flow_in(goat());
  tend(loading, goat(), flow, DipBrush{8, 0.5F, {1, 0, 0, 0}}, {});
  // 8 mm are the last four of sixteen rows of 2 mm.
  EXPECT_GT(strength(at(loading, 15, 0)), 0.8);
  EXPECT_GT(strength(at(loading, 12, 0)), 0.7);
  EXPECT_LT(strength(at(loading, 9, 0)), 0.05);
  EXPECT_LT(strength(at(loading, 2, 0)), 1e-3);
}

TEST(Dip, NearsTheWellAtItsRateWhateverTheParts) {
  // Without flow in the hair each immersed part nears the well by itself: 1 - exp(-rate t).
  const HairFlow still{};
  for (const double seconds : {0.01, 0.1, 0.5}) {
    Loading loading = dry_loading(goat());
    Immersion half;
    half.patches.fill(1);
    steep(loading, still, half, {0.8F, 0, 0, 0}, 6, seconds);
    const LoadedPatch& patch = at(loading, 7, 3);
    EXPECT_NEAR(patch.water_ul / patch.capacity_ul, 1 - std::exp(-6 * seconds), 1e-9);
    EXPECT_NEAR(strength(patch), 0.8, 1e-6);
    EXPECT_EQ(loading.inside[7].water_ul, 0);
  }
}

TEST(Dip, ADryBrushSoaksTheInkUpTheHair) {
  Loading loading = dry_loading(goat());
  const HairFlow flow = flow_in(goat());
  tend(loading, goat(), flow, DipBrush{8, 2, {1, 0, 0, 0}}, {});
  const LoadedPatch& above = at(loading, 9, 0);
  EXPECT_GT(above.water_ul, 0);
  EXPECT_NEAR(strength(above), 1, 1e-6);
  EXPECT_LT(above.water_ul / above.capacity_ul, at(loading, 14, 0).water_ul / at(loading, 14, 0).capacity_ul);
}

TEST(Rinse, WashesTheInkOut) {
  Loading loading = dry_loading(goat());
  fill(loading, 1, {1, 0, 0, 0.1F});
  const double before = pigment(loading);
  tend(loading, goat(), flow_in(goat()), RinseBrush{1}, {});
  EXPECT_LT(pigment(loading), 1e-4 * before);
  EXPECT_NEAR(wetness(loading), 1, 1e-6);
}

TEST(Wipe, TakesOffWhatIsAboveAndNoMore) {
  Loading loading = dry_loading(goat());
  grade(loading, {{{0, 0.2F, {1, 0, 0, 0}}, {1, 1, {1, 0, 0, 0}}}, {}}, {});
  const double before = pigment(loading);
  const Loading was = loading;
  const PatchExchange taken = wipe(loading, 0.5);
  EXPECT_NEAR(before - pigment(loading), taken.pigment_ul[0], 1e-12 * before);
  EXPECT_EQ(at(loading, 0, 0).water_ul, at(was, 0, 0).water_ul);
  EXPECT_NEAR(at(loading, 15, 0).water_ul, 0.5 * at(loading, 15, 0).capacity_ul, 1e-12);
  EXPECT_NEAR(strength(at(loading, 15, 0)), 1, 1e-12);
}

TEST(Blot, DriesTheSideThatTouches) {
  Loading loading = dry_loading(goat());
  fill(loading, 1, {1, 0, 0, 0});
  const double before = pigment(loading);
  const PatchExchange taken = blot(loading, flow_in(goat()), facing(0.0), 6, 0.3);
  EXPECT_LT(at(loading, 8, 0).water_ul, 0.7 * at(loading, 8, patches_around / 2).water_ul);
  EXPECT_GT(taken.water_ul, 0);
  EXPECT_NEAR(before - pigment(loading), taken.pigment_ul[0], 1e-12 * before);
}

TEST(Roll, BringsTheSidesTogetherAndKeepsTheTotals) {
  Loading loading = dry_loading(goat());
  grade(loading, {{{0, 1, {1, 0, 0, 0}}}, {{0, 0.4F, {0, 1, 0, 0}}}}, {});
  const double before = pigment(loading);
  const double apart = at(loading, 5, 0).pigment_ul[0] - at(loading, 5, 8).pigment_ul[0];
  roll(loading, 1);
  EXPECT_NEAR(at(loading, 5, 0).pigment_ul[0] - at(loading, 5, 8).pigment_ul[0], apart / 3, 1e-9 * apart);
  roll(loading, 30);
  EXPECT_NEAR(at(loading, 5, 0).pigment_ul[0], at(loading, 5, 8).pigment_ul[0], 1e-9 * apart);
  EXPECT_NEAR(pigment(loading), before, 1e-12 * before);
}

}  // namespace
}  // namespace fude
