// The brush over the paper, drawn: what the projections promise, and what is seen in the pictures.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "rig/brush_view/brush_picture.h"
#include "rig/brush_view/posed_brush.h"
#include "rig/brush_view/projection.h"
#include "rig/brush_view/tuft_look.h"
#include "rig/share_folder.h"

namespace fude {
namespace {

constexpr LoadBrush ink{0.8F, {1.2F, 0, 0, 0.4F}};
constexpr PixelBox window{0, 0, 400, 300};
const Palette sumi{{pigments()[0]}, xuan_reflectance};

BrushSpec quick_brush() {
  BrushSpec spec;
  spec.tuft_length_mm = 24;
  spec.longest_step_s = 0.004;
  return spec;
}

TEST(BrushProjection, FindsThePaperUnderAPixelAgain) {
  for (const Projection& projection :
       {oblique(7, {30, 250}, {0, 0.25}), perspective({-10, -60, 50}, {5, 3, 10}, 900, {200, 150})}) {
    const Eigen::Vector2d there(12.5, 7);
    const Eigen::Vector3d seen = projection({there.x(), there.y(), 0});
    EXPECT_LT((projection.on_paper(seen.head<2>()) - there).norm(), 1e-9);
    // What stands higher there is nearer to the eye.
    EXPECT_LT(projection({there.x(), there.y(), 5}).z(), seen.z());
    EXPECT_LT(projection({there.x(), there.y(), 5}).y(), seen.y());
  }
  const Projection eye = perspective({0, -60, 50}, {0, 0, 10}, 900, {200, 150});
  EXPECT_LT((eye({0, 0, 10}).head<2>() - Eigen::Vector2d(200, 150)).norm(), 1e-9);
}

// The middle of what a few layers cover.
Eigen::Vector2d middle_of(const TintedImage& image) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double weight = 0;
  for (int row = 0; row < image.box.rows; ++row)
    for (int column = 0; column < image.box.columns; ++column) {
      const auto share = static_cast<double>(image.at(column, row)[3]);
      sum += share * Eigen::Vector2d(image.box.left + column, image.box.top + row);
      weight += share;
    }
  return sum / weight;
}

SeenTuft hanging(double z) {
  const Tuft tuft = make_tuft(quick_brush());
  return {surface_of(tuft, rest_state(tuft).x, handle_pose({25, 20, z}, 0, 0, 0)), {}};
}

TEST(TuftLook, TheShadowFallsFartherFromAHigherTuft) {
  const Projection projection = oblique(7, {30, 250}, {0, 0.25});
  const auto shadow = [&](double z) {
    const std::vector tufts = {hanging(z)};
    return middle_of(blend(shadow_layers(tufts, projection, window, 2)));
  };
  // The lamp's direction, in pixels: to the right and downwards.
  const Eigen::Vector2d by = shadow(38) - shadow(26);
  EXPECT_NEAR(by.x(), 7 * 12 * shadow_per_mm.x(), 1);
  EXPECT_NEAR(by.y(), -7 * 12 * shadow_per_mm.y(), 1);
}

TEST(TuftLook, IsOpaqueAsAskedAndOutlined) {
  const Projection projection = oblique(7, {30, 250}, {0, 0.25});
  const std::vector tufts = {hanging(26)};
  for (const TuftLook look : {TuftLook::shaded, TuftLook::colours, TuftLook::outline}) {
    const TintedImage image = blend(tuft_layers(tufts, look, 0.7, sumi, projection, window, 2));
    int body = 0;
    int rim = 0;
    for (const Tint& pixel : image.pixels) {
      if (look == TuftLook::outline ? pixel[3] == 0 : std::abs(pixel[3] - 0.7F) < 1e-3F) ++body;
      if (pixel[3] > 0.8F) ++rim;
    }
    EXPECT_GT(body, 500);
    EXPECT_GT(rim, 60);
  }
  EXPECT_TRUE(tuft_layers(tufts, TuftLook::off, 0.7, sumi, projection, window, 2).empty());
}

TEST(TuftLook, TuftsThatCrossBlendWhateverTheirOrder) {
  const Projection projection = oblique(7, {30, 250}, {0, 0.25});
  std::vector tufts = {hanging(26), hanging(30)};
  for (Station& s : tufts[1].surface) s.centre += Eigen::Vector3d(3, 2, 0);
  const TintedImage one = blend(tuft_layers(tufts, TuftLook::shaded, 0.6, sumi, projection, window, 2));
  std::swap(tufts[0], tufts[1]);
  const TintedImage other = blend(tuft_layers(tufts, TuftLook::shaded, 0.6, sumi, projection, window, 2));
  ASSERT_EQ(one.box, other.box);
  float most = 0;
  int through_both = 0;
  for (std::size_t i = 0; i < one.pixels.size(); ++i) {
    most = std::max(most, (one.pixels[i] - other.pixels[i]).abs().maxCoeff());
    if (std::abs(one.pixels[i][3] - 0.84F) < 1e-3F) ++through_both;  // 1 − 0.4²
  }
  EXPECT_LT(most, 1e-5F);
  EXPECT_GT(through_both, 300);
}

TEST(PosedBrush, ComesDownAndLeavesItsFootprint) {
  const auto posed = lead_to(quick_brush(), handle_pose({10, 5, 15}, 0.3, 0, 0), ink);
  ASSERT_TRUE(posed);
  EXPECT_EQ(posed->unconverged, 0);
  EXPECT_NEAR(posed->brush.state().paper_from_handle.translation.z(), 15, 1e-9);
  EXPECT_GT(posed->mark.area_mm2(), 10);
  // The tip lies in what it left.
  const Eigen::Vector3d tip = posed->brush.shape().front().spine.back();
  EXPECT_GT(posed->mark.at(tip.head<2>() + Eigen::Vector2d(1.5, 0)), 0.5);
  EXPECT_EQ(posed->mark.at({200, 5}), 0);
  EXPECT_FALSE(
      lead_to(quick_brush(), handle_pose({0, 0, std::numeric_limits<double>::infinity()}, 0, 0, 0), ink));
  EXPECT_FALSE(lead_to(quick_brush(), handle_pose({5000, 0, 10}, 0, 0, 0), ink));
}

TEST(BrushPicture, ShowsTheFootprintThroughTheHair) {
  auto posed = lead_to(quick_brush(), handle_pose({0, 0, 13}, 0.3, 0, 0), ink);
  ASSERT_TRUE(posed);
  PictureWish wish;
  wish.width = 240;
  wish.height = 180;
  const Picture marked = picture_of(*posed, wish);
  PosedBrush clean = *posed;
  std::ranges::fill(clean.mark.covered, 0.0F);
  const Picture unmarked = picture_of(clean, wish);
  wish.look = TuftLook::off;
  const Picture bare = picture_of(*posed, wish);
  int darker_through_hair = 0;
  for (std::size_t i = 0; i < marked.pixels.size(); ++i)
    if (bare.pixels[i] != marked.pixels[i] && marked.pixels[i][0] + 1000 < unmarked.pixels[i][0])
      ++darker_through_hair;
  EXPECT_GT(darker_through_hair, 100);
  const Picture sheet = contact_sheet(std::vector{marked, bare, marked, bare});
  EXPECT_EQ(sheet.width, 720);
  EXPECT_EQ(sheet.height, 360);
  EXPECT_TRUE(std::ranges::equal(sheet.row(180).subspan(0, 240), bare.row(0)));
}

TEST(SharedNames, ListEveryBrushOnceWithWhatItIs) {
  const auto names = shared_names("brushes", ".toml");
  EXPECT_EQ(std::ranges::count(names, "round-goat"), 1);
  for (const std::string& name : names) {
    const auto path = find_shared("brushes", name, ".toml");
    ASSERT_TRUE(path);
    EXPECT_FALSE(first_remark(*path).empty()) << name << " begins with a line that says what it is";
  }
}

}  // namespace
}  // namespace fude
