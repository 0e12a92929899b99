#include "sim/brush/loading.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <deque>
#include <numbers>
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
  const auto add = [&](const LoadedPatch& part) {
    sum.water += part.water_ul;
    sum.pigment += part.pigment_ul[0];
  };
  std::ranges::for_each(loading.patches, add);
  std::ranges::for_each(loading.inside, add);
  return sum;
}

HairFlow flow_at(double moisture_per_s) {
  HairFlow flow = flow_in(make_tuft(BrushSpec{}));
  flow.moisture_per_s = moisture_per_s;
  return flow;
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
    even_out(loading, flow_at(2), 0.01);
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
    const auto empty = [](LoadedPatch& part) { part.water_ul = 0, part.pigment_ul.fill(0); };
    for (int j = 0; j < patches_around; ++j)
      empty(loading.patches[static_cast<std::size_t>(3 * patches_around + j)]);
    empty(loading.inside[3]);
    const Total before = total(loading);
    double last = 0;
    for (int i = 0; i < steps; ++i) {
      even_out(loading, flow_at(1), step_s);
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

// Pigment in hair that is evenly wet moves as dM/dt = A M with A symmetric in the strengths: the exact answer
// is by its eigenvalues.
Eigen::MatrixXd spreading(const Loading& loading, const HairFlow& flow) {
  constexpr int parts = patch_count + patches_along;
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(parts, parts);
  const auto water = [&](int k) {
    return k < patch_count ? loading.patches[static_cast<std::size_t>(k)].water_ul
                           : loading.inside[static_cast<std::size_t>(k - patch_count)].water_ul;
  };
  const auto link = [&](int k, int l, double per_s) {
    const double g = per_s * std::min(water(k), water(l));
    a(k, k) -= g / water(k), a(l, k) += g / water(k);
    a(l, l) -= g / water(l), a(k, l) += g / water(l);
  };
  for (int i = 0; i < patches_along; ++i) {
    const auto row = static_cast<std::size_t>(i);
    const auto at = [](int along, int around) { return along * patches_around + around % patches_around; };
    for (int j = 0; j < patches_around; ++j) {
      link(at(i, j), at(i, j + 1), flow.around_per_s[row]);
      link(at(i, j), patch_count + i, flow.inward_pigment_per_s[row]);
      if (i + 1 < patches_along) link(at(i, j), at(i + 1, j), flow.along_per_s);
    }
    if (i + 1 < patches_along) link(patch_count + i, patch_count + i + 1, flow.along_per_s);
  }
  return a;
}

Eigen::VectorXd pigment_of(const Loading& loading) {
  Eigen::VectorXd m(patch_count + patches_along);
  for (int k = 0; k < patch_count; ++k) m[k] = loading.patches[static_cast<std::size_t>(k)].pigment_ul[0];
  for (int i = 0; i < patches_along; ++i)
    m[patch_count + i] = loading.inside[static_cast<std::size_t>(i)].pigment_ul[0];
  return m;
}

// A full tuft of clear water with ink in one quarter of its surface near the tip.
Loading stained() {
  Loading loading = dry_loading(make_tuft(BrushSpec{}));
  fill(loading, 1, {});
  for (int i = 10; i < 14; ++i)
    for (int j = 2; j < 6; ++j) {
      LoadedPatch& patch = loading.patches[static_cast<std::size_t>(i * patches_around + j)];
      patch.pigment_ul[0] = patch.water_ul;
    }
  return loading;
}

TEST(Loading, PigmentSpreadsAsTheLinearSystemDoes) {
  Loading loading = stained();
  HairFlow flow = flow_in(make_tuft(BrushSpec{}));
  flow.around_per_s.fill(0.3);
  flow.inward_pigment_per_s.fill(0.2);
  flow.along_per_s = 0.1;
  constexpr double seconds = 2;
  Eigen::VectorXd root(patch_count + patches_along);  // of the water: over it the system is symmetric
  for (int k = 0; k < patch_count; ++k)
    root[k] = std::sqrt(loading.patches[static_cast<std::size_t>(k)].water_ul);
  for (int i = 0; i < patches_along; ++i)
    root[patch_count + i] = std::sqrt(loading.inside[static_cast<std::size_t>(i)].water_ul);
  const Eigen::MatrixXd a = root.cwiseInverse().asDiagonal() * spreading(loading, flow) * root.asDiagonal();
  ASSERT_LT((a - a.transpose()).cwiseAbs().maxCoeff(), 1e-12);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(a);
  const Eigen::VectorXd parts = modes.eigenvectors().transpose() * pigment_of(loading).cwiseQuotient(root);
  const Eigen::VectorXd grown = (modes.eigenvalues().array() * seconds).exp() * parts.array();
  const Eigen::VectorXd exact = (modes.eigenvectors() * grown).cwiseProduct(root);
  const auto error_at = [&](int steps) {
    Loading stepped = loading;
    for (int k = 0; k < steps; ++k) even_out(stepped, flow, seconds / steps);
    return (pigment_of(stepped) - exact).cwiseAbs().maxCoeff() / exact.maxCoeff();
  };
  const double at_100_hz = error_at(200);
  const double at_1_khz = error_at(2000);
  std::printf(
      "figure: pigment in the tuft after 2 s, error over its largest: %.1e at 100 Hz, %.1e at 1 kHz\n",
      at_100_hz, at_1_khz);
  EXPECT_LT(at_100_hz, 5e-3);
  EXPECT_NEAR(at_1_khz, at_100_hz, 5e-4);
}

TEST(Loading, SideAndSideEvenOutAtTheMoistureRate) {
  // The slowest wave around the ring falls off as exp(-rate t), whatever the frame; nothing soaks inwards.
  HairFlow flow = flow_at(1.5);
  flow.inward_per_s = 0;
  for (const double hz : {50.0, 100.0, 1000.0}) {
    Loading loading = dry_loading(make_tuft(BrushSpec{}));
    const auto wave = [](int j) { return std::cos(2 * std::numbers::pi * j / patches_around); };
    for (int k = 0; k < patch_count; ++k) {
      LoadedPatch& patch = loading.patches[static_cast<std::size_t>(k)];
      patch.water_ul = patch.capacity_ul * (0.5 + 0.4 * wave(k % patches_around));
    }
    const int steps = static_cast<int>(0.8 * hz);
    for (int k = 0; k < steps; ++k) even_out(loading, flow, 1 / hz);
    double left = 0;
    for (int j = 0; j < patches_around; ++j) {
      const LoadedPatch& patch = loading.patches[static_cast<std::size_t>(j)];
      left += 2.0 / patches_around * wave(j) * patch.water_ul / patch.capacity_ul;
    }
    EXPECT_NEAR(left, 0.4 * std::exp(-1.5 * 0.8), 0.01 * 0.4) << hz;
  }
}

TEST(Loading, SurfaceAndInsideNearEachOtherExactly) {
  HairFlow flow = flow_at(0);
  flow.inward_per_s = 8;
  for (const int steps : {1, 10, 100}) {
    Loading loading = dry_loading(make_tuft(BrushSpec{}));
    for (LoadedPatch& patch : loading.patches) patch.water_ul = patch.capacity_ul;
    for (int k = 0; k < steps; ++k) even_out(loading, flow, 0.1 / steps);
    const LoadedPatch& side = loading.patches[0];
    const LoadedPatch& inside = loading.inside[0];
    EXPECT_NEAR(side.water_ul / side.capacity_ul - inside.water_ul / inside.capacity_ul, std::exp(-0.8),
                1e-9);
  }
}

TEST(Loading, KeepsItsTotalsOverAHundredThousandSteps) {
  Loading loading = full_loading();
  for (int k = 0; k < patch_count; k += 3) loading.patches[static_cast<std::size_t>(k)].water_ul *= 0.2;
  for (int k = 0; k < patch_count; k += 7) loading.patches[static_cast<std::size_t>(k)].pigment_ul[0] = 0;
  const Total before = total(loading);
  const HairFlow flow = flow_at(1.5);
  // An uneven frame, and a stir now and then, so that there is always something to move.
  for (int k = 0; k < 100'000; ++k) {
    if (k % 100 == 0) {
      std::swap(loading.patches[40].water_ul, loading.patches[200].water_ul);
      std::swap(loading.patches[40].pigment_ul, loading.patches[200].pigment_ul);
    }
    even_out(loading, flow, k % 2 == 0 ? 1e-4 : 3e-4);
  }
  const Total after = total(loading);
  std::printf("figure: totals of the tuft after 100000 steps: water %.1e, pigment %.1e relative\n",
              after.water / before.water - 1, after.pigment / before.pigment - 1);
  EXPECT_NEAR(after.water, before.water, 1e-12 * before.water);
  EXPECT_NEAR(after.pigment, before.pigment, 1e-12 * before.pigment);
}

TEST(Loading, EverythingMixesInTheEnd) {
  Loading loading = stained();
  HairFlow flow = flow_in(make_tuft(BrushSpec{}));
  flow.along_per_s = 2;
  const Total mixed = total(loading);
  for (int k = 0; k < 1000; ++k) even_out(loading, flow, 1);
  for (const LoadedPatch& patch : loading.patches)
    EXPECT_NEAR(patch.pigment_ul[0] / patch.water_ul, mixed.pigment / mixed.water, 1e-6);
  for (const LoadedPatch& row : loading.inside)
    EXPECT_NEAR(row.pigment_ul[0] / row.water_ul, mixed.pigment / mixed.water, 1e-6);
}

TEST(Loading, NothingSpreadsInDryHairAndNothingTurnsNegative) {
  Loading loading = stained();
  for (LoadedPatch& patch : loading.patches) patch.water_ul = 0;
  for (LoadedPatch& row : loading.inside) row.water_ul = 0;
  const Eigen::VectorXd before = pigment_of(loading);
  even_out(loading, flow_at(1.5), 1);
  EXPECT_EQ(pigment_of(loading), before);

  loading = stained();
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (LoadedPatch& patch : loading.patches) patch.water_ul *= std::pow(uniform(random), 6);
  for (int k = 0; k < 200; ++k) {
    even_out(loading, flow_at(50), 0.3 * uniform(random));
    for (const LoadedPatch& patch : loading.patches) {
      ASSERT_GE(patch.water_ul, 0);
      ASSERT_GE(patch.pigment_ul[0], 0);
    }
  }
}

TEST(Loading, WhatIsOfferedIsSetAsideUntilThePaperAnswers) {
  Loading loading = full_loading();
  const Total before = total(loading);
  PerPatch demand{};
  demand[9] = 0.3;
  demand[62] = 0.1;
  std::vector<InkLoad> loads;
  for (int i = 0; i < 3; ++i) loads = draw(loading, flow_at(2), 0.01, demand);
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
    supply.wetness.push_back(
        static_cast<double>(draw(loading, flow_at(6), 1 / rate_hz, demand)[tip].wetness));
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
