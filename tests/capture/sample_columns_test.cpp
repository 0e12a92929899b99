// Every kind of sample goes into a session and comes back with the same bits.
#include "capture/sample_columns.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <set>

#include "capture/database.h"
#include "capture/session.h"
#include "capture/session_schema.h"
#include "capture/session_writer.h"

namespace fude {
namespace {

constexpr double third = 1.0 / 3;

SampleTime some_time(int i) {
  return {Timestamp(Duration(1'000'000'007LL * i)), StampedBy::arrival,
          0xfffffffffffffff0 + static_cast<unsigned>(i), 0x8000000000000001};
}

// Every field differs from its default.
std::vector<Sample> one_of_each() {
  std::vector<Sample> all;
  PenSample pen{.time = some_time(1),
                .tool = PenTool::airbrush,
                .tool_serial = 0xfedcba9876543210,
                .tool_id = 0xffffffff};
  pen.in_proximity = pen.in_contact = pen.after_gap = true;
  pen.x_counts = third;
  pen.y_counts = -0.1;
  pen.pressure = Fraction(0.2);
  pen.pressure_raw = -7;
  pen.tilt_x = Radians(-0.7);
  pen.tilt_y = Radians(0.3);
  pen.rotation = Radians(3);
  pen.distance = Fraction(0.4);
  pen.wheel = Fraction(0.9);
  pen.buttons = 5;
  all.push_back(pen);
  TouchSample touch{.time = some_time(2), .contact = -3, .down = true, .x_counts = 1.5, .y_counts = 2.5};
  touch.major_counts = 11;
  touch.minor_counts = third;
  touch.orientation = Radians(1);
  touch.pressure = Fraction(third);
  touch.palm = touch.after_gap = true;
  all.push_back(touch);
  ImuSample imu{
      .time = some_time(3), .turn_rate_radps = {third, -2, 3e-300}, .specific_force_mps2 = {1, 2, 9.81}};
  imu.magnetic_field_ut = Eigen::Vector3d(20, -third, 40);
  imu.temperature_c = 21.5;
  imu.battery = Fraction(third);
  imu.buttons = 3;
  imu.saturated = imu.after_gap = true;
  imu.valid = false;
  all.push_back(imu);
  PoseSample pose{.time = some_time(4), .tool = "probe 1", .origin = PoseOrigin::interpolated};
  pose.tracker_from_tool = {Eigen::Quaterniond(0.5, -0.5, 0.5, third), {third, -2, 3}};
  pose.covariance.emplace();
  for (int i = 0; i < 36; ++i) (*pose.covariance)(i / 6, i % 6) = third * i;
  pose.residual_m = 1e-4;
  pose.buttons = 9;
  pose.valid = false;
  pose.after_gap = true;
  all.push_back(pose);
  PositionSample position{
      .time = some_time(5), .marker = "a \"marker\"", .tracker_from_marker_m = {1, third, 3}};
  position.covariance_m2 = Eigen::Matrix3d::Identity() * third;
  position.residual_m = 2e-4;
  position.valid = false;
  position.after_gap = true;
  all.push_back(position);
  RangeSample range{.time = some_time(6), .receivers = 5};
  range.flight_s = {third, {}, 3e-3};
  range.amplitude = {0.1, 0, third};
  range.temperature_c = -4;
  range.after_gap = true;
  all.push_back(range);
  all.push_back(PuckSample{some_time(7), {third, -1, 1}, {0.1, 0.2, 0.3}, 0x80000001, true});
  GloveSample glove{.time = some_time(8),
                    .bend = {Fraction(0.1), Fraction(0.2), Fraction(third), Fraction(0.4), Fraction(1)}};
  glove.lights[0] = Eigen::Vector3d(1, third, 3);
  glove.lights[7] = Eigen::Vector3d(-1, 0, 0);
  glove.buttons = 4;
  glove.after_gap = true;
  all.push_back(glove);
  HapticSample haptic{
      some_time(9), {third, 2, 3}, {4, 5, 6}, {7, 8, third}, {1, -2, std::numeric_limits<int>::min()}, 6};
  haptic.homed = haptic.after_gap = true;
  all.push_back(haptic);
  all.push_back(
      CameraFrame{some_time(10), ExposureMoment::end, PixelFormat::png, 640, 480, third, true, true});
  all.push_back(TickSample{some_time(11), true});
  return all;
}

std::vector<Cell> cells(const Sample& sample) {
  std::vector<Cell> row;
  for (const SampleColumn& column : sample_tables()[sample.index()].columns)
    row.push_back(column.get(sample));
  return row;
}

template <class T>
void expect_same(const T& a, const T& b) {
  EXPECT_TRUE(a == b);
}
void expect_same(const PoseSample& a, const PoseSample& b) {
  EXPECT_EQ(a.time, b.time);
  EXPECT_EQ(a.tool, b.tool);
  EXPECT_EQ(a.origin, b.origin);
  EXPECT_EQ(a.tracker_from_tool.rotation.coeffs(), b.tracker_from_tool.rotation.coeffs());
  EXPECT_EQ(a.tracker_from_tool.translation, b.tracker_from_tool.translation);
  EXPECT_EQ(a.covariance, b.covariance);
  EXPECT_EQ(a.residual_m, b.residual_m);
  EXPECT_EQ(a.buttons, b.buttons);
  EXPECT_EQ(a.valid, b.valid);
  EXPECT_EQ(a.after_gap, b.after_gap);
}
void expect_same(const PositionSample& a, const PositionSample& b) {
  EXPECT_EQ(a.time, b.time);
  EXPECT_EQ(a.marker, b.marker);
  EXPECT_EQ(a.tracker_from_marker_m, b.tracker_from_marker_m);
  EXPECT_EQ(a.covariance_m2, b.covariance_m2);
  EXPECT_EQ(a.residual_m, b.residual_m);
  EXPECT_EQ(a.valid, b.valid);
  EXPECT_EQ(a.after_gap, b.after_gap);
}
void expect_same(const GloveSample& a, const GloveSample& b) {
  EXPECT_EQ(a.time, b.time);
  EXPECT_EQ(a.bend, b.bend);
  EXPECT_EQ(a.lights, b.lights);
  EXPECT_EQ(a.buttons, b.buttons);
  EXPECT_EQ(a.after_gap, b.after_gap);
}

class SampleColumns : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::remove(path_); }
  void TearDown() override { std::filesystem::remove(path_); }

  std::filesystem::path path_ = std::filesystem::temp_directory_path() /
                                ("fude-columns-" + std::to_string(getpid()) +
                                 testing::UnitTest::GetInstance()->current_test_info()->name() + ".fude");
};

TEST_F(SampleColumns, EveryKindComesBackBitForBit) {
  const std::vector<Sample> samples = one_of_each();
  ASSERT_EQ(samples.size(), std::variant_size_v<Sample>);
  SessionWriter out = SessionWriter::create(path_).value();
  const DeviceNumber device = out.add_device({}).value();
  std::vector<InputOrder> orders;
  // Full samples and blank ones, in an order that mixes the tables.
  for (const Sample& sample : samples) orders.push_back(out.add_sample(device, sample).value());
  for (const SampleTable& table : sample_tables()) (void)out.add_sample(device, table.blank).value();
  ASSERT_TRUE(out.close());

  const auto session = read_session(path_);
  ASSERT_TRUE(session.has_value()) << session.error().message;
  ASSERT_EQ(session->pens.size(), 2U);
  EXPECT_EQ(session->pens[0].sample, std::get<PenSample>(samples[0]));
  EXPECT_EQ(session->pens[1].sample, PenSample{});
  ASSERT_EQ(session->samples.size(), 2 * (samples.size() - 1));
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const RecordedSample& read = session->samples[i - 1];
    EXPECT_EQ(read.order, orders[i]);
    EXPECT_EQ(read.device, device);
    ASSERT_EQ(read.sample.index(), samples[i].index());
    EXPECT_EQ(cells(read.sample), cells(samples[i])) << i;
    std::visit([&](const auto& a) { expect_same(a, std::get<std::decay_t<decltype(a)>>(samples[i])); },
               read.sample);
    EXPECT_EQ(cells(session->samples[samples.size() - 2 + i].sample), cells(sample_tables()[i].blank)) << i;
  }
}

TEST(SampleColumnNames, AreUniqueAndBeginWithTheTime) {
  for (const SampleTable& table : sample_tables()) {
    std::set<std::string> names;
    for (const SampleColumn& column : table.columns)
      EXPECT_TRUE(names.insert(column.name).second) << column.name;
    EXPECT_EQ(table.columns[0].name, "time_ns");
    EXPECT_EQ(table.columns[3].name, "device_tick");
  }
}

TEST_F(SampleColumns, AStrangersValuesAreRefusedOrBecomeHarmless) {
  for (const char* change :
       {"UPDATE camera_sample SET format='jpeg2000'", "UPDATE camera_sample SET width=3000000000",
        "UPDATE pose_sample SET covariance='1 2 3'",
        "UPDATE pose_sample SET covariance=printf('%.*c',1000000,'1')",
        "UPDATE range_sample SET receivers=300", "UPDATE imu_sample SET field_x_ut=NULL",
        "UPDATE pose_sample SET origin=x'00ff'", "UPDATE touch_sample SET palm=7"}) {
    std::filesystem::remove(path_);
    {
      SessionWriter out = SessionWriter::create(path_).value();
      for (const Sample& sample : one_of_each()) (void)out.add_sample(1, sample).value();
      ASSERT_TRUE(out.close());
    }
    {
      Database db = Database::open(path_, OpenMode::append).value();
      ASSERT_TRUE(db.run(change)) << change;
    }
    const auto session = read_session(path_);
    ASSERT_FALSE(session.has_value()) << change;
    EXPECT_EQ(session.error().fault, Fault::malformed) << change;
    EXPECT_EQ(session.error().message.find('\n'), std::string::npos);
  }
  Database db = Database::open(path_, OpenMode::append).value();
  ASSERT_TRUE(
      db.run("UPDATE touch_sample SET palm=1; UPDATE haptic_sample SET force_x_n=9e999; "
             "UPDATE puck_sample SET push_x='left'"));
  const auto session = read_session(path_);
  ASSERT_TRUE(session.has_value()) << session.error().message;
  for (const RecordedSample& s : session->samples) {
    if (const auto* haptic = std::get_if<HapticSample>(&s.sample)) {
      EXPECT_EQ(haptic->force_n.x(), 0);
    }
    if (const auto* puck = std::get_if<PuckSample>(&s.sample)) {
      EXPECT_EQ(puck->push.x(), 0);
    }
  }
}

// What the first format wrote, column by column: files of that format must go on being read.
TEST_F(SampleColumns, TheFirstFormatIsStillRead) {
  constexpr const char* pen_table =
      "CREATE TABLE pen_sample(input INTEGER PRIMARY KEY, device INTEGER NOT NULL, time_ns INTEGER NOT NULL, "
      "stamped_by TEXT NOT NULL, sequence INTEGER NOT NULL, device_tick INTEGER, tool TEXT NOT NULL, "
      "tool_serial INTEGER NOT NULL, tool_id INTEGER NOT NULL, in_proximity INTEGER NOT NULL, "
      "in_contact INTEGER NOT NULL, x_counts REAL NOT NULL, y_counts REAL NOT NULL, pressure REAL NOT NULL, "
      "pressure_raw INTEGER NOT NULL, tilt_x_rad REAL, tilt_y_rad REAL, rotation_rad REAL, distance REAL, "
      "wheel REAL, buttons INTEGER NOT NULL, after_gap INTEGER NOT NULL)";
  const auto tables = session_schema::tables(1);
  EXPECT_NE(std::find(tables.begin(), tables.end(), pen_table), tables.end());
  EXPECT_EQ(tables.size(), 11U);
  {
    Database db = Database::open(path_, OpenMode::create).value();
    std::string sql = "PRAGMA application_id=1718969445; PRAGMA user_version=1;";
    for (const std::string& table : tables) sql += table + ";";
    sql +=
        "INSERT INTO meta VALUES('complete','yes');"
        "INSERT INTO device VALUES(1,'056a:0304:','A "
        "tablet','tablet','evdev',3,1386,772,0,'','[320]','[]',200,NULL,NULL);"
        "INSERT INTO transfer VALUES(1,1,5,'kernel','from','evdev',x'0000000000000000');"
        "INSERT INTO pen_sample "
        "VALUES(1,1,5,'kernel',12,NULL,'pen',7,2,1,1,10.5,20,0.25,255,0.5,NULL,NULL,NULL,NULL,1,0);"
        "INSERT INTO applied VALUES(1,3);";
    ASSERT_TRUE(db.run(sql));
  }
  const auto session = read_session(path_);
  ASSERT_TRUE(session.has_value()) << session.error().message;
  ASSERT_EQ(session->pens.size(), 1U);
  EXPECT_EQ(session->pens[0].applied, 3);
  EXPECT_EQ(session->pens[0].sample.x_counts, 10.5);
  EXPECT_EQ(session->pens[0].sample.tilt_x, Radians(0.5));
  EXPECT_FALSE(session->pens[0].sample.tilt_y.has_value());
  ASSERT_EQ(session->transfers.size(), 1U);
  EXPECT_EQ(session->transfers[0].transfer.endpoint, 0);
  EXPECT_EQ(session->devices[0].description.width, Millimetres(200));
  EXPECT_FALSE(session->devices[0].description.clock.has_value());
}

}  // namespace
}  // namespace fude
