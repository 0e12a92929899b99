#include "vision/different_views.h"

#include <gtest/gtest.h>

namespace fude {
namespace {

// Four corners a hundred pixels apart, about a place.
BoardView at(double x, double y, const std::string& name = "") {
  return {name, {0, 1, 2, 3}, {{x, y}, {x + 100, y}, {x, y + 100}, {x + 100, y + 100}}};
}

TEST(DifferentViews, OneLikeAnotherIsPassedOver) {
  DifferentViews views(10);
  for (const double x : {0.0, 1.0, 2.0, 50.0, 51.0}) views.add(at(x, 0));
  EXPECT_EQ(views.kept().size(), 2u);
  EXPECT_EQ(views.passed_over(), 3u);
}

TEST(DifferentViews, ALaterViewOfANewPartTakesThePlaceOfARedundantOne) {
  DifferentViews views(4);
  views.add(at(0, 0, "left"));
  views.add(at(10, 0, "left again"));
  views.add(at(200, 0, "right"));
  views.add(at(0, 200, "below"));
  views.add(at(204, 0, "nothing new"));
  views.add(at(200, 200, "the last corner"));
  ASSERT_EQ(views.kept().size(), 4u);
  EXPECT_EQ(views.kept()[0].name, "left");
  EXPECT_EQ(views.kept()[1].name, "right");
  EXPECT_EQ(views.kept()[2].name, "below");
  EXPECT_EQ(views.kept()[3].name, "the last corner");
  EXPECT_EQ(views.passed_over(), 2u);
}

TEST(DifferentViews, PartsOfABoardWithoutACommonCornerDiffer) {
  DifferentViews views(3);
  views.add({"one", {0, 1}, {{0, 0}, {9, 0}}});
  views.add({"other", {7, 8}, {{0, 0}, {9, 0}}});
  EXPECT_EQ(views.kept().size(), 2u);
}

}  // namespace
}  // namespace fude
