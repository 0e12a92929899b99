#include "sim/brush/hair_texture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>
#include <span>
#include <vector>

#include "sim/brush/loading.h"
#include "tests/sim/brush/gesture.h"

namespace fude {
namespace {

// Mean of what leaves ink over a band of the tuft.
double inked_share(const HairTexture& hair, float from, float to, float reach, float opening,
                   float shift = 0) {
  double sum = 0;
  int count = 0;
  for (float along = from; along < to; along += 0.005F)
    for (float around = 0; around < 1; around += 0.0005F, ++count)
      sum += static_cast<double>(hair.inked(along, around, reach, opening, shift));
  return sum / count;
}

// What a gesture newly covers, cell by cell.
class Film {
 public:
  Film(Brush& brush, const Gesture& gesture) : share_(side * side) {
    for (double t = 0; t < gesture.seconds; t += 0.004) {
      const BrushFrame frame = brush.move(input_at(t, gesture.pose(t)));
      if (frame.deposit) add(frame.deposit->map);
    }
  }
  static double x_mm(std::size_t column) { return (static_cast<double>(column) + 0.5) * cell - middle; }
  float at(std::size_t column, std::size_t row) const { return share_[row * side + column]; }
  // Over 3 × 3 cells.
  double near(double x, double y) const {
    const auto column = static_cast<std::size_t>((x + middle) / cell);
    const auto row = static_cast<std::size_t>((y + middle) / cell);
    double sum = 0;
    for (std::size_t r = row - 1; r <= row + 1; ++r)
      for (std::size_t c = column - 1; c <= column + 1; ++c) sum += static_cast<double>(at(c, r));
    return sum / 9;
  }
  static constexpr std::size_t side = 2000;

