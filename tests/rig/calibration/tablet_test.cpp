// A tablet's surface and pressure from recorded sessions, through the file to the painting.
#include "rig/calibration/tablet.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>

#include "capture/session_writer.h"
#include "rig/calibrated_tablets.h"
#include "rig/calibration/calibrate_session.h"
#include "rig/calibration/pressure.h"
#include "rig/sheet_plan.h"
#include "tests/fakes/scripted_pen.h"

namespace fude {
namespace {

namespace fs = std::filesystem;

constexpr double sheet_width_mm = 180, sheet_height_mm = 90;

DeviceDescription tablet(const std::string& serial = "T1") {
  return {.id = "056a:0304:" + serial,
          .name = "A tablet",
          .kind = DeviceKind::pen_tablet,
          .transport = "evdev",
          .vendor = 0x56a,
          .product = 0x304,
          .serial = serial,
          .axes = {{0, 0, 40000, 0, 0, 200, 0}, {1, 0, 20000, 0, 0, 200, 0}},
          .width = Millimetres(200),
          .height = Millimetres(100)};
}

// The sheet's lower left corner lies 8 mm right of the tablet's and 6 mm above it, whose scale is 1 % off;
// the pen reports itself 3 mm off for each unit that its tilt's tangent has.
PenSample at(const Eigen::Vector2d& mm, double tilt_x_rad = 0, double tilt_y_rad = 0) {
  PenSample s = pen_sample(
      0,
      {202 * (mm.x() + 8 + 3 * std::tan(tilt_x_rad)), 20000 - 202 * (mm.y() + 6 - 3 * std::tan(tilt_y_rad))},
      true);
  s.tilt_x = Radians(tilt_x_rad);
  s.tilt_y = Radians(tilt_y_rad);
  return s;
}

std::vector<PenSample> taps(const TapSheet& sheet) {
  std::vector<PenSample> samples;
  for (std::size_t i = 0; i < sheet.places_mm.size(); ++i)
    tap(samples, at(sheet.places_mm[i], 0.5 * std::sin(1.0 + double(i)), 0.4 * std::cos(2.2 * double(i))));
  return samples;
}

class CalibrateTablet : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  Session recorded(const std::vector<PenSample>& samples, const std::vector<DeviceDescription>& tablets) {
    const fs::path file = folder_ / ("session-" + std::to_string(++count_) + ".fude");
    auto writer = SessionWriter::create(file);
    EXPECT_TRUE(writer);
    for (const DeviceDescription& description : tablets) {
      const auto number = writer->add_device(description);
      EXPECT_TRUE(number);
      for (const PenSample& sample : samples) EXPECT_TRUE(writer->add_sample(*number, sample));
    }
    EXPECT_TRUE(writer->close());
    return read_session(file).value();
  }

  fs::path stored(const CalibrationOutcome& outcome) {
    const fs::path file = folder_ / ("calibration-" + std::to_string(++count_) + ".toml");
    std::ofstream(file) << toml_of({*outcome.result, outcome.report});
    return file;
  }

  fs::path listing(const std::string& text) {
    std::ofstream(folder_ / "list.csv") << text;
    return folder_ / "list.csv";
  }

