// Eight pens on one tablet, as they were recorded: each is told apart by its serial, with its ends, wheel and
// turn.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "capture/import/import.h"
#include "drivers/tablet/pen_decoder.h"
#include "tests/fakes/recordings.h"

namespace fude {
namespace {

struct Pen {
  std::set<PenTool> ends;
  std::set<std::uint32_t> kinds;
  double least_turn = 0, most_turn = 0;  // degrees
  double most_wheel = 0;
  int samples = 0;
};

std::map<std::uint64_t, Pen> pens_of(const RawRecording& recording) {
  std::map<std::uint64_t, Pen> pens;
  PenDecoder decoder(recording.device.value());
  for (const Transfer& transfer : recording.transfers) {
    const auto sample = decoder.decode(transfer);
    if (!sample || !sample->in_proximity) continue;
    Pen& pen = pens[sample->tool_serial];
    pen.ends.insert(sample->tool);
    pen.kinds.insert(sample->tool_id);
    pen.least_turn = std::min(pen.least_turn, in_degrees(*sample->rotation));
    pen.most_turn = std::max(pen.most_turn, in_degrees(*sample->rotation));
    pen.most_wheel = std::max(pen.most_wheel, sample->wheel->value);
    ++pen.samples;
  }
  return pens;
}

class Cintiq13HDPens : public testing::Test {
 protected:
  void SetUp() override {
    constexpr const char* file = "evdev/Wacom_Cintiq_13HD.events.gz";
    REQUIRE_RECORDING(file);
    const auto imported = import_file(recordings() / file, {});
    ASSERT_TRUE(imported) << imported.error().message;
    pens_ = pens_of(imported->recordings.at(0));
  }
  std::map<std::uint64_t, Pen> pens_;
};

TEST_F(Cintiq13HDPens, AreToldApartBySerial) {
  EXPECT_EQ(pens_.size(), 8u);
  EXPECT_FALSE(pens_.contains(0));
  int samples = 0;
  for (const auto& [serial, pen] : pens_) {
    EXPECT_LE(pen.kinds.size(), 2u) << serial;  // one for each end
    samples += pen.samples;
  }
  EXPECT_EQ(samples, 10008);
}

TEST_F(Cintiq13HDPens, TheAirbrushHasAWheelAndNoOtherPen) {
  for (const auto& [serial, pen] : pens_) {
    const bool airbrush = pen.ends.contains(PenTool::airbrush);
    EXPECT_EQ(airbrush, serial == 0x9b800010u);
    EXPECT_EQ(pen.most_wheel, airbrush ? 1.0 : 0.0) << serial;
  }
}

TEST_F(Cintiq13HDPens, TheArtPenTurnsAndNoOtherPen) {
  for (const auto& [serial, pen] : pens_) {
    const bool art_pen = serial == 0x9b800030u;
    EXPECT_NEAR(pen.least_turn, art_pen ? -31.2 : 0, 0.01) << serial;
    EXPECT_NEAR(pen.most_turn, art_pen ? 106.6 : 0, 0.01) << serial;
  }
}

TEST_F(Cintiq13HDPens, BothEndsAreHeardWhereTheKernelKnowsThem) {
  std::set<std::uint64_t> with_rubber;
  for (const auto& [serial, pen] : pens_)
    if (pen.ends.contains(PenTool::rubber)) with_rubber.insert(serial);
  EXPECT_EQ(with_rubber, (std::set<std::uint64_t>{0xe28001bd, 0x9b800010, 0x9b800014, 0x9b800030}));
  // The kernel of the recording calls kind 0x10080a a pen; the kind tells the end all the same.
  for (std::uint64_t serial : {0xe1800087u, 0x28886c4bu, 0x1b81fdcau}) {
    EXPECT_EQ(pens_[serial].ends, std::set<PenTool>{PenTool::pen});
    EXPECT_EQ(pens_[serial].kinds, (std::set<std::uint32_t>{0x100802, 0x10080a}));
  }
}

}  // namespace
}  // namespace fude
