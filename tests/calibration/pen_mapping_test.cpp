#include "calibration/pen_mapping.h"

#include <gtest/gtest.h>

#include <numbers>

namespace fude {
namespace {

constexpr double tiny = 1e-12;

DeviceDescription tablet() {
  DeviceDescription d;
  d.name = "A tablet";
  d.axes = {{0, 0, 40000, 0, 0, 200, 0}, {1, 0, 20000, 0, 0, 200, 0}};
  d.width = Millimetres(200);
  d.height = Millimetres(100);
  return d;
}

PenSample touching(double x, double y) {
  PenSample p;
  p.in_proximity = p.in_contact = true;
  p.x_counts = x;
  p.y_counts = y;
  return p;
}

const Extent sheet{Millimetres(200), Millimetres(100)};
const PenReach reach{.tuft_length = Millimetres(30)};

Eigen::Vector3d handle_end(const BrushInput& input) {  // 100 mm up the handle, seen from the root
  return input.paper_from_handle * Eigen::Vector3d(0, 0, 100) - input.paper_from_handle.translation;
}

TEST(PenMapping, CornersOfTheTabletLieOnCornersOfTheSheet) {
  const TabletMapping m = mapping_for(tablet(), sheet).value();
  EXPECT_NEAR((nib_on_paper(touching(0, 0), m) - Eigen::Vector2d(0, 100)).norm(), 0, tiny);
  EXPECT_NEAR((nib_on_paper(touching(40000, 20000), m) - Eigen::Vector2d(200, 0)).norm(), 0, tiny);
}

TEST(PenMapping, MillimetresAreKeptOnAnotherSheet) {
  const TabletMapping m = mapping_for(tablet(), {Millimetres(60), Millimetres(60)}).value();
  const Eigen::Vector2d a = nib_on_paper(touching(20000, 10000), m);
  const Eigen::Vector2d b = nib_on_paper(touching(22000, 10000), m);
  EXPECT_NEAR((a - Eigen::Vector2d(30, 30)).norm(), 0, tiny);
  EXPECT_NEAR((b - a).x(), 10, tiny);
}

TEST(PenMapping, AQuarterTurnTakesRightToAway) {
  TabletMapping m = mapping_for(tablet(), sheet).value();
  m.turn = degrees(90);
  const Eigen::Vector2d moved =
      nib_on_paper(touching(22000, 10000), m) - nib_on_paper(touching(20000, 10000), m);
  EXPECT_NEAR(moved.x(), 0, tiny);
  EXPECT_NEAR(moved.y(), 10, tiny);
}

TEST(PenMapping, PositiveTiltXLeansTheUpperEndRight) {
  PenSample p = touching(20000, 10000);
  p.tilt_x = degrees(30);
  const Eigen::Vector3d end = handle_end(brush_input(p, mapping_for(tablet(), sheet).value(), reach));
  EXPECT_NEAR(end.x() / end.z(), 1 / std::numbers::sqrt3, tiny);
  EXPECT_NEAR(end.y(), 0, tiny);
  EXPECT_GT(end.z(), 0);
}

TEST(PenMapping, PositiveTiltYLeansTheUpperEndTowardsThePainter) {
  PenSample p = touching(20000, 10000);
  p.tilt_y = degrees(30);
  const Eigen::Vector3d end = handle_end(brush_input(p, mapping_for(tablet(), sheet).value(), reach));
  EXPECT_NEAR(end.y() / end.z(), -1 / std::numbers::sqrt3, tiny);
  EXPECT_NEAR(end.x(), 0, tiny);
}

TEST(PenMapping, PositiveRotationTurnsClockwiseFromAbove) {
  PenSample p = touching(20000, 10000);
  p.rotation = degrees(90);
  const BrushInput input = brush_input(p, mapping_for(tablet(), sheet).value(), reach);
  const Eigen::Vector3d side = input.paper_from_handle.rotation * Eigen::Vector3d::UnitX();
  EXPECT_NEAR((side - Eigen::Vector3d(0, -1, 0)).norm(), 0, tiny);
}

TEST(PenMapping, RotationTurnsAboutTheLeaningHandle) {
  PenSample p = touching(20000, 10000);
  p.tilt_x = degrees(40);
  const TabletMapping m = mapping_for(tablet(), sheet).value();
  const Eigen::Vector3d before = handle_end(brush_input(p, m, reach));
  p.rotation = degrees(57);
  EXPECT_NEAR((handle_end(brush_input(p, m, reach)) - before).norm(), 0, 1e-10);
}

TEST(PenMapping, PressureLowersTheRootAlongTheAxisByTheStatedCurve) {
  PenSample p = touching(20000, 10000);
  p.tilt_x = degrees(30);
  const TabletMapping m = mapping_for(tablet(), sheet).value();
  const Eigen::Vector3d nib(100, 50, 0);
  EXPECT_NEAR((brush_input(p, m, reach).paper_from_handle.translation - nib).norm(), 30, tiny);
  p.pressure = Fraction(1);
  EXPECT_NEAR((brush_input(p, m, reach).paper_from_handle.translation - nib).norm(), 21, tiny);
  p.pressure = Fraction(0.25);
  EXPECT_NEAR((brush_input(p, m, reach).paper_from_handle.translation - nib).norm(),
              30 * (1 - 0.3 * 0.32987697769322355), tiny);
}

TEST(PenMapping, APenThatDoesNotTouchKeepsTheTipClear) {
  PenSample p = touching(20000, 10000);
  p.in_contact = false;
  p.pressure = Fraction(0.9);  // pressure without contact paints nothing
  p.tilt_x = degrees(60);
  const BrushInput input = brush_input(p, mapping_for(tablet(), sheet).value(), reach);
  EXPECT_NEAR((input.paper_from_handle * Eigen::Vector3d(0, 0, -30)).z(), 2, tiny);
}

TEST(PenMapping, APenThatLeftIsNoBrush) {
  PenSample p = touching(20000, 10000);
  p.in_proximity = false;
  EXPECT_EQ(brush_input(p, mapping_for(tablet(), sheet).value(), reach).origin, PoseOrigin::none);
}

TEST(PenMapping, ATabletWithoutASizeIsNamed) {
  DeviceDescription d = tablet();
  d.width.reset();
  const auto m = mapping_for(d, sheet);
  ASSERT_FALSE(m.has_value());
  EXPECT_NE(m.error().message.find("--tablet-mm"), std::string::npos);
}

}  // namespace
}  // namespace fude