  fs::path folder_ = fs::path(testing::TempDir()) / ("fude-tablet-" + std::to_string(getpid()));
  int count_ = 0;
};

TEST_F(CalibrateTablet, TapsOfASessionPutThePenOnThePaper) {
  const TapSheet sheet = tap_grid(5, 4, sheet_width_mm, sheet_height_mm);
  const Session session = recorded(taps(sheet), {tablet()});
  const auto calibrator = tablet_calibrator({"", sheet});
  const auto outcome = calibrate_session(*calibrator, session);
  ASSERT_TRUE(outcome) << outcome.error().message;
  ASSERT_TRUE(outcome->result) << outcome->report.reason;
  EXPECT_EQ(outcome->report.devices, std::vector<std::string>{"056a:0304:T1"});
  EXPECT_TRUE(outcome->report.warnings.empty()) << outcome->report.warnings[0];
  EXPECT_FALSE(outcome->report.session.empty());

  const auto calibration = tablet_calibration(stored(*outcome));
  ASSERT_TRUE(calibration) << calibration.error().message;
  const auto plan = plan_sheet(session, {.calibrations = {*calibration}});
  ASSERT_TRUE(plan) << plan.error().message;
  EXPECT_EQ(plan->sheet.width.value, sheet_width_mm);
  EXPECT_EQ(plan->sheet.height.value, sheet_height_mm);
  for (const Eigen::Vector2d& mm :
       {Eigen::Vector2d(0, 0), Eigen::Vector2d(70, 33), Eigen::Vector2d(180, 90)}) {
    const BrushInput brush = brush_input(at(mm, 0.3, -0.2), plan->mappings.at(1), {});
    EXPECT_LT((nib_on_paper(at(mm, 0.3, -0.2), plan->mappings.at(1)) - mm).norm(), 1e-6);
    EXPECT_GT((brush.paper_from_handle.rotation * Eigen::Vector3d::UnitZ()).x(), 0.2);  // leans to the right
  }
}

TEST_F(CalibrateTablet, AListOfPlacesStandsForAGrid) {
  std::string list = "name,x,y,z\n";
  for (int i = 0; i < 12; ++i)
    list += "p" + std::to_string(i) + "," + std::to_string(15 * i) + "," + std::to_string(7 * i * i % 90) +
            ",0\n";
  const auto sheet = listed_taps(listing(list), sheet_width_mm, sheet_height_mm);
  ASSERT_TRUE(sheet) << sheet.error().message;
  const auto calibrator = tablet_calibrator({"", *sheet});
  const auto outcome = calibrate_session(*calibrator, recorded(taps(*sheet), {tablet()}));
  ASSERT_TRUE(outcome && outcome->result) << (outcome ? outcome->report.reason : outcome.error().message);
  const auto beside = listed_taps(listing("a,500,20,0\n"), sheet_width_mm, sheet_height_mm);
  ASSERT_FALSE(beside);
  EXPECT_NE(beside.error().message.find("does not lie on the sheet"), std::string::npos);
}

TEST_F(CalibrateTablet, ASheetOfAnotherSizeThanToldIsDoubted) {
  const TapSheet inches = tap_grid(4, 3, sheet_width_mm / 25.4, sheet_height_mm / 25.4);
  const auto calibrator = tablet_calibrator({"", inches});
  const auto outcome = calibrate_session(
      *calibrator, recorded(taps(tap_grid(4, 3, sheet_width_mm, sheet_height_mm)), {tablet()}));
  ASSERT_TRUE(outcome && outcome->result) << (outcome ? outcome->report.reason : outcome.error().message);
  ASSERT_FALSE(outcome->report.warnings.empty());
  EXPECT_NE(outcome->report.warnings.back().find("-96 % wide"), std::string::npos)
      << outcome->report.warnings.back();
}

TEST_F(CalibrateTablet, OfTwoTabletsOneMustBeNamed) {
  const TapSheet sheet = tap_grid(3, 3, sheet_width_mm, sheet_height_mm);
  const Session both = recorded(taps(sheet), {tablet("T1"), tablet("T2")});
  const auto unnamed = calibrate_session(*tablet_calibrator({"", sheet}), both);
  ASSERT_FALSE(unnamed);
  EXPECT_NE(unnamed.error().message.find("--tool"), std::string::npos) << unnamed.error().message;
  const auto named = calibrate_session(*tablet_calibrator({"A tablet #2", sheet}), both);
  ASSERT_TRUE(named && named->result) << (named ? named->report.reason : named.error().message);
  EXPECT_EQ(named->report.devices, std::vector<std::string>{"056a:0304:T2"});
}

TEST_F(CalibrateTablet, ACalibrationOfSomethingElseIsNotPaintedWith) {
  const CalibrationOutcome other{{.procedure = "pivot", .accepted = true},
                                 Fields{{"tip_m", std::vector{0.0, 0.1, 0.2}}}};
  const auto calibration = tablet_calibration(stored(other));
  ASSERT_FALSE(calibration);
  EXPECT_NE(calibration.error().message.find("not the calibration of a tablet"), std::string::npos);
}

TEST_F(CalibrateTablet, PressesOnAScaleGiveNewtons) {
  const std::vector<double> grams{20, 40, 80, 120, 180, 260, 340, 420, 500, 620};
  std::vector<PenSample> samples;
  std::vector<Weighing> in_order, timed;
  for (const double g : grams) {
    tap(samples, pen_sample(0, {100, 100}, true, std::sqrt(std::min(1.0, g / 500))));
    in_order.push_back({g, std::nullopt});
    timed.push_back({g, samples[samples.size() - 25].time.host});
  }
  const Session session = recorded(samples, {tablet()});
  for (const auto& weighings : {in_order, timed}) {
    const auto outcome = calibrate_session(*pressure_calibrator({"", weighings}), session);
    ASSERT_TRUE(outcome && outcome->result) << (outcome ? outcome->report.reason : outcome.error().message);
    const auto read = read_calibration(stored(*outcome));
    ASSERT_TRUE(read) << read.error().message;
    const auto curve = pressure_curve_from(read->result);
    ASSERT_TRUE(curve);
    EXPECT_NEAR(force_n(*curve, Fraction(0.7)), 9.80665e-3 * 500 * 0.49, 0.02);
    EXPECT_EQ(outcome->report.unit, "N");
  }
}

TEST(Weighings, TheLineThatIsWrongIsNamed) {
  const auto good = weighings_from("host_s,grams\n1.5, 20\n# none\n\n3.25,40 # more\n", "list");
  ASSERT_TRUE(good) << good.error().message;
  ASSERT_EQ(good->size(), 2U);
  EXPECT_EQ((*good)[1].grams, 40);
  EXPECT_EQ((*good)[1].at->time_since_epoch(), std::chrono::milliseconds(3250));
  for (const auto& [text, line] : {std::pair("1,2\n3\n", "line 2"), std::pair("1,2,3\n", "line 1"),
                                   std::pair("1,x\n", "line 1"), std::pair("1e300,5\n", "line 1")}) {
    const auto bad = weighings_from(text, "list");
    ASSERT_FALSE(bad) << text;
    EXPECT_NE(bad.error().message.find(line), std::string::npos) << bad.error().message;
  }
  EXPECT_FALSE(weighings_from("# nothing\n", "list"));
}

}  // namespace
}  // namespace fude
