#include "sim/brush/loading.h"

#include <gtest/gtest.h>

#include <deque>
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

TEST(Loading, WhatIsOfferedIsSetAsideUntilThePaperAnswers) {
  Loading loading = full_loading();
  const Total before = total(loading);
  PerPatch demand{};
  demand[9] = 0.3;
  demand[62] = 0.1;
  std::vector<InkLoad> loads;
  for (int i = 0; i < 3; ++i) loads = draw(loading, 2, 0.01, demand);
  ASSERT_EQ(loading.set_aside.size(), 3U);
  Total aside;
  for (const Withdrawal& w : loading.set_aside)
    for (const PatchExchange& patch : w) {
      aside.water += patch.water_ul;
      aside.pigment += patch.pigment_ul[0];
    }
  EXPECT_NEAR(total(loading).water + aside.water, before.water, 1e-9);
  EXPECT_NEAR(total(loading).pigment + aside.pigment, before.pigment, 1e-9);
  EXPECT_NEAR(loading.set_aside.back()[9].water_ul, 0.3 * static_cast<double>(loads[9].wetness), 1e-6);

  // The paper refuses some of the first, takes more than was meant of the second, none of the third.
  Exchange exchange;
  exchange.patches.resize(patch_count);
  exchange.patches[9] = {0.12, {0.1, 0, 0, 0}};
  book(loading, exchange);
  exchange.patches[9] = {0.5, {0.4, 0, 0, 0}};
  book(loading, exchange);
  book(loading, {});
  EXPECT_TRUE(loading.set_aside.empty());
  EXPECT_NEAR(total(loading).water, before.water - 0.62, 1e-9);
  EXPECT_NEAR(total(loading).pigment, before.pigment - 0.5, 1e-9);
}

// The tip holds less than the paper takes of it while its answer is on the way.
struct Supply {
  std::vector<double> wetness;  // offered, frame by frame
  double water_ul = 0;          // in all
};
Supply supply_of_the_tip(double rate_hz) {
  constexpr double seconds = 0.4;
  constexpr double answer_s = 0.03;
  Loading loading = full_loading();
  constexpr std::size_t tip = patch_count - 1;
  PerPatch demand{};
  demand[tip] = 30 / rate_hz;
  Supply supply;
  const int late = static_cast<int>(answer_s * rate_hz);
  std::deque<Exchange> answers;
  for (int i = 0; i < seconds * rate_hz; ++i) {
    if (static_cast<int>(answers.size()) == late) {
      book(loading, answers.front());
      answers.pop_front();
    }
    supply.wetness.push_back(static_cast<double>(draw(loading, 6, 1 / rate_hz, demand)[tip].wetness));
    Exchange answer;
    answer.patches.resize(patch_count);
    answer.patches[tip].water_ul = demand[tip] * supply.wetness.back();
    supply.water_ul += answer.patches[tip].water_ul;
    answers.push_back(answer);
  }
  return supply;
}

TEST(Loading, ATipThatEmptiesFasterThanAnswersComeRunsEvenly) {
  const Supply supply = supply_of_the_tip(200);
  for (std::size_t i = 5; i < supply.wetness.size(); ++i) {
    EXPECT_LE(supply.wetness[i], supply.wetness[i - 1] + 1e-6) << i;
    EXPECT_GT(supply.wetness[i], 0.98 * supply.wetness[i - 1]) << i;
  }
  EXPECT_GT(supply.wetness.back(), 0.1);
}

TEST(Loading, SupplyDoesNotDependOnTheSampleRate) {
  const double finest = supply_of_the_tip(1000).water_ul;
  EXPECT_NEAR(supply_of_the_tip(100).water_ul, finest, 0.02 * finest);
  EXPECT_NEAR(supply_of_the_tip(250).water_ul, finest, 0.02 * finest);
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
