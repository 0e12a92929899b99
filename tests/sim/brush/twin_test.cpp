// The twin finds the parameters of a brush that is known, from its marks.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>

#include "sim/brush/twin_fit.h"
#include "tests/sim/brush/twin_gestures.h"

namespace fude {
namespace {

// Four segments and long steps: what is asked is whether the fit finds them, not how fine the brush is.
BrushSpec quick_brush() {
  BrushSpec spec;
  spec.segments = 4;
  spec.tuft_length_mm = 22;
  spec.longest_step_s = 0.01;
  return spec;
}

// As a picture has it: pixels of another size than the twin's cells, turned edges, each a little wrong.
Mark pictured(const Mark& mark, double pixel_mm, double noise, unsigned seed) {
  Mark picture;
  picture.cell_mm = pixel_mm;
  picture.left_mm = mark.left_mm - 3.37;
  picture.bottom_mm = mark.bottom_mm - 2.81;
  picture.columns = static_cast<int>((mark.columns * mark.cell_mm + 6) / pixel_mm);
  picture.rows = static_cast<int>((mark.rows * mark.cell_mm + 6) / pixel_mm);
  std::mt19937 dice(seed);
  std::normal_distribution<double> wrong(0, noise);
  for (int r = 0; r < picture.rows; ++r)
    for (int c = 0; c < picture.columns; ++c) {
      const double cover =
          mark.at({picture.left_mm + (c + 0.5) * pixel_mm, picture.bottom_mm + (r + 0.5) * pixel_mm});
      picture.covered.push_back(static_cast<float>(std::clamp(cover + wrong(dice), 0.0, 1.0)));
    }
  return picture;
}

TEST(BlurredView, DiffersSmoothlyHoweverFarApart) {
  FootprintMap map;
  map.cell_mm = 0.1;
  map.columns = map.rows = 40;
  map.fresh.assign(1600, 1);
  Mark square;
  square.add(map);
  EXPECT_NEAR(square.area_mm2(), 16, 1e-9);
  const BlurredView view(square, 3);
  const Eigen::VectorXd seen = view.of(square);
  double before = 0;
  for (double shift = 0.1; shift < 2; shift += 0.1) {
    Mark moved = square;
    moved.left_mm += shift;
    const double apart = (view.of(moved) - seen).norm();
    EXPECT_GT(apart, before);
    before = apart;
    // Two of the four edges have moved; edges along the grid seem π/4 as long as they are.
    EXPECT_NEAR(edge_distance_mm(square, moved), shift / 2 * 4 / std::numbers::pi, 0.03 + 0.02 * shift);
  }
}

TEST(TwinTrial, MarksAreTheSameWhateverTheScaleOfAllForces) {
  const BrushSpec spec = quick_brush();
  const NamedHand hand = twin_gestures(spec.tuft_length_mm, 100)[1];
  const TwinMark one = perform(spec, hand.hand);
  const TwinMark ten = perform(stiffened(spec, 10), hand.hand);
  EXPECT_LT(edge_distance_mm(one.mark, ten.mark), 0.02);
  double most = 0;
  for (std::size_t i = 0; i < hand.hand.size(); ++i) most = std::max(most, one.force_mn[i]);
  for (std::size_t i = 0; i < hand.hand.size(); ++i)
    EXPECT_NEAR(ten.force_mn[i], 10 * one.force_mn[i], 0.3 * most);
}

// Some ten seconds: the fit performs six gestures about eighty times.
TEST(TwinFit, FindsTheParametersOfAnotherBrush) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "skipped: takes minutes under a sanitizer";
#endif
  const BrushSpec known = quick_brush();
  BrushSpec real = known;
  real.stretch_stiffness *= 1.35;
  real.stiffness_fall *= 0.9;
  real.spread_bend *= 0.8;
  real.friction_along *= 1.3;
  real.friction_across *= 0.75;
  real.plasticity_rad *= 1.4;
  real = stiffened(real, 2.5);
  std::vector<TwinTrial> trials;
  unsigned seed = 1;
  for (NamedHand& named : twin_gestures(known.tuft_length_mm, 100)) {
    const TwinMark made = perform(real, named.hand, 0.04);
    for (std::size_t i = 0; i < named.hand.size(); i += 5) named.hand[i].force_mn = made.force_mn[i];
    trials.push_back({named.name, std::move(named.hand), pictured(made.mark, 0.13, 0.1, seed++)});
  }
  const TwinFit fit = fit_twin(known, trials, 1, {});
  double worst = 0;
  for (int i = 0; i < twin_parameter_count; ++i) {
    const TwinParameter& row = twin_parameters()[static_cast<std::size_t>(i)];
    double truth = real.*row.member;
    double found = fit.spec.*row.member;
    if (row.id == "stretch_stiffness") {
      truth /= real.bend_stiffness;
      found /= fit.spec.bend_stiffness;
    }
    std::printf("figure: twin %s %+.2f %% off, standard error %.2f %%, shown by %.2f mm, singular %.2f\n",
                std::string(row.id).c_str(), 100 * (found / truth - 1), 100 * fit.standard_error[i],
                fit.shown_mm[i], fit.singular_mm[i]);
    EXPECT_NEAR(found / truth, 1, 0.05) << row.id;
    worst = std::max(worst, std::abs(found / truth - 1));
  }
  ASSERT_TRUE(fit.force);
  std::printf("figure: twin force %+.2f %% off; edges %.3f mm from %.3f; %d gestures simulated\n",
              100 * (fit.spec.bend_stiffness / real.bend_stiffness - 1),
              *std::max_element(fit.edge_mm.begin(), fit.edge_mm.end()), fit.started_mm, fit.simulated);
  EXPECT_NEAR(fit.spec.bend_stiffness / real.bend_stiffness, 1, 0.05);
  EXPECT_LT(fit.force->rms_share, 0.1);
}

}  // namespace
}  // namespace fude