 private:
  static constexpr double cell = 0.05;
  static constexpr double middle = 50;
  void add(const FootprintMap& map) {
    const auto left = static_cast<std::size_t>(std::lround((map.left_mm + middle) / cell));
    const auto bottom = static_cast<std::size_t>(std::lround((map.bottom_mm + middle) / cell));
    std::size_t i = 0;
    for (std::size_t r = 0; r < static_cast<std::size_t>(map.rows); ++r)
      for (std::size_t c = 0; c < static_cast<std::size_t>(map.columns); ++c)
        share_[(bottom + r) * side + left + c] += map.fresh[i++];
  }
  std::vector<float> share_;
};

// Pressed by `depth` and drawn 40 mm towards `heading`.
Gesture drawn(double heading, double depth) {
  return {1, [=](double t) {
            const double way = 40 * ease((t - 0.2) / 0.8);
            return leaning(way * std::cos(heading), way * std::sin(heading), 33 - depth * ease(t / 0.2), 0.2,
                           heading);
          }};
}

TEST(HairTexture, LeavesInkInTheShareOfItsBristlesThatReach) {
  const HairTexture hair(BrushSpec{}, 3);
  for (const float reach : {0.1F, 0.3F, 0.6F, 0.9F})
    EXPECT_NEAR(inked_share(hair, 0, 1, reach, 0), static_cast<double>(reach), 0.06) << reach;
  EXPECT_EQ(inked_share(hair, 0, 1, 1, 0), 1);
  EXPECT_EQ(inked_share(hair, 0, 1, 0, 0), 0);
}

TEST(HairTexture, PressureBringsBristlesToThePaper) {
  const HairTexture hair(BrushSpec{}, 3);
  double last = 0;
  for (const double press : {0.0, 3.0, 10.0, 40.0}) {
    const auto reach = static_cast<double>(hair.reach(0.15F, press));
    EXPECT_GT(reach, last) << press;
    EXPECT_LT(reach, 1) << press;
    last = reach;
  }
  EXPECT_GT(last, 1.4 * static_cast<double>(hair.reach(0.15F, 0)));
  EXPECT_EQ(hair.reach(0, 40), 0);
  EXPECT_EQ(hair.reach(0.45F, 0), 1);
}

TEST(HairTexture, SplitsOpenAsTheTuftSpreadsAndDriesAndCloseInASoakedTip) {
  const HairTexture hair(BrushSpec{}, 3);
  EXPECT_EQ(hair.opening(0.3F, 0), 0);
  EXPECT_EQ(hair.opening(1, 2), 0);
  EXPECT_LT(hair.opening(0.6F, 0.7), hair.opening(0.3F, 0.7));
  EXPECT_LT(hair.opening(0.3F, 0.3), hair.opening(0.3F, 0.7));
  double last = 1;
  for (const float opening : {0.2F, 0.4F, 0.8F}) {
    const double inked = inked_share(hair, 0.85F, 1, 1, opening);
    EXPECT_LT(inked, last) << opening;
    EXPECT_GT(inked, 0.2) << opening;
    last = inked;
  }
  // Towards the root hair holds together; excess ink moves that hold down to the tip.
  EXPECT_EQ(inked_share(hair, 0, 0.15F, 1, 0.8F), 1);
  double closed = last;
  for (const float wet : {0.5F, 0.7F, 1.0F}) {
    const double inked = inked_share(hair, 0.85F, 1, 1, 0.8F, hair.split_shift(wet));
    EXPECT_GE(inked, closed) << wet;
    closed = inked;
  }
  EXPECT_GT(closed, last + 0.05);
  EXPECT_EQ(hair.split_shift(0.4F), 0);
}

TEST(HairTexture, StreaksFollowTheStroke) {
  for (const double heading : {0.5, 2.4}) {
    Brush brush(BrushSpec{}, 5);
    brush.load(0.15F, {1, 0, 0, 0});
    const Film film(brush, drawn(heading, 12));
    // Streaks run where the film a millimetre on is most alike.
    double least = 1e300;
    double most_alike = 0;
    for (double turned = -1.5; turned < 1.55; turned += 0.05) {
      const double dx = std::cos(heading + turned);
      const double dy = std::sin(heading + turned);
      double change = 0;
      for (double way = 10; way < 24; way += 0.1)
        for (double off = -0.8; off < 0.8; off += 0.1) {
          const double x = way * std::cos(heading) - off * std::sin(heading);
          const double y = way * std::sin(heading) + off * std::cos(heading);
          change += std::abs(film.near(x + dx, y + dy) - film.near(x, y));
        }
      if (change >= least) continue;
      least = change;
      most_alike = turned;
    }
    std::printf("figure: streaks of a stroke towards %.0f deg run %.1f deg off it\n",
                heading * 180 / std::numbers::pi, most_alike * 180 / std::numbers::pi);
    EXPECT_LT(std::abs(most_alike), 0.08) << heading;
    EXPECT_GT(least, 0);
  }
}

// Ridges a millimetre apart.
class Ridges : public PaperGrain {
 public:
  static bool hill(double x_mm) { return x_mm - std::floor(x_mm) < 0.5; }
  void heights(double left_mm, double /*y_mm*/, double spacing_mm, std::span<float> row) override {
    for (std::size_t i = 0; i < row.size(); ++i)
      row[i] = hill(left_mm + static_cast<double>(i) * spacing_mm) ? 0.9F : 0.1F;
  }
};

TEST(HairTexture, DryHairTouchesOnlyTheHillsOfThePaper) {
  const auto hills_over_hollows = [](float wetness) {
    Brush brush(BrushSpec{}, 5);
    brush.paint_over(std::make_shared<Ridges>());
    brush.load(wetness, {1, 0, 0, 0});
    double hills = 0;
    double hollows = 0;
    const Film film(brush, drawn(0, 10));
    for (std::size_t row = 0; row < Film::side; ++row)
      for (std::size_t column = 0; column < Film::side; ++column)
        (Ridges::hill(Film::x_mm(column)) ? hills : hollows) += static_cast<double>(film.at(column, row));
    return hollows / hills;
  };
  EXPECT_NEAR(hills_over_hollows(1), 1, 0.05);
  EXPECT_LT(hills_over_hollows(0.05F), 0.2);
}

TEST(HairTexture, NamesNoPatchBeyondTheTuft) {
  for (const float wetness : {1.0F, 0.1F}) {
    Brush brush(BrushSpec{}, 5);
    brush.load(wetness, {1, 0, 0, 0});
    for (double t = 0; t < 3; t += 0.004) {
      const double turn = 3 * t;
      const BrushFrame frame =
          brush.move(input_at(t, leaning(20 * std::cos(turn), 20 * std::sin(turn),
                                         31 - 14 * ease(t) + 14 * ease(t - 2), 0.7, turn)));
      if (!frame.deposit) continue;
      for (const std::uint16_t patch : frame.deposit->map.patch) ASSERT_LT(patch, patch_count) << t;
    }
  }
}

}  // namespace
}  // namespace fude
