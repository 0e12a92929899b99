// A rig whose tracker is bent by iron, end to end: the map, the pivot and the surface by it, and the fusion.
#include "rig/calibration/undistortion.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "calibration/fusion/motion_state.h"
#include "calibration/pivot.h"
#include "calibration/surface.h"
#include "capture/session_writer.h"
#include "rig/calibration/calibrate_session.h"
#include "rig/calibration/distortion.h"
#include "rig/calibration/pivot.h"
#include "rig/calibration/surface.h"
#include "rig/fusion/fuse_session.h"
#include "tests/fakes/scripted_tracker.h"

namespace fude {
namespace {

namespace fs = std::filesystem;

const DeviceDescription magnetic{.id = "0f44:ff20:A1", .name = "magnetic", .kind = DeviceKind::tracker};
const DeviceDescription optical{.id = "1234:5678:B2", .name = "optical", .kind = DeviceKind::tracker};
const Eigen::Vector3d tip_m(0.01, -0.005, -0.12);

// Shifts of up to a centimetre and turns of two degrees.
Pose<Tracker, Tool> bent(Pose<Tracker, Tool> pose) {
  const Eigen::Vector3d at = pose.translation - Eigen::Vector3d(0, 0, 0.5);
  pose.rotation = rotation_of({0.8 * at.x() * at.y(), 0.15 * at.y(), -0.6 * at.x() * at.x()}) * pose.rotation;
  pose.translation += Eigen::Vector3d(0.3 * at.x() * at.y(), 0.25 * at.x() * at.x(),
                                      -0.3 * at.x() * at.x() + 0.2 * at.y() * at.z());
  return pose;
}

// What the magnetic tracker says of a brush that is truly there.
PoseSample seen(Pose<Tracker, Tool> pose, double t, Noise& noise) {
  pose = bent(pose);
  pose.translation += noise.vector(0.1e-3);
  pose.rotation = rotation_of(noise.vector(0.3e-3)) * pose.rotation;
  return pose_sample(pose, t);
}

Session mapping() {
  Session session;
  session.devices = {{1, magnetic}, {2, optical}};
  const Pose<Tracker, Tracker> other_from_tracker{rotation_of({0.4, -1.2, 0.3}), {0.8, -0.3, 1.7}};
  const Pose<Tool, Tool> brush_from_wand{rotation_of({-0.2, 0.5, 0.9}), {0.03, -0.06, 0.08}};
  Noise noise(1);
  for (int i = 0; i < 3000; ++i) {
    const double t = 0.02 * i;
    const Pose<Tracker, Tool> brush{
        rotation_of({0.9 * std::sin(1.7 * t), 0.7 * std::sin(2.3 * t + 1), 0.8 * std::sin(1.1 * t + 2)}),
        {0.22 * std::sin(1.3 * t), 0.22 * std::sin(0.9 * t + 0.5), 0.5 + 0.15 * std::sin(0.7 * t)}};
    session.samples.push_back({1, seen(brush, t, noise)});
    PoseSample wand = pose_sample(other_from_tracker * brush * brush_from_wand, t);
    wand.tracker_from_tool.translation += noise.vector(0.1e-3);
    wand.tool = "wand";
    session.samples.push_back({2, wand});
  }
  return session;
}

Session pivoting() {
  Session session;
  session.devices = {{1, magnetic}};
  Noise noise(2);
  const ScriptedPivot pivot{.tip_m = tip_m, .pivot_m = {0.05, -0.1, 0.42}, .lean_rad = 0.7, .poses = 400};
  for (const PoseSample& truth : pivot.samples())
    session.samples.push_back(
        {1, seen(truth.tracker_from_tool, seconds(truth.time.host.time_since_epoch()), noise)});
  return session;
}

// An A4 sheet that is level in the tracker's frame; `bow_mm` high in its middle.
constexpr double width_mm = 297, height_mm = 210;
struct Sheet {
  double bow_mm = 0;

