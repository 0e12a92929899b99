// Tables of finished values: what stands in them comes out as samples, what cannot be understood is counted.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "capture/import/import.h"
#include "tests/fakes/recordings.h"

namespace fude {
namespace {

using namespace std::string_literals;

std::vector<RawRecording> imported(const std::string& text, const ImportOptions& options = {}) {
  auto file = import_bytes(text, options);
  EXPECT_TRUE(file) << file.error().message;
  return file ? std::move(file->recordings) : std::vector<RawRecording>(2);
}

template <class S>
const S& sample(const RawRecording& recording, std::size_t i) {
  return std::get<S>(recording.samples.at(i));
}

Error refused(const std::string& text, const ImportOptions& options = {}) {
  const auto file = import_bytes(text, options);
  EXPECT_FALSE(file.has_value());
  if (file) return {};
  EXPECT_EQ(file.error().message.find('\n'), std::string::npos);
  return file.error();
}

const std::string imu_names = "t_s,gyr_x_radps,gyr_y_radps,gyr_z_radps,acc_x_mps2,acc_y_mps2,acc_z_mps2";

TEST(ImuCsv, RowsBecomeSamplesAndPosesOfTheOpticalSystem) {
  const auto recordings =
      imported(imu_names +
               ",mag_x_uT,mag_y_uT,mag_z_uT,opt_qw,opt_qx,opt_qy,opt_qz,opt_x_m,opt_y_m,opt_z_m,movement\n"
               "0.0000,1,2,3,0.1,0.2,9.8,20,21,22,0.6,0,0.8,0,1,2,3,0\n"
               "0.0035,1,2,3,0.1,0.2,9.8,20,21,22,nan,nan,nan,nan,nan,nan,nan,1\n");
  ASSERT_EQ(recordings.size(), 2U);
  ASSERT_EQ(recordings[0].samples.size(), 2U);
  const auto& imu = sample<ImuSample>(recordings[0], 1);
  EXPECT_EQ(imu.time.host, Timestamp(std::chrono::microseconds(3500)));
  EXPECT_EQ(imu.time.stamped_by, StampedBy::recording);
  EXPECT_EQ(imu.turn_rate_radps, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(imu.specific_force_mps2, Eigen::Vector3d(0.1, 0.2, 9.8));
  EXPECT_EQ(imu.magnetic_field_ut, Eigen::Vector3d(20, 21, 22));
  EXPECT_EQ(imu.buttons, 1U);
  const auto& seen = sample<PoseSample>(recordings[1], 0);
  EXPECT_TRUE(seen.valid);
  EXPECT_NEAR(seen.tracker_from_tool.rotation.y(), 0.8, 1e-15);
  EXPECT_EQ(seen.tracker_from_tool.translation, Eigen::Vector3d(1, 2, 3));
  const auto& lost = sample<PoseSample>(recordings[1], 1);
  EXPECT_FALSE(lost.valid);
  EXPECT_EQ(lost.origin, PoseOrigin::none);
}

TEST(ImuCsv, RowsThatCannotBeReadAreCountedAndTheRestGoesOn) {
  const auto recordings = imported(imu_names +
                                   "\n0.1,1,2,3,4,5,6\n0.2,1,2,three,4,5,6\n0.3,1,2\n0.05,1,2,3,4,5,6\n"
                                   "soon,1,2,3,4,5,6\n0.4,nan,2,3,4,5,6\n");
  ASSERT_EQ(recordings[0].samples.size(), 2U);
  EXPECT_FALSE(sample<ImuSample>(recordings[0], 1).valid);
  EXPECT_EQ(recordings[0].passed_over.at("rows without all their numbers"), 2U);
  EXPECT_EQ(recordings[0].passed_over.at("rows whose time runs backwards"), 1U);
  EXPECT_EQ(recordings[0].passed_over.at("rows without a time"), 1U);
}

TEST(PosesCsv, AMatrixAndAQuaternionAreTheSamePose) {
  // A quarter turn about z.
  const auto recording = imported(
      "t_s,a_m00,a_m01,a_m02,a_m03,a_m10,a_m11,a_m12,a_m13,a_m20,a_m21,a_m22,a_m23,a_ok,"
      "b_qw,b_qx,b_qy,b_qz,b_x,b_y,b_z\n"
      "0.5,0,-1,0,10,1,0,0,20,0,0,1,30,1,0.70710678118654752,0,0,0.70710678118654752,10,20,30\n")[0];
  ASSERT_EQ(recording.samples.size(), 2U);
  const auto &a = sample<PoseSample>(recording, 0), &b = sample<PoseSample>(recording, 1);
  EXPECT_EQ(a.tool, "a");
  EXPECT_EQ(b.tool, "b");
  EXPECT_TRUE(a.valid && b.valid);
  EXPECT_NEAR(a.tracker_from_tool.rotation.angularDistance(b.tracker_from_tool.rotation), 0, 1e-7);
  for (const auto* pose : {&a, &b}) {
    EXPECT_NEAR((pose->tracker_from_tool.translation - Eigen::Vector3d(0.01, 0.02, 0.03)).norm(), 0, 1e-15);
    EXPECT_NEAR((pose->tracker_from_tool * Eigen::Vector3d(1, 0, 0)).y(), 1.02, 1e-12);
  }
}

TEST(PosesCsv, UnitRateCounterAndWhatWasNotSeen) {
  ImportOptions options;
  options.metres_per_unit = 1;
  options.rate_hz = 50;
  const auto recording = imported(
      "FrameNumber,p_qw,p_qx,p_qy,p_qz,p_x,p_y,p_z,p_ok\n"
      "100,1,0,0,0,1,2,3,1\n101,1,0,0,0,1,2,3,0\n103,2,0,0,0,1,2,3,1\n103,1,0,0,0,nan,2,3,1\n",
      options)[0];
  ASSERT_EQ(recording.samples.size(), 4U);
  EXPECT_EQ(sample<PoseSample>(recording, 0).tracker_from_tool.translation.x(), 1);
  EXPECT_EQ(sample<PoseSample>(recording, 1).time.host, Timestamp(std::chrono::milliseconds(20)));
  EXPECT_EQ(sample<PoseSample>(recording, 2).time.host, Timestamp(std::chrono::milliseconds(60)));
  EXPECT_EQ(sample<PoseSample>(recording, 2).time.device_tick, 103U);
  EXPECT_TRUE(recording.device->clock.has_value());
  for (std::size_t i : {1U, 2U, 3U}) EXPECT_FALSE(sample<PoseSample>(recording, i).valid) << i;
  EXPECT_EQ(recording.passed_over.at("poses of p that are no rotation, kept as not valid"), 1U);
}

TEST(PosesCsv, WithoutTimesARateIsAskedFor) {
  const std::string text = "frame,p_qw,p_qx,p_qy,p_qz,p_x,p_y,p_z\n0,1,0,0,0,0,0,0\n";
  EXPECT_NE(refused(text).message.find("--rate-hz"), std::string::npos);
  ImportOptions options;
  options.rate_hz = -1;
  EXPECT_EQ(refused(text, options).fault, Fault::usage);
}

TEST(TimestampsCsv, TimesStayAsTheyStandAndTheNumberIsTheTick) {
  const auto recording = imported(
      "frame_number,timestamp_filtered_s,timestamp_unfiltered_s\n5539,9.0,1840749.051\n5541,9.5,1840749."
      "050\nx,1,2\n")[0];
  ASSERT_EQ(recording.samples.size(), 2U);
  const auto& second = sample<TickSample>(recording, 1);
  EXPECT_EQ(second.time.host, Timestamp(std::chrono::milliseconds(1840749050)));
  EXPECT_EQ(second.time.device_tick, 5541U);
  EXPECT_EQ(recording.passed_over.at("rows without a frame number or a time"), 1U);
}

TEST(Svc, MillimetresPressureAndLean) {
  const auto recording = imported(
      "4\r\n52.81 81.31 0.000 1 0.0 450.0 0.25\r\n52.9 81.4 0.008 0 900 450 0\n1 2 3\n53 81 0.016 1 0 900 "
      "2\n")[0];
  ASSERT_EQ(recording.samples.size(), 2U);
  const auto& right = sample<PenSample>(recording, 0);
  EXPECT_EQ(right.x_counts, 52.81);
  EXPECT_EQ(right.y_counts, 81.31);
  EXPECT_EQ(recording.device->mm_per_count, 1);
  EXPECT_TRUE(right.in_contact);
  EXPECT_EQ(right.pressure, Fraction(0.25));
  EXPECT_NEAR(right.tilt_x->value, std::numbers::pi / 4, 1e-14);  // 45 degrees to the right
  EXPECT_NEAR(right.tilt_y->value, 0, 1e-14);
  const auto& near = sample<PenSample>(recording, 1);
  EXPECT_FALSE(near.in_contact);
  EXPECT_TRUE(near.in_proximity);
  EXPECT_NEAR(near.tilt_y->value, std::numbers::pi / 4, 1e-14);  // towards the painter
  EXPECT_EQ(recording.passed_over.at("lines that are not seven numbers"), 1U);
  EXPECT_EQ(recording.passed_over.at("rows whose pressure is not between 0 and 1"), 1U);
}

TEST(Svc, APublishedRecordingIsWhole) {
  REQUIRE_RECORDING("strokes/bdalab_signal.svc");
  const auto file = import_file(recordings() / "strokes/bdalab_signal.svc", {});
  ASSERT_TRUE(file) << file.error().message;
  EXPECT_EQ(file->format, ImportFormat::svc);
  const RawRecording& recording = file->recordings[0];
  ASSERT_EQ(recording.samples.size(), 1378U);
  EXPECT_TRUE(recording.passed_over.empty());
  std::size_t hovering = 0;
  for (const Sample& s : recording.samples) hovering += !std::get<PenSample>(s).in_contact;
  EXPECT_EQ(hovering, 559U);
}

TEST(WacomInkCsv, ThePenLeavesBetweenStrokes) {
  const auto recording = imported(
      "idx,SPLINE_X,SPLINE_Y,SENSOR_TIMESTAMP,SENSOR_PRESSURE,SENSOR_ALTITUDE,SENSOR_AZIMUTH\n"
      "0,277,183,1722443386312.5,0.07,1.5707963267948966,0\n0,278,184,1722443386320,0.5,0.6,0.7\n"
      "1,300,200,1722443387000,0.5,0.6,nan\n")[0];
  ASSERT_EQ(recording.samples.size(), 5U);
  EXPECT_EQ(sample<PenSample>(recording, 0).time.host.time_since_epoch(), Duration(1722443386312500000));
  EXPECT_NEAR(sample<PenSample>(recording, 0).tilt_x->value, 0, 1e-12);
  EXPECT_TRUE(sample<PenSample>(recording, 1).in_contact);
  for (const std::size_t i : {2U, 4U}) {
    EXPECT_EQ(sample<PenSample>(recording, i).tool, PenTool::none);
    EXPECT_EQ(sample<PenSample>(recording, i).time.host, sample<PenSample>(recording, i - 1).time.host);
  }
  EXPECT_FALSE(sample<PenSample>(recording, 3).tilt_x.has_value());
  EXPECT_EQ(recording.device->mm_per_count, 25.4 / 96);
}

TEST(WacomInkCsv, ThePublishedRecordingsAreWhole) {
  REQUIRE_RECORDING("strokes/wacom_ink_sensor.csv");
  struct Expected {
    const char* file;
    std::size_t rows, strokes;
  };
  for (const Expected e : {Expected{"strokes/wacom_ink_sensor.csv", 880, 4},
                           Expected{"strokes/wacom_uim_digital_ink_is_processable.csv.gz", 2787, 177}}) {
    const auto file = import_file(recordings() / e.file, {});
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_EQ(file->format, ImportFormat::wacom_ink_csv);
    EXPECT_EQ(file->recordings[0].samples.size(), e.rows + e.strokes);
    EXPECT_TRUE(file->recordings[0].passed_over.empty());
  }
}

TEST(Tables, ImpossibleFilesGiveOneLine) {
  EXPECT_EQ(refused(imu_names + "\n").fault, Fault::malformed);
  ImportOptions options;
  for (const ImportFormat format :
       {ImportFormat::imu_csv, ImportFormat::poses_csv, ImportFormat::timestamps_csv, ImportFormat::svc,
        ImportFormat::wacom_ink_csv, ImportFormat::hid_recorder, ImportFormat::usbhid_dump,
        ImportFormat::joycon_uart}) {
    options.format = format;
    EXPECT_EQ(refused("a,b,c\n1,2,3\n", options).fault, Fault::malformed) << name_of(format);
  }
}

}  // namespace
}  // namespace fude
