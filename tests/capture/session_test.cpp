#include "capture/session.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>

#include "capture/action_words.h"
#include "capture/database.h"
#include "capture/session_schema.h"
#include "capture/session_writer.h"

namespace fude {
namespace {

class SessionFile : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              ("fude-session-" + std::to_string(getpid()) + "-" +
               testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path path() const { return folder_ / "a.fude"; }

  std::filesystem::path folder_;
};

DeviceDescription tablet() {
  DeviceDescription d;
  d.id = "056a:0304:7";
  d.name = "A tablet";
  d.kind = DeviceKind::pen_tablet;
  d.transport = "evdev";
  d.vendor = 0x056a;
  d.product = 0x0304;
  d.serial = "7";
  d.keys = {320, 330};
  d.axes = {{0, 0, 59552, 4, 0, 200, 0}, {24, 0, 1023, 0, 0, 0, 0}};
  d.width = Millimetres(297.76);
  d.clock = DeviceClock{16, 1e-3};
  d.hid_descriptor = {std::byte{5}, std::byte{0x0d}};
  return d;
}

PenSample pen(std::int64_t ns) {
  PenSample p;
  p.time.host = Timestamp(Duration(ns));
  p.time.sequence = 12;
  p.tool = PenTool::rubber;
  p.tool_serial = 0xfedcba9876543210;
  p.in_proximity = true;
  p.x_counts = 0.1 + 0.2;
  p.pressure = Fraction(1.0 / 3.0);
  p.tilt_x = Radians(-0.7);
  p.buttons = 2;
  return p;
}

ClockLine fitted() {
  ClockLine line;
  line.first_reading = 40;
  line.since = Timestamp(Duration(77));
  line.first_tick = 0xfffffffffffffff0;
  line.counter_bits = 16;
  line.offset = Timestamp(Duration(78));
  line.tick_s = 1.0 / 3;
  line.nominal_tick = 0.25;
  line.readings = 100;
  line.outliers = 3;
  line.residual_s = {1e-6, 2e-6, 1.0 / 7};
  return line;
}

void write_all(SessionWriter& out) {
  const DeviceNumber device = out.add_device(tablet()).value();
  Transfer t{Timestamp(Duration(5)),
             StampedBy::kernel,
             Direction::from_device,
             TransferKind::evdev_frame,
             pack_events(std::vector<EvdevEvent>{{3, 0, 9}, {0, 0, 0}}),
             0x81};
  ASSERT_TRUE(out.add_transfer(device, t));
  const InputOrder a = out.add_sample(device, pen(5)).value();
  ASSERT_TRUE(out.applied(a, 3));
  ASSERT_TRUE(out.add_action({Timestamp(Duration(6)), LoadBrush{0.5F, {1, 0, 0.25F, 2}}}));
  ASSERT_TRUE(out.set("brush", "round-goat"));
  ASSERT_TRUE(out.add_receipt({device, 10, 9, 1}));
  ASSERT_TRUE(out.add_clock_fit({device, "probe", fitted()}));
  ASSERT_TRUE(out.add_passed_over({device, "report 12", 3}));
}

TEST_F(SessionFile, EverythingComesBack) {
  SessionWriter out = SessionWriter::create(path()).value();
  write_all(out);
  ASSERT_TRUE(out.close());
  EXPECT_FALSE(std::filesystem::exists(path().string() + "-wal"));

  const Session in = read_session(path()).value();
  EXPECT_TRUE(in.complete);
  ASSERT_EQ(in.devices.size(), 1U);
  EXPECT_EQ(in.devices[0].description, tablet());
  ASSERT_EQ(in.transfers.size(), 1U);
  EXPECT_EQ(unpack_events(in.transfers[0].transfer.payload).value()[0], (EvdevEvent{3, 0, 9}));
  ASSERT_EQ(in.pens.size(), 1U);
  EXPECT_EQ(in.pens[0].sample, pen(5));
  EXPECT_EQ(in.pens[0].applied, 3);
  ASSERT_EQ(in.actions.size(), 1U);
  EXPECT_GT(in.actions[0].order, in.pens[0].order);
  EXPECT_EQ(std::get<LoadBrush>(std::get<BrushCare>(in.actions[0].action.what)),
            (LoadBrush{0.5F, {1, 0, 0.25F, 2}}));
  EXPECT_EQ(in.settings.at("brush"), "round-goat");
  ASSERT_EQ(in.receipts.size(), 1U);
  EXPECT_EQ(in.receipts[0].dropped, 1);
  EXPECT_EQ(in.transfers[0].transfer.endpoint, 0x81);
  ASSERT_EQ(in.clock_fits.size(), 1U);
  EXPECT_EQ(in.clock_fits[0].part, "probe");
  EXPECT_EQ(in.clock_fits[0].line, fitted());
  ASSERT_EQ(in.passed_over.size(), 1U);
  EXPECT_EQ(in.passed_over[0].what, "report 12");
  EXPECT_EQ(in.passed_over[0].count, 3);
}

TEST(ActionWords, EveryActionComesBack) {
  const Concentrations strength{0.5F, 0, 1.25F, 0.1F};
  const std::vector<LoadStop> ramp{{0, 0.5F, {}}, {0.3F, 1, strength}, {0.3F, 1, {}}, {1, 0.25F, strength}};
  const std::vector<BrushCare> cares{LoadBrush{0.7F, strength},
                                     GradeBrush{ramp, {}},
                                     GradeBrush{ramp, {{0.1F, 1, strength}}},
                                     DipBrush{8.5F, 0.4F, strength},
                                     RinseBrush{2},
                                     WipeBrush{0.6F},
                                     BlotBrush{0.5F, {}},
                                     BlotBrush{0.5F, 0.25F},
                                     RollBrush{1.5F}};
  for (const BrushCare& care : cares) {
    const Action action{Timestamp(Duration(7)), care};
    const ActionWords words = words_for(action);
    const auto back = action_from(action.time, words.verb, words.arguments);
    ASSERT_TRUE(back) << words.verb;
    EXPECT_EQ(*back, action) << words.arguments;
  }
}

TEST(ActionWords, WhatIsOutOfRangeIsRefusedByName) {
  for (const auto& [verb, arguments] : std::vector<std::pair<std::string, std::string>>{
           {"load", "{}"},
           {"load", R"({"wetness": 2, "strength": [0, 0, 0, 0]})"},
           {"grade", R"({"side": [], "far_side": []})"},
           {"grade", R"({"side": [{"along": 1, "wetness": 1, "strength": [1, 0, 0, 0]},
                                 {"along": 0, "wetness": 1, "strength": [1, 0, 0, 0]}], "far_side": []})"},
           {"dip", R"({"depth_mm": -1, "seconds": 1, "strength": [1, 0, 0, 0]})"},
           {"dip", R"({"depth_mm": 1, "seconds": 1e9, "strength": [1, 0, 0, 0]})"},
           {"dip", R"({"depth_mm": 1, "seconds": 1, "strength": [1, "a", 0, 0]})"},
           {"rinse", R"({"seconds": "x"})"},
           {"wipe", "[]"},
           {"blot", R"({"seconds": 1, "side": 9})"},
           {"roll", "not JSON"},
           {"shake", "{}"}}) {
    const auto action = action_from({}, verb, arguments);
    ASSERT_FALSE(action) << arguments;
    EXPECT_NE(action.error().message.find("'" + verb + "'"), std::string::npos);
  }
}

