#include "sim/ink/touched_cells.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace fude {
namespace {

Deposit uniform(double left, double bottom, double cell, int columns, int rows, std::size_t patches = 1) {
  const auto size = static_cast<std::size_t>(columns * rows);
  Deposit d{{left, bottom, cell, columns, rows, {}, {}, {}}, std::vector<InkLoad>(patches)};
  d.map.fresh.assign(size, 1);
  d.map.contact_s.assign(size, 0.5F);
  d.map.patch.assign(size, 0);
  return d;
}

TEST(TouchedCells, ShareAMapOutByArea) {
  // 3 × 2 map cells of 0.04 mm from (0.07, 0.1): lattice columns 0 (0.03 mm) and 1 (0.09 mm), row 1 (0.08
  // mm).
  const auto cells = touched_cells(uniform(0.07, 0.1, 0.04, 3, 2), 0.1, 10, 10);
  ASSERT_EQ(cells.size(), 2U);
  EXPECT_EQ(cells[0].column, 0);
  EXPECT_EQ(cells[0].row, 1);
  EXPECT_NEAR(cells[0].fresh, 0.3F * 0.8F, 1e-6F);
  EXPECT_EQ(cells[1].column, 1);
  EXPECT_NEAR(cells[1].fresh, 0.9F * 0.8F, 1e-6F);
  EXPECT_NEAR(cells[1].contact_s, 0.5F * 0.9F * 0.8F, 1e-6F);
}

TEST(TouchedCells, KeepPatchesApartInAFixedOrder) {
  Deposit d = uniform(0, 0, 0.05, 4, 2, 3);
  d.map.patch = {2, 1, 1, 1, 0, 1, 1, 2};
  const auto cells = touched_cells(d, 0.1, 10, 10);
  std::vector<int> order;
  for (const TouchedCell& c : cells) order.push_back(10 * c.column + c.patch);
  EXPECT_EQ(order, (std::vector<int>{0, 1, 2, 11, 12}));
  EXPECT_NEAR(cells[1].fresh, 0.5F, 1e-6F);
}

TEST(TouchedCells, CutWhatLiesOffTheSheet) {
  double area = 0;
  for (const TouchedCell& c : touched_cells(uniform(-0.33, 0.71, 0.05, 40, 40), 0.1, 10, 10)) {
    EXPECT_TRUE(c.column >= 0 && c.column < 10 && c.row >= 7 && c.row < 10);
    area += static_cast<double>(c.fresh);
  }
  EXPECT_NEAR(area, 10 * 2.9, 1e-4);
  EXPECT_TRUE(touched_cells(uniform(1.2, 0, 0.05, 4, 4), 0.1, 10, 10).empty());
}

TEST(TouchedCells, TakeNothingFromNonsense) {
  Deposit d = uniform(0, 0, 0.1, 4, 1);
  d.map.fresh = {std::numeric_limits<float>::quiet_NaN(), -1, std::numeric_limits<float>::infinity(), 5};
  d.map.contact_s.assign(4, 0);
  const auto cells = touched_cells(d, 0.1, 10, 10);
  ASSERT_EQ(cells.size(), 1U);
  EXPECT_NEAR(cells[0].fresh, 1, 1e-6F);
  d.map.patch.assign(4, 7);
  EXPECT_TRUE(touched_cells(d, 0.1, 10, 10).empty());
  d.map.patch.clear();
  EXPECT_TRUE(touched_cells(d, 0.1, 10, 10).empty());
}

}  // namespace
}  // namespace fude
