#include "rig/sheet_plan.h"

#include <gtest/gtest.h>

#include "rig/calibration/calibration_file.h"

namespace fude {
namespace {

RecordedPen pen(DeviceNumber device, double x, double y, bool contact) {
  RecordedPen p;
  p.device = device;
  p.sample.in_proximity = true;
  p.sample.in_contact = contact;
  p.sample.x_counts = x;
  p.sample.y_counts = y;
  return p;
}

Session pixels() {
  Session s;
  DeviceDescription d;
  d.name = "strokes";
  d.transport = "text";
  d.mm_per_count = 0.1;
  s.devices.push_back({1, d});
  s.pens = {pen(1, 0, 0, false), pen(1, 100, 200, true), pen(1, 500, 400, true)};
  return s;
}

Session tablet() {
  Session s;
  DeviceDescription d;
  d.name = "tablet";
  d.axes = {{0, 0, 40000, 0, 0, 200, 0}, {1, 0, 20000, 0, 0, 200, 0}};
  d.width = Millimetres(200);
  d.height = Millimetres(100);
  s.devices.push_back({1, d});
  s.pens = {pen(1, 0, 0, true)};
  return s;
}

TEST(SheetPlan, TheActiveAreaIsTheSheet) {
  const SheetPlan plan = plan_sheet(tablet(), {}).value();
  EXPECT_EQ(plan.sheet.width, Millimetres(200));
  EXPECT_EQ(plan.sheet.height, Millimetres(100));
}

TEST(SheetPlan, StrokesWithoutATabletGetTwentyMillimetresMore) {
  const SheetPlan plan = plan_sheet(pixels(), {}).value();
  EXPECT_DOUBLE_EQ(plan.sheet.width.value, 60);
  EXPECT_DOUBLE_EQ(plan.sheet.height.value, 40);
  const Eigen::Vector2d first = nib_on_paper(pixels().pens[1].sample, plan.mappings.at(1));
  EXPECT_NEAR(first.x(), 10, 1e-12);
  EXPECT_NEAR(first.y(), 30, 1e-12);  // y of the paper points away from the painter
}

TEST(SheetPlan, AnotherSheetKeepsTheMiddle) {
  const SheetPlan plan = plan_sheet(pixels(), {.sheet = Extent{Millimetres(100), Millimetres(90)}}).value();
  const Eigen::Vector2d first = nib_on_paper(pixels().pens[1].sample, plan.mappings.at(1));
  const Eigen::Vector2d last = nib_on_paper(pixels().pens[2].sample, plan.mappings.at(1));
  EXPECT_NEAR(0.5 * (first.x() + last.x()), 50, 1e-12);
  EXPECT_NEAR(0.5 * (first.y() + last.y()), 45, 1e-12);
  EXPECT_NEAR(last.x() - first.x(), 40, 1e-12);
}

TEST(SheetPlan, ATabletOfUnknownSizeNeedsOne) {
  Session s = tablet();
  s.devices[0].description.width.reset();
  s.devices[0].description.height.reset();
  EXPECT_FALSE(plan_sheet(s, {.sheet = Extent{Millimetres(50), Millimetres(50)}}).has_value());
  const auto plan = plan_sheet(s, {.tablet = Extent{Millimetres(120), Millimetres(80)}});
  ASSERT_TRUE(plan.has_value());
  EXPECT_EQ(plan->sheet.width, Millimetres(120));
}

TEST(SheetPlan, AnEmptySessionStillHasASheet) { EXPECT_TRUE(plan_sheet(Session{}, {}).has_value()); }

TEST(SheetPlan, AHugeSheetIsRefused) {
  EXPECT_FALSE(plan_sheet(Session{}, {.sheet = Extent{Millimetres(1e6), Millimetres(10)}}).has_value());
}

// Of a sheet of 180 × 90 mm, whose left edge lies on x = `left_counts`.
StoredCalibration taps_on(const std::string& device, double left_counts) {
  TabletSurface surface;
  surface.mm_from_counts << 0.005, 0, -0.005 * left_counts, 0, -0.005, 90, 0, 0, 1;
  surface.width_mm = 180;
  surface.height_mm = 90;
  return {to_fields(surface), {.procedure = "surface", .accepted = true, .devices = {device}}};
}

Session calibrated_tablet() {
  Session s = tablet();
  s.devices[0].description.id = "056a:0001:A";
  for (const auto& calibration : {taps_on("056a:0001:A", 1000), taps_on("056a:0001:B", 3000)})
    s.calibrations.push_back({"surface", toml_of(calibration)});
  s.calibrations.push_back({"other", "rpm = 3"});
  return s;
}

double left_edge_mm(const SheetPlan& plan, double counts) {
  return nib_on_paper(pen(1, counts, 18000, true).sample, plan.mappings.at(1)).x();
}

TEST(SheetPlan, ACalibratedTabletPaintsOnTheSheetThatWasTapped) {
  const SheetPlan plan = plan_sheet(calibrated_tablet(), {}).value();
  EXPECT_EQ(plan.sheet.width, Millimetres(180));
  EXPECT_EQ(plan.sheet.height, Millimetres(90));
  EXPECT_NEAR(left_edge_mm(plan, 1000), 0, 1e-9);
}

TEST(SheetPlan, TheCalibrationThatIsNamedGoesBeforeTheSessions) {
  const SheetPlan plan =
      plan_sheet(calibrated_tablet(), {.calibrations = {taps_on("056a:0001:A", 5000)}}).value();
  EXPECT_NEAR(left_edge_mm(plan, 5000), 0, 1e-9);
}

TEST(SheetPlan, ACalibrationOfAnotherTabletIsNotUsed) {
  const auto plan = plan_sheet(calibrated_tablet(), {.calibrations = {taps_on("056a:0001:C", 5000)}});
  ASSERT_FALSE(plan);
  EXPECT_NE(plan.error().message.find("another tablet"), std::string::npos) << plan.error().message;
  Session other = calibrated_tablet();
  other.devices[0].description.id = "056a:0001:D";
  EXPECT_EQ(plan_sheet(other, {}).value().mappings.at(1).surface, nullptr);
}

TEST(SheetPlan, ADamagedCalibrationIsNotPassedOver) {
  Session s = calibrated_tablet();
  std::string& toml = s.calibrations[0].toml;
  toml.erase(toml.find("lean_counts"), toml.find('\n', toml.find("lean_counts")) - toml.find("lean_counts"));
  const auto plan = plan_sheet(s, {});
  ASSERT_FALSE(plan);
  EXPECT_NE(plan.error().message.find("lacks a part"), std::string::npos) << plan.error().message;
}

TEST(SheetPlan, ATabletThatComesLaterIsMappedByItsCalibration) {
  const SheetPlan plan = plan_sheet(Session{}, {.calibrations = {taps_on("056a:0001:A", 1000)}}).value();
  EXPECT_TRUE(mapping_on(plan, calibrated_tablet().devices[0].description).value().surface);
  EXPECT_FALSE(mapping_on(plan, tablet().devices[0].description).value().surface);
}

TEST(SheetPlan, ASizeIsToldOnlyToADeviceThatStatesNone) {
  const Extent told{Millimetres(200), Millimetres(120)};
  EXPECT_EQ(sized({.name = "silent"}, told).width->value, 200);
  EXPECT_FALSE(sized({.name = "silent"}, std::nullopt).width);
  DeviceDescription stated{.name = "stated"};
  stated.width = Millimetres(300);
  stated.height = Millimetres(180);
  stated.mm_per_count = 0.005;
  EXPECT_EQ(sized(stated, told).width->value, 300);
}

}  // namespace
}  // namespace fude