TEST_F(SessionFile, NothingFlushedIsLostWhenTheProgramIsKilled) {
  const pid_t child = fork();
  if (child == 0) {
    SessionWriter out = SessionWriter::create(path()).value();
    const DeviceNumber device = out.add_device(tablet()).value();
    for (int i = 0; i < 100; ++i) (void)out.add_sample(device, pen(i));
    (void)out.flush();
    for (int i = 100; i < 200; ++i) (void)out.add_sample(device, pen(i));
    _exit(0);  // no destructor, no close
  }
  int status = 0;
  waitpid(child, &status, 0);
  const Session in = read_session(path()).value();
  EXPECT_FALSE(in.complete);
  EXPECT_EQ(in.pens.size(), 100U);
}

TEST_F(SessionFile, AnExistingFileIsNeverOverwritten) {
  std::ofstream(path()) << "mine";
  const auto out = SessionWriter::create(path());
  ASSERT_FALSE(out.has_value());
  EXPECT_EQ(out.error().fault, Fault::exists);
}

TEST_F(SessionFile, ASecondProgramIsToldWhoIsBusy) {
  SessionWriter out = SessionWriter::create(path()).value();
  write_all(out);
  ASSERT_TRUE(out.flush());
  const auto in = read_session(path());
  ASSERT_FALSE(in.has_value());
  EXPECT_EQ(in.error().fault, Fault::busy);
}

