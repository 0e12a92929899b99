#include "sim/ink/sheet_grain.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace fude {
namespace {

TEST(SheetGrain, IsTheSameForEverySpacing) {
  SheetGrain coarse(PaperSpec{}, 4);
  SheetGrain fine(PaperSpec{}, 4);
  std::vector<float> few(50);
  std::vector<float> many(200);
  for (const double y : {-3.21, 0.0, 17.77}) {
    coarse.heights(-4, y, 0.4, few);
    fine.heights(-4, y, 0.1, many);
    for (std::size_t i = 0; i < few.size(); ++i) EXPECT_NEAR(few[i], many[4 * i], 1e-5F);
  }
}

TEST(SheetGrain, LiesLowerThanHInAShareHOfTheSheet) {
  SheetGrain grain(PaperSpec{}, 4);
  std::vector<float> all;
  std::vector<float> row(300);
  for (double y = 5; y < 60; y += 1.7) {
    grain.heights(3, y, 0.31, row);
    all.insert(all.end(), row.begin(), row.end());
  }
  std::sort(all.begin(), all.end());
  for (const double share : {0.1, 0.25, 0.5, 0.75, 0.9})
    EXPECT_NEAR(all[static_cast<std::size_t>(share * static_cast<double>(all.size()))], share, 0.08) << share;
}

TEST(SheetGrain, IsThatOfTheSheet) {
  SheetGrain one(PaperSpec{}, 4);
  SheetGrain other(PaperSpec{}, 5);
  std::vector<float> a(100);
  std::vector<float> b(100);
  one.heights(0, 10, 0.1, a);
  other.heights(0, 10, 0.1, b);
  EXPECT_NE(a, b);
}

}  // namespace
}  // namespace fude
