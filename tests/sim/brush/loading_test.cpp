#include "sim/brush/loading.h"

#include <gtest/gtest.h>

#include <random>
#include <stdexcept>

namespace fude {
namespace {

struct Total {
  double water = 0;
  double pigment = 0;
};

Total total(const Loading& loading) {
  Total sum;
  for (const LoadedPatch& patch : loading.patches) {
    sum.water += patch.water_ul;
    sum.pigment += patch.pigment_ul[0];
  }
  return sum;
}

Loading full_loading() {
  Loading loading = dry_loading(make_tuft(BrushSpec{}));
  fill(loading, 1, {0.8F, 0.1F, 0, 0.2F});
  return loading;
}

TEST(Loading, FullTuftHoldsItsCapacity) {
  const Loading loading = full_loading();
  EXPECT_NEAR(total(loading).water, BrushSpec{}.capacity_ul, 1e-9);
  EXPECT_NEAR(total(loading).pigment, 0.8 * BrushSpec{}.capacity_ul, 1e-5);
  for (const InkLoad& load : offered(loading)) {
    EXPECT_FLOAT_EQ(load.wetness, 1);
    EXPECT_FLOAT_EQ(load.strength[0], 0.8F);
    EXPECT_FLOAT_EQ(load.strength[glue_channel], 0.2F);
  }
}

TEST(Loading, BooksEveryExchange) {
  Loading loading = full_loading();
  const Total before = total(loading);
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> amount(-0.02, 0.05);
  Total taken;
  for (int i = 0; i < 100; ++i) {
    Exchange exchange;
    exchange.patches.resize(patch_count);
    for (PatchExchange& patch : exchange.patches) {
      taken.water += patch.water_ul = amount(random);
      taken.pigment += patch.pigment_ul[0] = amount(random);
    }
    book(loading, exchange);
    even_out(loading, 2, 0.01);
  }
  EXPECT_NEAR(before.water - total(loading).water, taken.water, 1e-9);
  EXPECT_NEAR(before.pigment - total(loading).pigment, taken.pigment, 1e-9);
}

TEST(Loading, EndlessTuftDoesNotChange) {
  Loading loading = full_loading();
  loading.endless = true;
  Exchange exchange;
  exchange.patches.resize(patch_count, {1, {1, 1, 1, 1}});
  book(loading, exchange);
  EXPECT_NEAR(total(loading).water, BrushSpec{}.capacity_ul, 1e-9);
}

TEST(Loading, MoistureEvensOutAtItsRate) {
  // One row of the tuft is dry: it fills from its neighbours, the totals stay, nothing overshoots.
  const auto driest_after = [](int steps, double step_s) {
    Loading loading = full_loading();
    for (int j = 0; j < patches_around; ++j) {
      LoadedPatch& patch = loading.patches[static_cast<std::size_t>(3 * patches_around + j)];
      patch.water_ul = 0;
      patch.pigment_ul.fill(0);
    }
    const Total before = total(loading);
    double last = 0;
    for (int i = 0; i < steps; ++i) {
      even_out(loading, 1, step_s);
      const LoadedPatch& dry = loading.patches[3 * patches_around];
      EXPECT_GE(dry.water_ul / dry.capacity_ul, last - 1e-12);
      last = dry.water_ul / dry.capacity_ul;
    }
    EXPECT_NEAR(total(loading).water, before.water, 1e-9);
    EXPECT_NEAR(total(loading).pigment, before.pigment, 1e-9);
    return last;
  };
  const double coarse = driest_after(50, 0.01);
  EXPECT_GT(coarse, 0.3);
  EXPECT_LT(coarse, 1);
  EXPECT_NEAR(driest_after(500, 0.001), coarse, 0.02);  // a rate per second, not per step
}

TEST(Loading, DebtIsKeptAndOffersNothing) {
  Loading loading = dry_loading(make_tuft(BrushSpec{}));
  Exchange exchange;
  exchange.patches.resize(1, {0.5, {0.1, 0, 0, 0}});
  book(loading, exchange);
  EXPECT_EQ(loading.patches[0].water_ul, -0.5);
  EXPECT_EQ(offered(loading)[0].wetness, 0);
}

TEST(Loading, RefusesAnExchangeOfAnotherTuft) {
  Loading loading = full_loading();
  Exchange exchange;
  exchange.patches.resize(patch_count + 1);
  EXPECT_THROW(book(loading, exchange), std::invalid_argument);
}

TEST(Loading, PatchesCoverTheTuft) {
  EXPECT_EQ(patch_at(0, 0), 0);
  EXPECT_EQ(patch_at(1, 0), (patches_along - 1) * patches_around);
  EXPECT_EQ(patch_at(0, 0.999), patches_around - 1);
  EXPECT_EQ(patch_at(0, -0.001), patches_around - 1);
  EXPECT_EQ(patch_at(0, 1.001), 0);
}

}  // namespace
}  // namespace fude