TEST_F(SessionFile, GarbageAndCutFilesAreRefusedWithOneLine) {
  std::ofstream(path()) << std::string(5000, 'x');
  EXPECT_EQ(read_session(path()).error().fault, Fault::malformed);
  EXPECT_EQ(read_session(folder_ / "none.fude").error().fault, Fault::not_found);
  EXPECT_EQ(read_session(folder_).error().fault, Fault::malformed);

  std::filesystem::remove(path());
  SessionWriter out = SessionWriter::create(path()).value();
  write_all(out);
  ASSERT_TRUE(out.close());
  std::filesystem::resize_file(path(), std::filesystem::file_size(path()) / 2);
  const auto cut = read_session(path());
  ASSERT_FALSE(cut.has_value());
  EXPECT_EQ(cut.error().message.find('\n'), std::string::npos);
}

TEST_F(SessionFile, TablesOfAStrangerAreNotRun) {
  {
    SessionWriter out = SessionWriter::create(path()).value();
    ASSERT_TRUE(out.close());
  }
  Database db = Database::open(path(), OpenMode::append).value();
  ASSERT_TRUE(db.run("CREATE TRIGGER t AFTER INSERT ON meta BEGIN DELETE FROM device; END"));
  EXPECT_EQ(read_session(path()).error().fault, Fault::malformed);
}

TEST_F(SessionFile, AnotherFormatIsNamed) {
  {
    SessionWriter out = SessionWriter::create(path()).value();
    ASSERT_TRUE(out.close());
  }
  Database db = Database::open(path(), OpenMode::append).value();
  ASSERT_TRUE(db.run("PRAGMA user_version=9"));
  const auto in = read_session(path());
  ASSERT_FALSE(in.has_value());
  EXPECT_EQ(in.error().fault, Fault::unsupported);
  EXPECT_NE(in.error().message.find("format 9"), std::string::npos);
}

TEST_F(SessionFile, RangesOfFormat2ComeFromTheFirstEmitter) {
  {
    Database db = Database::open(path(), OpenMode::create).value();
    for (const std::string& table : session_schema::tables(2)) ASSERT_TRUE(db.run(table));
    ASSERT_TRUE(db.run("PRAGMA application_id=" + std::to_string(session_schema::application_id)));
    ASSERT_TRUE(db.run("PRAGMA user_version=2"));
    ASSERT_TRUE(
        db.run("INSERT INTO range_sample(input, device, time_ns, stamped_by, sequence, receivers, "
               "flight_0_s, amplitude_0, amplitude_1, amplitude_2, amplitude_3, amplitude_4, "
               "amplitude_5, amplitude_6, amplitude_7, after_gap) "
               "VALUES(1, 1, 5, 'arrival', 7, 2, 0.001, 0.5, 0, 0, 0, 0, 0, 0, 0, 0)"));
  }
  const auto in = read_session(path());
  ASSERT_TRUE(in.has_value()) << in.error().message;
  const auto& range = std::get<RangeSample>(in->samples.at(0).sample);
  EXPECT_EQ(range.emitter, 0);
  EXPECT_EQ(range.receivers, 2);
  EXPECT_EQ(range.flight_s[0], 0.001);
}

TEST_F(SessionFile, AReadOnlyFileOpens) {
  SessionWriter out = SessionWriter::create(path()).value();
  write_all(out);
  ASSERT_TRUE(out.close());
  std::filesystem::permissions(path(), std::filesystem::perms::owner_read);
  EXPECT_TRUE(read_session(path()).has_value());
}

}  // namespace
}  // namespace fude
