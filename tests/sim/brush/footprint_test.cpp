#include "sim/brush/footprint.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <random>
#include <vector>

#include "sim/brush/coverage.h"
#include "sim/brush/winding_fill.h"
#include "tests/sim/brush/gesture.h"

namespace fude {
namespace {

// What a gesture leaves, cell by cell of the grid that all maps share.
class Sheet {
 public:
  void add(const FootprintMap& map) {
    const long left = std::lround(map.left_mm / map.cell_mm);
    const long bottom = std::lround(map.bottom_mm / map.cell_mm);
    for (int r = 0; r < map.rows; ++r)
      for (int c = 0; c < map.columns; ++c) {
        const auto i = static_cast<std::size_t>(r * map.columns + c);
        if (map.fresh[i] > 0) fresh_[{left + c, bottom + r}] += static_cast<double>(map.fresh[i]);
      }
  }
  double at(double x_mm, double y_mm, double cell_mm) const {
    const auto found =
        fresh_.find({std::lround(std::floor(x_mm / cell_mm)), std::lround(std::floor(y_mm / cell_mm))});
    return found == fresh_.end() ? 0 : found->second;
  }

 private:
  std::map<std::pair<long, long>, double> fresh_;
};

double contact_area_mm2(const BrushFrame& frame, double dt_s) {
  if (!frame.deposit) return 0;
  double sum = 0;
  const FootprintMap& map = frame.deposit->map;
  for (const float s : map.contact_s) sum += static_cast<double>(s) / dt_s * map.cell_mm * map.cell_mm;
  return sum;
}

Brush wet_brush(const BrushSpec& spec = {}) {
  Brush brush(spec, 3);
  brush.load(1, {1, 0, 0, 0.1F});
  return brush;
}

using Point = Eigen::Vector2d;

// Triangles as a fan of one quad each: its second half is empty.
Coverage filled(const CoverageFrame& frame, const std::vector<std::array<Point, 3>>& triangles) {
  WindingFill filling;
  filling.start(frame);
  for (const auto& [a, b, c] : triangles) filling.add_quad(a, b, c, a);
  Coverage cover;
  cover.reset(frame);
  filling.fill(cover);
  return cover;
}

// Samples covered in every cell, row by row.
std::vector<int> samples(const Coverage& cover) {
  std::vector<int> all;
  SampleCounts counts;
  for (int row = 0; row < cover.frame().rows; ++row)
    for (int word = 0; word < cover.frame().words; ++word) {
      cover.count_samples(row, word, counts);
      all.insert(all.end(), std::begin(counts), std::end(counts));
      const int most = *std::max_element(std::begin(counts), std::end(counts));
      const int least = *std::min_element(std::begin(counts), std::end(counts));
      EXPECT_EQ(cover.any(row, word), most > 0);
      EXPECT_EQ(cover.whole(row, word), least == 16);
      for (int c = 0; c < cells_per_word; ++c) EXPECT_EQ(cover.cells(row, word) >> c & 1, counts[c] > 0);
    }
  return all;
}

TEST(Coverage, TriangleCoversItsArea) {
  const CoverageFrame frame = frame_around({-1.03, 2.01}, {3.3, 4.2}, 0.05);
  const std::vector<int> cells = samples(filled(frame, {{Point(-1, 2.05), {3.2, 2.4}, {0.7, 4.1}}}));
  const double area = 0.5 * std::abs(4.2 * 2.05 - 0.35 * 1.7);
  EXPECT_NEAR(std::accumulate(cells.begin(), cells.end(), 0) / 16.0 * 0.05 * 0.05, area, 0.003 * area);
}

TEST(Coverage, NeighbouringTrianglesShareNoSample) {
  const CoverageFrame frame = frame_around({0, 0}, {3, 3}, 0.05);
  const Coverage one = filled(frame, {{Point(0.1, 0.2), {2.7, 0.4}, {1.3, 2.9}}});
  const Coverage two = filled(frame, {{Point(2.7, 0.4), {1.3, 2.9}, {2.9, 2.2}}});
  Coverage rest;
  rest.reset(frame);
  rest.add_new(two, one);
  EXPECT_EQ(samples(two), samples(rest));
}

TEST(Coverage, TrianglesOverEachOtherAreFilledOnceWhicheverWayTheyTurn) {
  const CoverageFrame frame = frame_around({-3, -2}, {3, 3}, 0.05);
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> place(-1.9, 2.9);
  std::vector<std::array<Point, 3>> triangles;
  Coverage each;
  each.reset(frame);
  for (int i = 0; i < 12; ++i) {
    triangles.push_back({Point(place(random), place(random)), Point(place(random), place(random)),
                         Point(place(random), place(random))});
    each.add(filled(frame, {triangles.back()}));
    EXPECT_EQ(samples(filled(frame, triangles)), samples(each));
  }
}

TEST(Coverage, KeepsItsSamplesOverAnotherFrame) {
  const std::array<Point, 3> triangle = {Point(-0.9, 0.2), {2.7, 0.4}, {1.3, 2.9}};
  const CoverageFrame narrow = frame_around({-1, 0}, {3, 3}, 0.05);
  const CoverageFrame wide = frame_around({-2.3, -1.1}, {4, 5}, 0.05);
  Coverage moved = filled(narrow, {triangle});
  moved.move_to(wide);
  EXPECT_EQ(samples(moved), samples(filled(wide, {triangle})));
  moved.move_to(narrow);
  EXPECT_EQ(samples(moved), samples(filled(narrow, {triangle})));
}

// A gesture interrupted by a snapshot leaves the very same maps.
TEST(Footprint, GoesOnWithTheSameBitsFromASnapshot) {
  const auto pose = [](double t) { return leaning(30 * ease(t), 4 * t, 31 - 8 * ease(3 * t), 0.3, 1); };
  Brush whole = wet_brush();
  Brush resumed = wet_brush();
  int maps = 0;
  for (double t = 0; t < 1; t += 0.005) {
    Brush other(BrushSpec{}, 3);
    other.restore(resumed.state());
    resumed = other;
    const BrushFrame a = whole.move(input_at(t, pose(t)));
    const BrushFrame b = resumed.move(input_at(t, pose(t)));
    ASSERT_EQ(a.deposit.has_value(), b.deposit.has_value());
    if (!a.deposit) continue;
    ++maps;
    EXPECT_EQ(a.deposit->map.fresh, b.deposit->map.fresh);
    EXPECT_EQ(a.deposit->map.contact_s, b.deposit->map.contact_s);
    EXPECT_EQ(a.deposit->map.patch, b.deposit->map.patch);
  }
  EXPECT_GT(maps, 100);
}

TEST(Footprint, RestingBrushOnlyTouches) {
  Brush brush = wet_brush();
  const double dt = 0.008;
  double t = 0;
  for (; t < 1; t += dt) brush.move(input_at(t, leaning(0, 0, 33 - 12 * ease(t / 0.2), 0.2, 0)));
  for (int i = 0; i < 300; ++i, t += dt) brush.move(input_at(t, leaning(0, 0, 21, 0.2, 0)));
  const BrushFrame frame = brush.move(input_at(t, leaning(0, 0, 21, 0.2, 0)));
  ASSERT_TRUE(frame.deposit);
  double fresh = 0;
  float longest = 0;
  for (const float f : frame.deposit->map.fresh) fresh += static_cast<double>(f);
  for (const float s : frame.deposit->map.contact_s) longest = std::max(longest, s);
  EXPECT_NEAR(fresh * 0.05 * 0.05, 0, 0.01);  // of some 25 mm²
  EXPECT_NEAR(longest, dt, 1e-6);
}

TEST(Footprint, GrowsAndWidensWithPressure) {
  Brush brush = wet_brush();
  double last = 0;
  double t = 0;
  for (const double depth : {2.0, 4.0, 6.0, 9.0, 12.0, 15.0}) {
    const double from = t;
    BrushFrame frame;
    for (; t < from + 0.5; t += 0.008) frame = brush.move(input_at(t, leaning(0, 0, 31.5 - depth, 0.2, 0)));
    const double area = contact_area_mm2(frame, 0.008);
    EXPECT_GT(area, 1.15 * last) << depth;
    last = area;
  }
  EXPECT_GT(last, 60);
}

TEST(Footprint, FastStrokeHasNoGapsAndNoDoubleDeposit) {
  // 500 mm/s: two millimetres between samples.
  Brush brush = wet_brush();
  Sheet sheet;
  const auto move = [&](double t, double x, double z) {
    const BrushFrame frame = brush.move(input_at(t, leaning(x, 0, z, 0.2, 0)));
    if (frame.deposit) sheet.add(frame.deposit->map);
  };
  double t = 0;
  for (; t < 0.5; t += 0.004) move(t, 0, 33 - 11 * ease(t / 0.3));
  for (double x = 0; x < 100; x += 2, t += 0.004) move(t, x, 22);
  const double cell = BrushSpec{}.cell_mm;
  for (double x = 20; x < 75; x += cell) EXPECT_NEAR(sheet.at(x + 0.01, 0.01, cell), 1, 0.07) << x;
}

TEST(Footprint, NothingInTheAir) {
  Brush brush = wet_brush();
  for (int i = 0; i < 20; ++i) EXPECT_FALSE(brush.move(input_at(0.01 * i, upright(i, 0, 40))).deposit);
}

TEST(Footprint, StreaksRunOnFromFrameToFrame) {
  BrushSpec spec;
  spec.soak_mm = 0;
  Brush brush(spec, 5);
  brush.load(0.2F, {1, 0, 0, 0});
  Sheet sheet;
  for (int i = 0; i < 250; ++i) {
    const double t = 0.004 * i;
    const BrushFrame frame =
        brush.move(input_at(t, leaning(120 * ease((t - 0.3) / 0.7), 0, 33 - 12 * ease(t / 0.3), 0.2, 0)));
    if (frame.deposit) sheet.add(frame.deposit->map);
  }
  // From cell to cell the film changes little along the way of the hair, and much across it.
  const double cell = spec.cell_mm;
  double along = 0;
  double across = 0;
  for (double x = 40; x < 60; x += cell)
    for (double y = -1.5; y < 1.5; y += cell) {
      const double here = sheet.at(x + 0.01, y + 0.01, cell);
      along += std::abs(sheet.at(x + cell + 0.01, y + 0.01, cell) - here);
      across += std::abs(sheet.at(x + 0.01, y + cell + 0.01, cell) - here);
    }
  EXPECT_GT(across, 0);
  EXPECT_LT(along, 0.3 * across);
}

TEST(Footprint, DryTuftLeavesStreaks) {
  const auto inked_share = [](float wetness, bool texture) {
    BrushSpec spec;
    spec.hair_texture = spec.split_map = texture;
    spec.soak_mm = 0;
    Brush brush(spec, 5);
    brush.load(wetness, {1, 0, 0, 0});
    double film = 0;
    for (int i = 0; i < 200; ++i) {
      const double t = 0.004 * i;
      const BrushFrame frame =
          brush.move(input_at(t, upright(40 * ease((t - 0.3) / 0.5), 0, 33 - 12 * ease(t / 0.3))));
      if (!frame.deposit) continue;
      for (const float f : frame.deposit->map.fresh) film += static_cast<double>(f);
    }
    return film;
  };
  const double whole = inked_share(1, true);
  EXPECT_NEAR(inked_share(0.1F, false), whole, 1e-9 * whole);
  EXPECT_LT(inked_share(0.2F, true), 0.8 * whole);
  EXPECT_LT(inked_share(0.05F, true), inked_share(0.2F, true));
  EXPECT_GT(inked_share(0.05F, true), 0);
}

}  // namespace
}  // namespace fude
