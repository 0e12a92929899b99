// Live devices give what their recording gives; a device that is faster than the procedure costs no memory.
#include "rig/calibration/live_hearing.h"

#include <gtest/gtest.h>

#include <atomic>
#include <condition_variable>
#include <thread>

#include "rig/calibration/calibrate_session.h"
#include "rig/calibration/pivot.h"
#include "tests/fakes/scripted_tracker.h"

namespace fude {
namespace {

const DeviceDescription tracker{.id = "0f44:ff20:A1", .name = "Liberty", .kind = DeviceKind::tracker};

TEST(LiveHearing, GivesWhatTheRecordingGives) {
  Session session;
  session.devices.push_back({1, tracker});
  const auto live = pivot_calibrator({});
  LiveHearing hearing(*live);
  hearing.begin(0, tracker);
  for (const PoseSample& pose : ScriptedPivot{.noise_m = 1e-4}.samples()) {
    session.samples.push_back({1, pose});
    const Sample heard[] = {pose};
    hearing.hear(0, {.time = pose.time.host, .kind = TransferKind::serial}, heard);
  }
  const auto outcome = hearing.finish();
  const auto recorded = calibrate_session(*pivot_calibrator({}), session);
  ASSERT_TRUE(outcome && outcome->result && recorded && recorded->result);
  EXPECT_EQ(numbers_in(*outcome->result, "tip_m"), numbers_in(*recorded->result, "tip_m"));
  EXPECT_EQ(outcome->report.devices, recorded->report.devices);
  EXPECT_EQ(outcome->report.tool, "brush");
  EXPECT_EQ(outcome->report.date.size(), recorded->report.date.size());
  EXPECT_EQ(hearing.progress()->covered, 1);
}

TEST(LiveHearing, TwoToolsEndIt) {
  const auto live = pivot_calibrator({});
  LiveHearing hearing(*live);
  hearing.begin(0, tracker);
  for (const char* tool : {"brush", "easel", "brush"}) {
    const Sample heard[] = {PoseSample{.tool = tool}};
    hearing.hear(0, {}, heard);
  }
  const auto outcome = hearing.finish();
  ASSERT_FALSE(outcome);
  EXPECT_NE(outcome.error().message.find("(brush, easel)"), std::string::npos) << outcome.error().message;
  EXPECT_FALSE(hearing.progress());
}

// Hears its first sample only when it is let.
class Slow final : public Calibrator {
 public:
  void begin(DeviceNumber, const DeviceDescription&) override {}
  Result<Progress> hear(DeviceNumber, const Sample&, const Transfer* picture) override {
    hearing_ = true;
    hearing_.notify_all();
    let_.wait(false);
    pictures += picture != nullptr;
    return Progress{++heard, 0, {}};
  }
  Result<CalibrationOutcome> finish() override { return CalibrationOutcome{}; }

  void wait_until_it_hears() { hearing_.wait(false); }
  void let() {
    let_ = true;
    let_.notify_all();
  }
  std::size_t heard = 0, pictures = 0;

 private:
  std::atomic<bool> hearing_{false}, let_{false};
};

TEST(LiveHearing, WhatIsTooFastIsLeftOutAndCounted) {
  Slow slow;
  LiveHearing hearing(slow, {.inputs = 10, .pictures = 2});
  const Sample imu[] = {ImuSample{}};
  hearing.hear(0, {}, imu);
  slow.wait_until_it_hears();
  const Sample frame[] = {CameraFrame{}};
  for (int i = 0; i < 5; ++i)
    hearing.hear(1, {.kind = TransferKind::picture, .payload = {std::byte{1}}}, frame);
  for (int i = 0; i < 20; ++i) hearing.hear(0, {}, imu);
  slow.let();
  const auto outcome = hearing.finish();
  ASSERT_TRUE(outcome);
  EXPECT_EQ(slow.heard, 1U + 2U + 8U);
  EXPECT_EQ(slow.pictures, 2U);
  ASSERT_EQ(outcome->report.warnings.size(), 1U);
  EXPECT_EQ(outcome->report.warnings.front().substr(0, 11), "12 samples ");
}

TEST(LiveHearing, EndsWithoutAResultToo) {
  const auto live = pivot_calibrator({});
  LiveHearing hearing(*live);
  hearing.begin(0, tracker);
}

}  // namespace
}  // namespace fude
