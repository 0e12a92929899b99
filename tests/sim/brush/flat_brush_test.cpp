// Brushes of several tufts in a row (Chu 2.8): the shipped flat, ha-ke, fan and worn brush.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <numbers>
#include <string>

#include "tests/sim/brush/gesture.h"

namespace fude {
namespace {

BrushSpec shipped(const std::string& name) {
  const auto spec = read_brush_spec(std::string(FUDE_BRUSHES) + "/" + name + ".toml");
  if (!spec) {
    ADD_FAILURE() << spec.error().message;
    return {};
  }
  BrushSpec coarse = *spec;
  coarse.cell_mm = 0.1;
  return coarse;
}

Brush wet(const BrushSpec& spec, float wetness = 1) {
  Brush brush(spec, 4);
  brush.load(wetness, {1, 0, 0, 0.1F});
  brush.set_endless(true);
  return brush;
}

// All that a gesture covers, on one grid: cells by (column, row) and how often each was newly covered.
using Painted = std::map<std::pair<int, int>, float>;
Painted paint(Brush& brush, const Gesture& gesture) {
  Painted painted;
  for (int i = 0; i <= static_cast<int>(gesture.seconds * 100); ++i) {
    const BrushFrame frame = brush.move(input_at(i / 100.0, gesture.pose(i / 100.0)));
    EXPECT_LT(frame.solve.violation_mm, 1e-6 * 25);
    if (!frame.deposit) continue;
    const FootprintMap& map = frame.deposit->map;
    const int left = static_cast<int>(std::lround(map.left_mm / map.cell_mm));
    const int bottom = static_cast<int>(std::lround(map.bottom_mm / map.cell_mm));
    for (int y = 0; y < map.rows; ++y)
      for (int x = 0; x < map.columns; ++x) {
        const float fresh = map.fresh[static_cast<std::size_t>(y * map.columns + x)];
        EXPECT_LE(fresh, 1.0F);
        if (fresh > 0) painted[{left + x, bottom + y}] += fresh;
      }
  }
  return painted;
}

// How wide the mark is at y (along x), and how much of that is covered.
struct Width {
  double mm;
  double covered_mm;
  int parts;  // separate streaks
};
Width width_at(const Painted& painted, double at_mm, bool along_x, double cell_mm) {
  std::vector<int> cells;
  const int line = static_cast<int>(std::lround(at_mm / cell_mm));
  for (const auto& [cell, fresh] : painted)
    if ((along_x ? cell.second : cell.first) == line) cells.push_back(along_x ? cell.first : cell.second);
  std::sort(cells.begin(), cells.end());
  if (cells.empty()) return {0, 0, 0};
  Width width{(cells.back() - cells.front() + 1) * cell_mm, static_cast<double>(cells.size()) * cell_mm, 1};
  for (std::size_t i = 1; i < cells.size(); ++i) width.parts += cells[i] > cells[i - 1] + 2 ? 1 : 0;
  return width;
}

// Leaning a little against the way it is drawn, pressed and lifted.
Gesture drawn(double length_mm, double low, bool along_y) {
  return {1.2, [=](double t) {
            const double way = 40 * ease((t - 0.15) / 0.9);
            const double z = length_mm * (1.1 - (1.1 - low) * ease(t / 0.15) + 0.4 * ease((t - 1.0) / 0.2));
            return along_y ? leaning(0, way, z, 0.35, std::numbers::pi / 2) : leaning(way, 0, z, 0.2, 0);
          }};
}

TEST(FlatBrush, DrawnBroadsideItCoversItsBreadthAndEdgewiseALine) {
  const BrushSpec spec = shipped("flat");
  Brush broad = wet(spec);
  const Width wide = width_at(paint(broad, drawn(spec.tuft_length_mm, 0.75, true)), 15, true, spec.cell_mm);
  std::printf("figure: a 25 mm flat drawn broadside is %.1f mm wide, %.1f of it covered, in %d parts\n", wide.mm,
              wide.covered_mm, wide.parts);
  EXPECT_NEAR(wide.mm, spec.row_width_mm, 2);
  EXPECT_GT(wide.covered_mm, 0.97 * wide.mm);
  Brush edge = wet(spec);
  const Width thin = width_at(paint(edge, drawn(spec.tuft_length_mm, 0.985, false)), 20, false, spec.cell_mm);
  std::printf("figure: drawn edgewise %.1f mm\n", thin.mm);
  EXPECT_GT(thin.mm, 0.2);
  EXPECT_LT(thin.mm, 0.25 * wide.mm);
}

TEST(FlatBrush, OpensGapsWhenItIsNearlyDry) {
  BrushSpec spec = shipped("flat");
  spec.hair_texture = false;
  const Gesture gesture = drawn(spec.tuft_length_mm, 0.75, true);
  Brush full = wet(spec);
  Brush dry = wet(spec, 0.1F);
  const Width whole = width_at(paint(full, gesture), 15, true, spec.cell_mm);
  const Width split = width_at(paint(dry, gesture), 15, true, spec.cell_mm);
  std::printf("figure: streaks of a full flat brush %d, of one nearly dry %d\n", whole.parts, split.parts);
  EXPECT_EQ(whole.parts, 1);
  EXPECT_GE(split.parts, 5);
}

TEST(FlatBrush, AFanLeavesSeparateStreaks) {
  const BrushSpec spec = shipped("fan");
  Brush brush = wet(spec);
  const Width width = width_at(paint(brush, drawn(spec.tuft_length_mm, 0.8, true)), 15, true, spec.cell_mm);
  std::printf("figure: a fan leaves %d streaks over %.1f mm\n", width.parts, width.mm);
  EXPECT_GE(width.parts, 6);
  EXPECT_GT(width.mm, 2 * spec.row_width_mm);
}

TEST(FlatBrush, TwoTuftsOverOneAnotherCountOnce) {
  BrushSpec spec;
  spec.cell_mm = 0.2;
  spec.row_width_mm = 1;
  spec.spines = 2;
  spec.spread = false;
  BrushSpec many = spec;
  many.spines = 6;
  const Gesture gesture = drawn(spec.tuft_length_mm, 0.75, true);
  Brush two = wet(spec);
  Brush six = wet(many);
  const auto area = [&](Brush& brush) {
    double sum = 0;
    for (const auto& [cell, fresh] : paint(brush, gesture)) sum += static_cast<double>(std::min(fresh, 1.0F));
    return sum * spec.cell_mm * spec.cell_mm;
  };
  const double of_two = area(two);
  EXPECT_NEAR(area(six), of_two, 0.25 * of_two);
}

TEST(FlatBrush, GoesOnExactlyFromItsBytes) {
  for (const char* name : {"flat", "ha-ke", "fan", "worn-scrubby"}) {
    const BrushSpec spec = shipped(name);
    const Gesture gesture = drawn(spec.tuft_length_mm, 0.75, true);
    Brush brush(spec, 4);
    brush.load(0.5F, {1, 0, 0, 0.1F});
    brush.expect_film(0.05);
    Brush other = brush;
    for (int i = 0; i < 150; ++i) {
      if (i == 60) {
        const auto state = brush_state_of(bytes_of(brush.state()));
        ASSERT_TRUE(state) << state.error().message;
        other.restore(*state);
      }
      const BrushInput input = input_at(i / 150.0, gesture.pose(i / 150.0));
      const BrushFrame a = brush.move(input);
      if (i < 60) continue;
      const BrushFrame b = other.move(input);
      ASSERT_EQ(a.deposit.has_value(), b.deposit.has_value()) << name << i;
      if (!a.deposit) continue;
      ASSERT_EQ(a.deposit->map.fresh, b.deposit->map.fresh) << name << i;
      ASSERT_EQ(a.deposit->map.patch, b.deposit->map.patch) << name << i;
    }
    EXPECT_EQ(bytes_of(brush.state()), bytes_of(other.state())) << name;
  }
}

TEST(Families, AllCanBeReadAndPaint) {
  for (const char* name : {"round-goat", "wolf", "mixed-mantie", "watercolor-round", "rigger", "flat", "ha-ke",
                           "fan", "worn-scrubby"}) {
    const BrushSpec spec = shipped(name);
    EXPECT_EQ(spec.name, name);
    Brush brush = wet(spec);
    EXPECT_GT(paint(brush, drawn(spec.tuft_length_mm, 0.8, true)).size(), 100U) << name;
  }
}

}  // namespace
}  // namespace fude
