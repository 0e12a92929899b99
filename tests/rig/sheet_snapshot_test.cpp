// A painting goes on where another ended: the sheet at the head of a session.
#include "rig/sheet_snapshot.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <limits>

#include "rig/recorder.h"
#include "rig/replay.h"
#include "rig/share_folder.h"
#include "tests/rig/gesture.h"

namespace fude {
namespace {

using gesture::settings;

const auto silent = [](double) {};

SheetSnapshot wet_sheet() { return painted_sheet(gesture::session(150, 1), settings(), silent).value(); }

TEST(SheetSnapshot, APaintingOnItGoesOnAsIfItHadNotStopped) {
  const Session first = gesture::session(150, 1);
  Session second;
  second.devices = first.devices;
  second.sheet = RecordedSheet{0, as_bytes(wet_sheet())};
  ReplaySettings on = settings();
  on.wish.sheet = Extent{Millimetres(gesture::sheet_mm), Millimetres(gesture::sheet_mm)};
  const Replayed continued = replay(second, on, silent).value();
  // A replay runs one step at least: the whole one runs as much longer.
  ReplaySettings longer = settings();
  longer.settle.seconds = continued.report.dt_s;
  const Replayed whole = replay(first, longer, silent).value();
  EXPECT_EQ(continued.report.picture_sha256, whole.report.picture_sha256);
  EXPECT_EQ(continued.report.ink.pigment_deposited, whole.report.ink.pigment_deposited);
  EXPECT_EQ(continued.report.ink.water_evaporated, whole.report.ink.water_evaporated);
}

TEST(SheetSnapshot, StandsInTheSessionsFile) {
  const std::filesystem::path file =
      testing::TempDir() + "fude_on_a_sheet_" + std::to_string(getpid()) + ".fude";
  const std::vector<std::byte> bytes = as_bytes(wet_sheet());
  {
    auto recorder = Recorder::open(file).value();
    recorder->add(RecordedSheet{0, bytes});
    ASSERT_TRUE(recorder->close());
  }
  const Session session = read_session(file).value();
  ASSERT_TRUE(session.sheet);
  EXPECT_EQ(session.sheet->state, bytes);
  EXPECT_EQ(as_bytes(sheet_from_bytes(bytes).value()), bytes);
  std::filesystem::remove(file);
}

TEST(SheetSnapshot, AnotherSizeOfCellIsRefused) {
  Session session = gesture::session(150, 1);
  session.sheet = RecordedSheet{0, as_bytes(wet_sheet())};
  ReplaySettings finer = settings();
  finer.painting.ink.cell_mm = 0.1;
  const auto refused = replay(session, finer, silent);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().fault, Fault::usage);
  EXPECT_NE(refused.error().message.find("--cell-mm"), std::string::npos) << refused.error().message;
}

TEST(SheetSnapshot, RefusesWhatIsCutOffOrNoAmount) {
  const std::vector<std::byte> good = as_bytes(wet_sheet());
  for (std::size_t length = 0; length < good.size(); length += length < 200 ? 1 : 9973)
    EXPECT_FALSE(sheet_from_bytes(std::span(good).first(length))) << length;
  std::vector<std::byte> longer = good;
  longer.push_back({});
  EXPECT_FALSE(sheet_from_bytes(longer));

  SheetSnapshot sheet = wet_sheet();
  const auto refused = [](const SheetSnapshot& s) { return !sheet_from_bytes(as_bytes(s)); };
  ASSERT_FALSE(refused(sheet));
  for (const float wrong :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -1.0F}) {
    SheetSnapshot broken = sheet;
    broken.ink.tiles.back().planes.back() = wrong;
    EXPECT_TRUE(refused(broken)) << wrong;
  }
  SheetSnapshot off = sheet;
  off.ink.tiles.back().row = 7;  // of seven rows of tiles, counted from 0
  EXPECT_TRUE(refused(off));
  SheetSnapshot twice = sheet;
  twice.ink.tiles.push_back(twice.ink.tiles.back());
  EXPECT_TRUE(refused(twice));
}

}  // namespace
}  // namespace fude
