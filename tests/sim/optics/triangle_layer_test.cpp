// The software triangles against areas and blends that are known exactly.
#include "sim/optics/triangle_layer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace fude {
namespace {

constexpr PixelBox box{0, 0, 40, 30};

TriangleLayer square(double low, double high, double depth, const Tint& tint) {
  TriangleLayer layer(box, 4);
  const Corner a{{low, low, depth}, tint};
  const Corner b{{high, low, depth}, tint};
  const Corner c{{high, high, depth}, tint};
  const Corner d{{low, high, depth}, tint};
  layer.add(a, b, c);
  layer.add(a, d, c);  // the other way round
  return layer;
}

double covered(const TintedImage& image) {
  double sum = 0;
  for (const Tint& pixel : image.pixels) sum += static_cast<double>(pixel[3]);
  return sum;
}

TEST(TriangleLayer, CoversItsArea) {
  TriangleLayer layer(box, 4);
  const Tint white(1, 1, 1, 1);
  layer.add({{3.2, 4.1, 1}, white}, {{31.7, 9.3, 1}, white}, {{12.4, 26.8, 1}, white});
  const double area = 0.5 * std::abs((31.7 - 3.2) * (26.8 - 4.1) - (12.4 - 3.2) * (9.3 - 4.1));
  EXPECT_NEAR(covered(blend(std::vector{layer})), area, 0.01 * area);
  EXPECT_NEAR(covered(blend(std::vector{square(5, 15, 1, white)})), 100, 1e-3);
}

TEST(TriangleLayer, BlendsByDepthInAnyOrder) {
  const TriangleLayer red = square(5, 15, 1, {1, 0, 0, 0.5F});
  const TriangleLayer green = square(5, 15, 2, {0, 1, 0, 0.5F});
  const TriangleLayer blue = square(5, 15, 3, {0, 0, 1, 0.5F});
  std::vector layers = {red, green, blue};
  const Tint there = blend(layers).at(10, 10);
  EXPECT_TRUE(there.isApprox(Tint(0.5F, 0.25F, 0.125F, 0.875F)));
  std::ranges::reverse(layers);
  EXPECT_TRUE(blend(layers).at(10, 10).isApprox(there));
}

TEST(TriangleLayer, LayersThatCrossChangePlaces) {
  TriangleLayer level(box, 2);
  TriangleLayer steep(box, 2);
  const Tint red(1, 0, 0, 1);
  const Tint blue(0, 0, 1, 1);
  level.add({{0, 0, 5}, red}, {{40, 0, 5}, red}, {{0, 30, 5}, red});
  steep.add({{0, 0, 0}, blue}, {{40, 0, 10}, blue}, {{0, 30, 0}, blue});
  const TintedImage image = blend(std::vector{level, steep});
  EXPECT_GT(image.at(5, 2)[2], 0.99F);
  EXPECT_GT(image.at(30, 2)[0], 0.99F);
}

TEST(TriangleLayer, OutlinesARimOfTheAskedWidth) {
  TriangleLayer layer = square(5, 25, 1, {1, 1, 1, 1});
  layer.outline(2, {0, 0, 0, 1});
  const TintedImage image = blend(std::vector{layer});
  double dark = 0;
  for (const Tint& pixel : image.pixels) dark += static_cast<double>(pixel[3] - pixel[0]);
  EXPECT_NEAR(dark, 20 * 20 - 16 * 16, 12);
  EXPECT_EQ(image.at(15, 15)[0], 1);
}

TEST(TriangleLayer, ClipsAndLeavesOutWhatIsNotFinite) {
  TriangleLayer layer(box, 2);
  const Tint white(1, 1, 1, 1);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  layer.add({{nan, 0, 0}, white}, {{10, 0, 0}, white}, {{0, 10, 0}, white});
  EXPECT_EQ(covered(blend(std::vector{layer})), 0);
  layer.add({{-1e9, -1e9, 0}, white}, {{1e9, -1e9, 0}, white}, {{0, 1e9, 0}, white});
  EXPECT_NEAR(covered(blend(std::vector{layer})), 40 * 30, 1e-2);
  const std::vector<Corner> corners = {{{-5, 3.5, 0}, white}, {{7.2, 100, 0}, white}};
  EXPECT_EQ(box_around(corners, 1, box), (PixelBox{0, 2, 9, 28}));
}

}  // namespace
}  // namespace fude