  double height(double x, double y) const {
    return bow_mm * (1 - std::pow(2 * x / width_mm - 1, 2)) * (1 - 0.3 * std::pow(2 * y / height_mm - 1, 2));
  }
  // Of the tool whose tip stands there, leaning.
  Pose<Tracker, Tool> touched(double x, double y, const Eigen::Vector3d& lean) const {
    const Eigen::Vector3d at(1e-3 * (x - width_mm / 2), 1e-3 * (y - height_mm / 2),
                             0.38 + 1e-3 * height(x, y));
    const Eigen::Quaterniond turned = rotation_of(lean);
    return {turned, at - turned * tip_m};
  }
};

Session touching(const Sheet& sheet) {
  Session session;
  session.devices = {{1, magnetic}};
  Noise noise(3);
  double t = 0;
  const auto touch = [&](double x, double y) {
    const Eigen::Vector3d lean(0.3 * std::sin(t), 0.3 * std::cos(1.3 * t), 0.2 * std::sin(2 * t));
    for (int k = 0; k < 12; ++k, t += 0.025)
      session.samples.push_back({1, seen(sheet.touched(x, y, lean), t, noise)});
  };
  for (const auto& [x, y] : {std::pair(0., 0.), {width_mm, 0.}, {width_mm, height_mm}, {0., height_mm}})
    touch(x, y);
  for (int row = 0; row < 5; ++row)
    for (int column = 0; column < 7; ++column)
      touch(width_mm * (0.05 + 0.15 * column), height_mm * (0.06 + 0.22 * row));
  return session;
}

StoredCalibration kept(const Result<CalibrationOutcome>& outcome) {
  EXPECT_TRUE(outcome) << outcome.error().message;
  if (!outcome) return {};
  EXPECT_TRUE(outcome->result) << outcome->report.reason;
  return {outcome->result.value_or(Fields{}), outcome->report};
}

// The map, as it comes out of its own session.
const StoredCalibration& iron() {
  static const StoredCalibration map =
      kept(calibrate_session(**distortion_calibrator({.tool = "brush", .other = "wand"}, {}), mapping()));
  return map;
}

KnownCalibrations kept_ones(std::vector<StoredCalibration> calibrations) {
  KnownCalibrations known;
  known.keep(std::move(calibrations));
  return known;
}

StoredCalibration pivot_of(const KnownCalibrations& known) {
  return kept(calibrate_session(*undistorted(pivot_calibrator({}, known), known), pivoting()));
}

Result<CalibrationOutcome> touched(const Sheet& sheet, const KnownCalibrations& known) {
  const SurfaceWish wish{.tip_m = tip_m, .corners_first = true};
  return calibrate_session(*undistorted(surface_calibrator(wish, known), known), touching(sheet));
}

StoredCalibration surface_of(const Sheet& sheet, const KnownCalibrations& known) {
  return kept(touched(sheet, known));
}

double off_mm(const StoredCalibration& pivot) {
  return 1e3 * (pivot_from(pivot.result)->tip_m - tip_m).norm();
}

// The map is of the magnetic tracker alone, whatever it sees and whatever mapped it.
TEST(Undistortion, TheMapIsOfItsTracker) {
  EXPECT_EQ(iron().report.devices, std::vector<std::string>{magnetic.id});
  EXPECT_EQ(iron().report.tool, "");
}

TEST(Undistortion, ThePivotFindsTheTipInABentTracker) {
  const StoredCalibration bent = pivot_of({}), straight = pivot_of(kept_ones({iron()}));
  std::printf(
      "figure: tip by a pivot in a bent tracker: %.2f mm off, with the map %.2f mm; residual %.2f and %.2f "
      "mm\n",
      off_mm(bent), off_mm(straight), bent.report.rms, straight.report.rms);
  EXPECT_GT(off_mm(bent), 3);
  EXPECT_LT(off_mm(straight), 0.2 * off_mm(bent));
  EXPECT_EQ(numbers_in(straight.report.details, "poses_undistorted"), std::vector<double>{400});
  EXPECT_FALSE(numbers_in(bent.report.details, "poses_undistorted"));
}

TEST(Undistortion, SoDoesItsSpin) {
  const fs::path file = fs::path(testing::TempDir()) / ("fude-spun-" + std::to_string(getpid()) + ".fude");
  const Eigen::Vector3d axis = Eigen::Vector3d(0.1, 0, 1).normalized();
  {
    auto writer = SessionWriter::create(file);
    ASSERT_TRUE(writer);
    const auto number = writer->add_device(magnetic);
    Noise noise(4);
    for (int i = 0; i < 120; ++i) {
      const Eigen::Quaterniond turned(Eigen::AngleAxisd(0.05 * i, axis));
      const Eigen::Vector3d at(0.15, 0.12, 0.45);
      ASSERT_TRUE(writer->add_sample(*number, seen({turned, at - turned * tip_m}, 0.02 * i, noise)));
    }
    ASSERT_TRUE(writer->close());
  }
  const auto known = kept_ones({iron()});
  const auto found =
      kept(calibrate_session(*undistorted(pivot_calibrator({.spin = file}, known), known), pivoting()));
  const auto pivot = pivot_from(found.result);
  ASSERT_TRUE(pivot && pivot->axis);
  EXPECT_TRUE(std::ranges::none_of(found.report.warnings, [](const std::string& warning) {
    return warning.find("time went backwards") != std::string::npos;  // the spin has times of its own
  }));
  EXPECT_LT(std::acos(pivot->axis->dot(axis)), 0.01);
  fs::remove(file);
}

TEST(Undistortion, TheSurfaceIsPlaneAndAsLargeAsItIs) {
  const auto bent = touched({}, {});
  const StoredCalibration straight = surface_of({}, kept_ones({iron()}));
  ASSERT_TRUE(bent);
  const auto found = surface_from(straight.result);
  ASSERT_TRUE(found);
  std::printf("figure: surface in a bent tracker: residual %.2f mm, with the map %.2f mm; %.1f x %.1f mm\n",
              bent->report.rms, straight.report.rms, found->width_mm, found->height_mm);
  EXPECT_FALSE(bent->result);
  EXPECT_LT(straight.report.rms, 0.3);
  EXPECT_NEAR(found->width_mm, width_mm, 0.6);
  EXPECT_NEAR(found->height_mm, height_mm, 0.6);
  EXPECT_LT(std::abs(sheet_at(*found, {width_mm / 2, height_mm / 2}).height_mm), 0.5);
}

TEST(Undistortion, OneOfAnotherTrackerIsNamed) {
  const fs::path file = fs::path(testing::TempDir()) / ("fude-iron-" + std::to_string(getpid()) + ".toml");
  StoredCalibration other = iron();
  other.report.devices = {"0f44:ff20:Z9"};
  std::ofstream(file) << toml_of(other);
  const auto known = KnownCalibrations::read({file});
  ASSERT_TRUE(known);
  const auto outcome = calibrate_session(*undistorted(pivot_calibrator({}), *known), pivoting());
  ASSERT_FALSE(outcome);
  EXPECT_NE(outcome.error().message.find("0f44:ff20:Z9"), std::string::npos) << outcome.error().message;
  // What is kept of another is passed over.
  EXPECT_GT(off_mm(pivot_of(kept_ones({other}))), 1);
  fs::remove(file);
}

TEST(Undistortion, PosesBeyondTheMapAreCounted) {
  Undistortion undistortion(kept_ones({iron()}));
  undistortion.begin(1, magnetic);
  Noise noise(5);
  for (const double x : {0.0, 1.0, 2.0})
    undistortion.straight(1, seen({{1, 0, 0, 0},
                                   {0.22 * std::sin(1.3 * x), 0.22 * std::sin(0.9 * x + 0.5),
                                    0.5 + 0.15 * std::sin(0.7 * x) + (x == 2 ? 1 : 0)}},
                                  x, noise));
  CalibrationReport report;
  undistortion.describe(report);
  ASSERT_EQ(report.warnings.size(), 1U);
  EXPECT_NE(report.warnings[0].find("1 of 3 poses"), std::string::npos) << report.warnings[0];
}

// The tip glides over a bowed sheet, seen by the bent tracker, while a tablet under the sheet feels it.
Session gliding(const Sheet& sheet, double noise_m) {
  Session session;
  session.devices = {{1, magnetic},
                     {2, {.id = "056a:0357:T", .name = "tablet", .kind = DeviceKind::pen_tablet}}};
  Noise noise(6);
  for (int i = 0; i < 1500; ++i) {
    const double t = 0.01 * i;
    const double x = width_mm * (0.5 + 0.4 * std::sin(0.5 * t)),
                 y = height_mm * (0.5 + 0.4 * std::sin(0.33 * t));
    PoseSample pose = seen(sheet.touched(x, y, {0.2 * std::sin(t), 0.2 * std::cos(t), 0}), t, noise);
    pose.tracker_from_tool.translation += noise.vector(noise_m);
    session.samples.push_back({1, pose});
    PenSample pen;
    pen.time.host = pose.time.host;
    pen.in_contact = true;
    session.pens.push_back({.device = 2, .sample = pen});
  }
  return session;
}

struct TipError {
  double height_mm = 0, place_mm = 0;  // root mean squares
};
TipError tip_error(const Session& session, const SurfaceCalibration& surface, const char* use,
                   const std::vector<StoredCalibration>& calibrations) {
  std::vector<RecordedCalibration> named;
  for (const StoredCalibration& c : calibrations) named.push_back({c.report.procedure, toml_of(c)});
  const auto fused = fuse_session(session, {.use = fuse_sources(use).value(), .calibrations = named});
  EXPECT_TRUE(fused) << fused.error().message;
  if (!fused) return {};
  TipError sum;
  double count = 0;
  for (const FusedRow& row : fused->rows) {
    const double t = seconds(row.time.time_since_epoch());
    if (t < 2 || !row.position_m || !row.world_from_sensor) continue;
    const Eigen::Vector3d tip = 1e3 * (*row.position_m + *row.world_from_sensor * tip_m);
    const double x = width_mm * (0.5 + 0.4 * std::sin(0.5 * t)),
                 y = height_mm * (0.5 + 0.4 * std::sin(0.33 * t));
    sum.height_mm += std::pow(tip.z() - sheet_at(surface, tip.head<2>()).height_mm, 2);
    sum.place_mm += (tip.head<2>() - Eigen::Vector2d(x, y)).squaredNorm();
    ++count;
  }
  EXPECT_GT(count, 1000);
  return {std::sqrt(sum.height_mm / count), std::sqrt(sum.place_mm / count)};
}

TEST(Undistortion, AFusionOnABowedSheetInABentTracker) {
  const Sheet sheet{.bow_mm = 15};
  const auto known = kept_ones({iron()});
  const StoredCalibration pivot = pivot_of(known), surface = surface_of(sheet, known);
  const auto found = surface_from(surface.result);
  ASSERT_TRUE(found && found->sheet);
  // The sheet as it is, over the plane in which its middle height lies.
  EXPECT_NEAR(sheet_at(*found, {width_mm / 2, height_mm / 2}).height_mm -
                  sheet_at(*found, {0, height_mm / 2}).height_mm,
              sheet.height(width_mm / 2, height_mm / 2), 0.7);
  const Session session = gliding(sheet, 1e-3);
  const TipError bent = tip_error(session, *found, "pose", {pivot, surface});
  const TipError straight = tip_error(session, *found, "pose", {iron(), pivot, surface});
  const TipError touching = tip_error(session, *found, "pose,contact", {iron(), pivot, surface});
  std::printf(
      "figure: tip on a bowed sheet in a bent tracker, poses of 1 mm noise: height %.2f mm, place %.2f mm; "
      "with the map %.2f, %.2f; with contacts too %.2f, %.2f\n",
      bent.height_mm, bent.place_mm, straight.height_mm, straight.place_mm, touching.height_mm,
      touching.place_mm);
  EXPECT_LT(straight.place_mm, 0.6 * bent.place_mm);
  EXPECT_LT(straight.height_mm, 0.6 * bent.height_mm);
  EXPECT_LT(touching.height_mm, 0.3);
  EXPECT_LT(touching.height_mm, 0.6 * straight.height_mm);
}

}  // namespace
}  // namespace fude
