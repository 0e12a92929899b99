// A brush that goes to the wells, the cloth and the rim beside the paper.
#include <gtest/gtest.h>

#include <cmath>

#include "rig/paint_box.h"
#include "rig/painting.h"
#include "tests/rig/gesture.h"

namespace fude {
namespace {

PaintBox plum() { return find_paint_box("plum").value(); }

// The brush over (x, y), its tip `deep_mm` below the plane of the paper.
class Hand {
 public:
  explicit Hand(const LoadBrush& load) : painting_(Painting::open(setup_for(load)).value()) {}

  void stay(double x_mm, double y_mm, double deep_mm, double seconds) {
    for (double left = seconds; left > -1e-9; left -= 0.005, t_ += 0.005) {
      BrushInput input;
      input.time.host = Timestamp(Duration(static_cast<std::int64_t>(t_ * 1e9)));
      input.origin = PoseOrigin::measured;
      input.paper_from_handle.translation = {x_mm, y_mm, length_ - deep_mm};
      painting_.advance_to(static_cast<Step>(t_ / painting_.step_s()));
      painting_.move(PenEnd::tip, input);
    }
  }
  const Loading& loading() const { return painting_.brush(PenEnd::tip).state().loading; }
  InkTotals totals() { return painting_.ink().totals(); }
  double strength_at(int row, std::size_t channel) const {
    const LoadedPatch& patch = loading().patches[static_cast<std::size_t>(row * patches_around)];
    return patch.pigment_ul[channel] / patch.water_ul;
  }

 private:
  PaintingSetup setup_for(const LoadBrush& load) {
    PaintingSetup setup = gesture::settings().painting;
    setup.ink.width_mm = setup.ink.height_mm = gesture::sheet_mm;
    setup.load = load;
    setup.spots = plum().spots;
    length_ = setup.brush.tuft_length_mm;
    return setup;
  }
  double length_ = 0;
  Painting painting_;
  double t_ = 0;
};

TEST(Palette, AGestureIntoAWellDipsAsDeepAsTheBrushGoes) {
  Hand hand({0.8F, {}});
  hand.stay(-13, 36, 8, 0.5);
  EXPECT_GT(hand.strength_at(patches_along - 1, 1), 1.2);
  EXPECT_LT(hand.strength_at(patches_along / 4, 1), 0.01);
  EXPECT_EQ(hand.totals().water_deposited, 0);
}

TEST(Palette, AWellHoldsTheTipAtItsFloor) {
  Hand deep({0.8F, {}});
  deep.stay(-13, 19, 25, 0.5);  // the ink is 6 mm deep
  EXPECT_GT(deep.strength_at(patches_along - 1, 0), 0.9);
  EXPECT_LT(deep.strength_at(patches_along / 2, 0), 0.05);
}

TEST(Palette, OverAWellTheBrushTakesNothingUp) {
  Hand hand({0.8F, {}});
  hand.stay(-13, 36, -3, 0.5);
  EXPECT_EQ(hand.strength_at(patches_along - 1, 1), 0);
}

TEST(Palette, WaterRinsesTheClothDriesAndTheRimWipes) {
  Hand hand({0.9F, {1, 0, 0, 0}});
  hand.stay(-13, 55, 30, 1.5);
  EXPECT_LT(hand.strength_at(patches_along - 1, 0), 0.01);
  const double full = wetness(hand.loading());
  EXPECT_GT(full, 0.9);
  hand.stay(-13 + 8, 55, 10, 0.05);
  const double wiped = wetness(hand.loading());
  EXPECT_NEAR(wiped, 0.6, 0.01);
  hand.stay(-13, 4, 12, 0.5);
  EXPECT_LT(wetness(hand.loading()), wiped - 0.02);
}

TEST(Palette, WhatIsWrongIsNamedByItsLine) {
  const std::string head = "name = 'a'\npigments = ['sumi']\n";
  for (const char* spot :
       {"[[well]]\nat_mm = [1, 2]\nradius_mm = 3\n", "[[rim]]\nat_mm = [1, 2]\nradius_mm = 3\n",
        "[[cloth]]\nat_mm = [1]\nradius_mm = 3\n", "[[cloth]]\nat_mm = [1, 2]\nradius_mm = nan\n",
        "[[well]]\nat_mm = [1, 2]\nradius_mm = 3\ndepth_mm = 5\nink = {rose = 1}\n"}) {
    const auto box = read_paint_box(head + spot, "x.toml");
    ASSERT_FALSE(box) << spot;
    EXPECT_NE(box.error().message.find("x.toml: line 3"), std::string::npos) << box.error().message;
  }
  EXPECT_FALSE(read_paint_box("name = 'a'\n", "x.toml"));
  const auto unknown = read_paint_box("pigments = ['mud']\n", "x.toml");
  ASSERT_FALSE(unknown);
  EXPECT_NE(unknown.error().message.find("sumi"), std::string::npos);
}

}  // namespace
}  // namespace fude
