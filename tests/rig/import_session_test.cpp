// Other people's recordings become sessions that paint.
#include "rig/import_session.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <map>

#include "capture/session.h"
#include "rig/sheet_plan.h"
#include "tests/fakes/recordings.h"

namespace fude {
namespace {

class ImportSession : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(session_); }

  Session imported(const char* file) {
    ImportWish wish;
    wish.overwrite = true;
    auto receipt = import_session(recordings() / file, session_, wish);
    EXPECT_TRUE(receipt) << receipt.error().message;
    if (receipt) receipt_ = std::move(*receipt);
    auto session = read_session(session_);
    EXPECT_TRUE(session) << session.error().message;
    return session ? std::move(*session) : Session{};
  }

  std::filesystem::path session_ =
      std::filesystem::path(testing::TempDir()) / ("fude-import-" + std::to_string(getpid()) + ".fude");
  ImportReceipt receipt_;
};

// Two trackers, their samples 0, 2, 4 … and 1, 3, 5 … ms, and actions before, between and after them.
TEST_F(ImportSession, InputsOfAllDevicesAndActionsAreInTheOrderOfTheirTimes) {
  using std::chrono::milliseconds;
  const Timestamp began{std::chrono::seconds(9)};
  std::vector<RawRecording> recordings(2);
  for (int i = 0; i < 20; ++i) {
    PositionSample sample;
    sample.time.host = began + milliseconds(i);
    recordings[static_cast<std::size_t>(i % 2)].samples.emplace_back(sample);
  }
  for (RawRecording& recording : recordings) recording.device.emplace().transport = "text";
  std::vector<Action> actions;
  for (const int ms : {-1, 7, 30}) actions.push_back({began + milliseconds(ms), DrySheet{}});
  ASSERT_TRUE(write_recordings(recordings, actions, "test", session_, true));
  const auto session = read_session(session_);
  ASSERT_TRUE(session);
  std::map<InputOrder, Timestamp> times;
  for (const RecordedSample& s : session->samples) {
    EXPECT_EQ(s.device, 1 + (std::get<PositionSample>(s.sample).time.host - began) / milliseconds(1) % 2);
    times[s.order] = std::get<PositionSample>(s.sample).time.host;
  }
  for (const RecordedAction& a : session->actions) times[a.order] = a.action.time;
  ASSERT_EQ(times.size(), 23U);
  Timestamp last{};
  for (const auto& [order, time] : times) {
    EXPECT_GE(time, last);
    last = time;
  }
}

TEST_F(ImportSession, RawPensAndInkHaveAPlaceOnTheSheet) {
  REQUIRE_RECORDING("hid/Wacom_Cintiq_22HD_056a_00FA.hid");
  for (const char* file :
       {"hid/Wacom_Cintiq_22HD_056a_00FA.hid", "hid/Wacom_PenPartner_hidrecord.txt",
        "usbhid/Huion_HS610/dumps_enabled_pen_coords.txt", "usbhid/UC-Logic_TWHL850/dumps_pen_tilt.txt",
        "strokes/bdalab_signal.svc", "strokes/wacom_uim_digital_ink_is_processable.csv.gz"}) {
    const Session session = imported(file);
    EXPECT_FALSE(session.pens.empty()) << file;
    const auto plan = plan_sheet(session, {});
    ASSERT_TRUE(plan) << file << plan.error().message;
    for (const RecordedPen& pen : session.pens) {
      if (!pen.sample.in_contact) continue;
      const Eigen::Vector2d nib = nib_on_paper(pen.sample, plan->mappings.at(pen.device));
      EXPECT_TRUE(nib.x() > -1 && nib.x() < plan->sheet.width.value + 1) << file;
      EXPECT_TRUE(nib.y() > -1 && nib.y() < plan->sheet.height.value + 1) << file;
    }
  }
}

TEST_F(ImportSession, RawReportsKeepTheirBytesAndDescriptor) {
  REQUIRE_RECORDING("hid/Wacom_Intuos_Pro_S_056a_0314.hid.gz");
  const Session session = imported("hid/Wacom_Intuos_Pro_S_056a_0314.hid.gz");
  ASSERT_EQ(session.devices.size(), 2U);
  EXPECT_EQ(session.transfers.size(), 5937U);
  EXPECT_EQ(session.devices[0].description.hid_descriptor.size(), 234U);
  EXPECT_EQ(session.devices[1].description.hid_descriptor.size(), 23U);
  EXPECT_TRUE(receipt_.streams[1].raw_only);                                     // its touch
  EXPECT_EQ(receipt_.streams[0].passed_over.at("reports 03 of 10 bytes"), 66U);  // its pad
  ASSERT_FALSE(session.passed_over.empty());
}

TEST_F(ImportSession, AJoyConRestsUnderGravity) {
  REQUIRE_RECORDING("joycon/joycon_uart_packets_part1.txt");
  const Session session = imported("joycon/joycon_uart_packets_part1.txt");
  ASSERT_EQ(session.samples.size(), 450U);
  std::vector<double> counts;
  for (const RecordedSample& s : session.samples)
    counts.push_back(std::get<ImuSample>(s.sample).specific_force_mps2.norm() / (0.000244 * 9.80665));
  std::sort(counts.begin(), counts.end());
  EXPECT_NEAR(counts[counts.size() / 2], 4118, 4);
  EXPECT_EQ(session.transfers.size(), 165U);
}

TEST_F(ImportSession, TheLineOfAFrameCounterStandsBesideItsTimes) {
  REQUIRE_RECORDING("tracker/plus_timestamp_filtering.csv");
  const Session session = imported("tracker/plus_timestamp_filtering.csv");
  ASSERT_EQ(session.samples.size(), 500U);
  ASSERT_EQ(session.clock_fits.size(), 1U);
  EXPECT_NEAR(session.clock_fits[0].line.tick_s, 0.017855, 1e-5);
  EXPECT_EQ(std::get<TickSample>(session.samples[0].sample).time.host,
            Timestamp(std::chrono::milliseconds(1840749051)));
}

TEST_F(ImportSession, EveryToolOfATrackerHasALineOfItsOwn) {
  REQUIRE_RECORDING("tracker/plus_transform_interpolation.csv");
  const Session session = imported("tracker/plus_transform_interpolation.csv");
  EXPECT_EQ(session.samples.size(), 1000U);
  ASSERT_EQ(session.clock_fits.size(), 2U);
  EXPECT_EQ(session.clock_fits[0].part, "probe");
  EXPECT_EQ(session.clock_fits[1].part, "ref");
  const auto invalid =
      std::count_if(session.samples.begin(), session.samples.end(), [](const RecordedSample& s) {
        const auto& pose = std::get<PoseSample>(s.sample);
        return pose.tool == "probe" && !pose.valid;
      });
  EXPECT_EQ(invalid, 1);
}

TEST_F(ImportSession, PicturesStandInTheSessionByteByByte) {
  REQUIRE_RECORDING("camera/opencv_left");
  const Session session = imported("camera/opencv_left");
  EXPECT_EQ(session.samples.size(), 13U);
  ASSERT_EQ(session.transfers.size(), 13U);
  EXPECT_EQ(session.transfers[0].transfer.payload.size(),
            std::filesystem::file_size(recordings() / "camera/opencv_left/left01.jpg"));
}

}  // namespace
}  // namespace fude
