#include "capture/export/csv_export.h"

#include <gtest/gtest.h>

#include <sstream>

namespace fude {
namespace {

using std::chrono::milliseconds;

DeviceDescription named(const std::string& name) {
  DeviceDescription d;
  d.name = name;
  return d;
}

PoseSample pose(int ms, const std::string& tool, double x_m) {
  PoseSample s;
  s.time.host = Timestamp(milliseconds(ms));
  s.tool = tool;
  s.tracker_from_tool.translation.x() = x_m;
  return s;
}

std::vector<std::string> lines(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> all;
  for (std::string line; std::getline(in, line);) all.push_back(line);
  return all;
}

Session tracker() {
  Session s;
  s.devices = {{1, named("tracker")}};
  for (int i = 0; i < 4; ++i) {
    s.samples.push_back({1, pose(20 * i, "probe", 0.001 * i), 0});
    s.samples.push_back({1, pose(20 * i, "ref", 1), 0});
  }
  return s;
}

TEST(Streams, AreNamedAfterDeviceAndTool) {
  Session s = tracker();
  s.devices.push_back({2, named("pad")});
  s.devices.push_back({3, named("pad")});
  s.pens.push_back({1, 2, {}, {}});
  s.pens.push_back({2, 3, {}, {}});
  s.samples.push_back({3, TouchSample{}, 0});
  std::vector<std::string> names;
  for (const SessionStream& stream : streams_of(s)) names.push_back(stream.name);
  EXPECT_EQ(names,
            (std::vector<std::string>{"tracker/probe", "tracker/ref", "pad #2", "pad #3 pen", "pad #3 touch"}));
  EXPECT_EQ(find_stream(s, "tracker/ref")->part, "ref");
  EXPECT_EQ(find_stream(s, "probe")->name, "tracker/probe");
  EXPECT_EQ(find_stream(s, "touch")->name, "pad #3 touch");
  const auto unknown = find_stream(s, "pen");
  ASSERT_FALSE(unknown.has_value());  // two of them
  EXPECT_NE(unknown.error().message.find("tracker/probe, tracker/ref, pad #2"), std::string::npos);
  EXPECT_EQ(unknown.error().message.find('\n'), std::string::npos);
}

TEST(CsvExport, EverySampleWithItsTimeAsTheClockHasIt) {
  Session s;
  DeviceDescription clock = named("clock");
  clock.clock = DeviceClock{};
  s.devices = {{1, clock}};
  // A tick is 10 ms; the third reading came 4 ms late.
  for (int i = 0; i < 40; ++i) {
    TickSample tick;
    tick.time = {Timestamp(milliseconds(1000 + 10 * i + (i == 2 ? 4 : 0))), StampedBy::arrival,
                 static_cast<std::uint64_t>(i), 100U + static_cast<unsigned>(i)};
    tick.after_gap = i == 3;
    s.samples.push_back({1, tick, i});
  }
  const auto rows = lines(csv_of(s, find_stream(s, "clock").value()));
  ASSERT_EQ(rows.size(), 42U);
  EXPECT_EQ(rows[0].front(), '#');
  EXPECT_EQ(rows[1], "host_s,tick,sequence,fitted_s,valid,stamped_by,after_gap");
  EXPECT_EQ(rows[2], "1.000000000,100,0,1.000000000,1,arrival,0");
  EXPECT_EQ(rows[4], "1.024000000,102,2,1.020000000,1,arrival,0");
  EXPECT_EQ(rows[5], "1.030000000,103,3,1.030000000,1,arrival,1");
  // A recorded line goes before one that is fitted now.
  ClockLine line;
  line.first_tick = 100;
  line.offset = Timestamp(milliseconds(2000));
  line.tick_s = 0.5;
  s.clock_fits.push_back({1, "", line});
  EXPECT_EQ(lines(csv_of(s, find_stream(s, "clock").value()))[3], "1.010000000,101,1,2.500000000,1,arrival,0");
}

TEST(CsvExport, NumbersReadBackToTheSameBitsAndWhatIsNotThereIsEmpty) {
  Session s;
  s.devices = {{1, named("imu")}};
  ImuSample imu{.turn_rate_radps = {1.0 / 3, 0.1 + 0.2, -1e-300}};
  imu.time.host = Timestamp(Duration(-1));
  imu.valid = false;
  s.samples.push_back({1, imu, 0});
  const auto rows = lines(csv_of(s, find_stream(s, "imu").value()));
  EXPECT_NE(rows[0].find("turn_x_radps rad/s"), std::string::npos);
  EXPECT_EQ(rows[1],
            "host_s,tick,sequence,fitted_s,valid,stamped_by,turn_x_radps,turn_y_radps,turn_z_radps,force_x_mps2,"
            "force_y_mps2,force_z_mps2,field_x_ut,field_y_ut,field_z_ut,temperature_c,battery,buttons,saturated,"
            "after_gap");
  EXPECT_EQ(rows[2], "-0.000000001,,0,,0,kernel,0.3333333333333333,0.30000000000000004,-1e-300,0,0,0,,,,,,0,0,0");
}

TEST(CsvExport, PosesAtAskedTimesSayHowTheyWereMade) {
  const Session s = tracker();
  const auto times = read_times("t_s,x\n0.02,1\n0.03,1\n0.1,1\n").value();
  const auto rows = lines(poses_at(s, find_stream(s, "probe").value(), times, milliseconds(100)).value());
  ASSERT_EQ(rows.size(), 5U);
  EXPECT_EQ(rows[1], "host_s,how,qw,qx,qy,qz,x_m,y_m,z_m");
  EXPECT_EQ(rows[2], "0.020000000,measured,1,0,0,0,0.001,0,0");
  EXPECT_EQ(rows[3], "0.030000000,interpolated,1,0,0,0,0.0015,0,0");
  EXPECT_EQ(rows[4], "0.100000000,none,,,,,,,");
  EXPECT_NE(poses_at(s, find_stream(s, "probe").value(), times, milliseconds(10))->find("0.030000000,none"),
            std::string::npos);
}

TEST(CsvExport, TimesMayStandAlone) {
  EXPECT_EQ(read_times("# when\n0.5\n1\n")->size(), 2U);
  EXPECT_EQ(read_times("host_s\n0.5\n")->front(), Timestamp(milliseconds(500)));
  EXPECT_EQ(read_times("0.5\nsoon\n").error().message.find("line 2"), 0U);
  EXPECT_EQ(read_times("t_s\n0.5\nsoon\n").error().message.find("row 2"), 0U);
}

}  // namespace
}  // namespace fude
