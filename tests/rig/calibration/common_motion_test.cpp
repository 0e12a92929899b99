// Two streams of one session that saw the same motion: two trackers, a tracker and an inertial unit, a
// magnetic tracker and one that no iron disturbs.
#include "rig/calibration/common_motion.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "calibration/common_motion.h"
#include "calibration/distortion_field.h"
#include "calibration/fusion/motion_state.h"
#include "calibration/sensor_axes.h"
#include "rig/calibration/calibrate_session.h"
#include "rig/calibration/distortion.h"
#include "rig/calibration/imu_axes.h"
#include "rig/calibration/calibration_file.h"
#include "tests/fakes/scripted_tracker.h"

namespace fude {
namespace {

namespace fs = std::filesystem;

Pose<Tracker, Tool> waved(double t) {
  return {rotation_of({0.9 * std::sin(1.7 * t), 0.7 * std::sin(2.3 * t + 1), 0.8 * std::sin(1.1 * t + 2)}),
          {0.2 * std::sin(1.3 * t), 0.2 * std::sin(0.9 * t + 0.5), 0.5 + 0.15 * std::sin(0.7 * t)}};
}

const CommonMotion joined{{rotation_of({0.4, -1.2, 0.3}), {0.8, -0.3, 1.7}},
                          {rotation_of({-0.2, 0.5, 0.9}), {0.03, -0.06, 0.08}}};
const Eigen::Quaterniond tool_from_sensor = rotation_of({0.3, -0.8, 1.1});

// Iron that shifts by millimetres and turns by a degree.
Pose<Tracker, Tool> bent(Pose<Tracker, Tool> pose) {
  const Eigen::Vector3d at = pose.translation - Eigen::Vector3d(0, 0, 0.5);
  pose.rotation = rotation_of({0.3 * at.x() * at.x(), 0.05 * at.y(), 0}) * pose.rotation;
  pose.translation += Eigen::Vector3d(0.2 * at.x() * at.y(), 0.15 * at.z() * at.z(), -0.2 * at.x() * at.x());
  return pose;
}

// A session in the order of arrival: the tracker's brush, another tracker's wand, an inertial unit.
Session scene(bool iron = false, double length_s = 20) {
  Session session;
  session.devices = {{1, {.id = "0f44:ff20:A1", .name = "magnetic", .kind = DeviceKind::tracker}},
                     {2, {.id = "1234:5678:B2", .name = "optical", .kind = DeviceKind::tracker}},
                     {3, {.id = "2222:3333:C3", .name = "unit", .kind = DeviceKind::imu}}};
  Noise noise(1);
  for (int i = 0; i < int(length_s * 100); ++i) {
    const double t = 0.01 * i;
    const auto moved = [&](Pose<Tracker, Tool> pose) {
      pose.translation += noise.vector(0.1e-3);
      pose.rotation = rotation_of(noise.vector(0.3e-3)) * pose.rotation;
      return pose;
    };
    if (i % 2 == 0) {
      PoseSample brush = pose_sample(moved(iron ? bent(waved(t)) : waved(t)), t);
      session.samples.push_back({1, brush});
      const auto other = joined.tracker_from_other.inverse() * waved(t + 0.004) * joined.tool_from_other;
      PoseSample wand = pose_sample(moved({other.rotation, other.translation}), t + 0.004);
      wand.tool = "wand";
      session.samples.push_back({2, wand});
    }
    constexpr double half_s = 1e-4;
    ImuSample reading;
    reading.time.host = pose_sample({}, t + 0.005).time.host;
    reading.turn_rate_radps = tool_from_sensor.conjugate() *
                                  Eigen::Vector3d(turn_of(waved(t + 0.005 - half_s).rotation.conjugate() *
                                                          waved(t + 0.005 + half_s).rotation) /
                                                  (2 * half_s)) +
                              noise.vector(2e-3);
    session.samples.push_back({3, reading});
  }
  return session;
}

Result<CalibrationOutcome> calibrated(const Result<std::unique_ptr<Calibrator>>& calibrator,
                                      const Session& session) {
  if (!calibrator) return tl::unexpected(calibrator.error());
  return calibrate_session(**calibrator, session);
}

// Through a file and back.
Fields stored(const CalibrationOutcome& outcome) {
  const auto read = calibration_from_toml(toml_of({*outcome.result, outcome.report}), "test");
  EXPECT_TRUE(read) << read.error().message;
  return read ? read->result : Fields{};
}

TEST(CalibrateCommonMotion, TwoTrackersOfASession) {
  const auto outcome = calibrated(common_motion_calibrator({.tool = "brush", .other = "wand"}), scene());
  ASSERT_TRUE(outcome) << outcome.error().message;
  ASSERT_TRUE(outcome->result) << outcome->report.reason;
  const auto found = common_motion_from(stored(*outcome));
  ASSERT_TRUE(found);
  EXPECT_LT((found->tool_from_other.translation - joined.tool_from_other.translation).norm(), 0.1e-3);
  EXPECT_LT(found->tracker_from_other.rotation.angularDistance(joined.tracker_from_other.rotation), 1e-3);
  EXPECT_EQ(outcome->report.devices, (std::vector<std::string>{"0f44:ff20:A1", "1234:5678:B2"}));
  EXPECT_EQ(outcome->report.tool, "brush");
  EXPECT_FALSE(outcome->report.date.empty());
}

TEST(CalibrateCommonMotion, AToolThatIsNotThereIsNamed) {
  const auto outcome = calibrated(common_motion_calibrator({.other = "stick"}), scene(false, 1));
  ASSERT_FALSE(outcome);
  const auto other =
      calibrated(common_motion_calibrator({.tool = "brush", .other = "stick"}), scene(false, 1));
  ASSERT_FALSE(other);
  EXPECT_NE(other.error().message.find("no other tool 'stick'"), std::string::npos) << other.error().message;
}

TEST(CalibrateImuAxes, ATrackerAndAnInertialUnitOfASession) {
  const auto outcome = calibrated(imu_axes_calibrator({.tool = "brush"}), scene());
  ASSERT_TRUE(outcome) << outcome.error().message;
  ASSERT_TRUE(outcome->result) << outcome->report.reason;
  const auto found = sensor_axes_from(stored(*outcome));
  ASSERT_TRUE(found);
  EXPECT_LT(found->tool_from_sensor.angularDistance(tool_from_sensor), 1e-3);
  EXPECT_EQ(outcome->report.devices, (std::vector<std::string>{"0f44:ff20:A1", "2222:3333:C3"}));
  const auto none = calibrated(imu_axes_calibrator({.tool = "brush", .unit = "glove"}), scene(false, 1));
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().message.find("no inertial unit 'glove'"), std::string::npos) << none.error().message;
}

TEST(CalibrateDistortion, IronBesideAnUndisturbedTracker) {
  const auto outcome =
      calibrated(distortion_calibrator({.tool = "brush", .other = "wand"}, {}), scene(true, 60));
  ASSERT_TRUE(outcome) << outcome.error().message;
  ASSERT_TRUE(outcome->result) << outcome->report.reason;
  EXPECT_LT(*outcome->report.held_out_rms,
            0.3 * numbers_in(outcome->report.details, "before_rms_mm")->front());
  const auto field = distortion_from(stored(*outcome));
  ASSERT_TRUE(field);
  EXPECT_TRUE(corrected(*field, waved(7)).mapped);
  EXPECT_FALSE(corrected(*field, {{}, {2, 0, 0}}).mapped);
}

TEST(CalibrateDistortion, AGridTouchedPointByPoint) {
  const fs::path list = fs::path(testing::TempDir()) / ("fude-grid-" + std::to_string(getpid()) + ".csv");
  Session session;
  session.devices = {{1, {.id = "0f44:ff20:A1", .name = "magnetic", .kind = DeviceKind::tracker}}};
  {
    std::ofstream file(list);
    Noise noise(2);
    double t = 0;
    for (int i = 0; i < 64; ++i) {
      const Eigen::Vector3d mm(100 * (i % 4), 100 * (i / 4 % 4), 100 * (i / 16));
      file << "p" << i << "," << mm.x() << "," << mm.y() << "," << mm.z() << "\n";
      const auto seen =
          bent({Eigen::Quaterniond::Identity(), 1e-3 * mm + Eigen::Vector3d(-0.15, -0.15, 0.35)});
      for (int k = 0; k < 10; ++k, t += 0.03)
        session.samples.push_back(
            {1, pose_sample({seen.rotation, seen.translation + noise.vector(0.1e-3)}, t)});
    }
  }
  const DistortionWish wish{.grid = list, .tip_m = Eigen::Vector3d::Zero()};
  const auto outcome = calibrated(distortion_calibrator(wish, {}), session);
  ASSERT_TRUE(outcome) << outcome.error().message;
  ASSERT_TRUE(outcome->result) << outcome->report.reason;
  EXPECT_EQ(outcome->report.n, 64u);
  EXPECT_TRUE(distortion_from(stored(*outcome)));
  session.samples.resize(300);
  const auto few = calibrated(distortion_calibrator(wish, {}), session);
  ASSERT_TRUE(few) << few.error().message;
  EXPECT_FALSE(few->result);
  EXPECT_NE(few->report.reason.find("30 points were touched, but 64 are listed"), std::string::npos)
      << few->report.reason;
  fs::remove(list);
}

TEST(CalibrateDistortion, WithoutATruthItSaysWhatToGive) {
  EXPECT_EQ(distortion_calibrator({}, {}).error().fault, Fault::usage);
}

}  // namespace
}  // namespace fude
