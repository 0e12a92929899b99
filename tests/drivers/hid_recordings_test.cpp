// Raw reports that real tablets sent, against what their makers publish of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>

#include "capture/import/import.h"
#include "drivers/tablet/hid_pen_decoder.h"
#include "tests/fakes/recordings.h"

namespace fude {
namespace {

struct Span {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  void add(double v) {
    low = std::min(low, v);
    high = std::max(high, v);
  }
};

struct Pens {
  Span x, y, pressure, tilt_x, tilt_y;
  std::set<PenTool> tools;
  ReportCounts counts;
  DeviceDescription tablet;
};

// Empty on failure: the caller sees it by the counts.
Pens decoded(const char* file) {
  Pens pens;
  const auto imported = import_file(recordings() / file, {});
  EXPECT_TRUE(imported) << imported.error().message;
  if (!imported) return pens;
  const RawRecording& recording = imported->recordings.at(0);
  const auto tablet = described_hid_pen(recording.device.value(), recording.transfers);
  EXPECT_TRUE(tablet.has_value()) << file;
  if (!tablet) return pens;
  pens.tablet = *tablet;
  HidPenDecoder decoder(*tablet);
  Decoded out;
  for (const Transfer& transfer : recording.transfers) decoder.decode(transfer, out);
  for (const Sample& sample : out.samples) {
    const auto& pen = std::get<PenSample>(sample);
    if (!pen.in_proximity) continue;
    pens.tools.insert(pen.tool);
    pens.x.add(pen.x_counts);
    pens.y.add(pen.y_counts);
    pens.pressure.add(pen.pressure_raw);
    if (pen.tilt_x) pens.tilt_x.add(in_degrees(*pen.tilt_x));
    if (pen.tilt_y) pens.tilt_y.add(in_degrees(*pen.tilt_y));
  }
  pens.counts = decoder.counts();
  return pens;
}

TEST(HuionHs610, ReachesItsPublishedCorners) {
  REQUIRE_RECORDING("usbhid/Huion_HS610");
  const Pens pens = decoded("usbhid/Huion_HS610/dumps_enabled_pen_coords.txt");
  EXPECT_EQ(pens.x.low, 0);
  EXPECT_EQ(pens.x.high, 50800);
  EXPECT_EQ(pens.y.high, 31750);
  EXPECT_EQ(pens.counts.samples, 2596U);
  EXPECT_EQ(pens.counts.malformed, 1U);  // the report of garbage
  EXPECT_EQ(pens.counts.unknown, 0U);
  EXPECT_NEAR(pens.tablet.width->value, 254, 1e-9);
  EXPECT_NEAR(pens.tablet.height->value, 158.75, 1e-9);
}

TEST(HuionHs610, ReachesItsPublishedPressureAndTilt) {
  REQUIRE_RECORDING("usbhid/Huion_HS610");
  EXPECT_EQ(decoded("usbhid/Huion_HS610/dumps_enabled_pen_pressure.txt").pressure.high, 8191);
  const Pens tilted = decoded("usbhid/Huion_HS610/dumps_enabled_pen_tilt.txt.gz");
  EXPECT_EQ(tilted.counts.samples, 4249U);
  for (const Span& tilt : {tilted.tilt_x, tilted.tilt_y}) {
    EXPECT_NEAR(tilt.low, -60, 1e-9);
    EXPECT_NEAR(tilt.high, 60, 1e-9);
  }
}

TEST(UcLogicTwhl850, ReachesItsPublishedCorners) {
  REQUIRE_RECORDING("usbhid/UC-Logic_TWHL850");
  const Pens pens = decoded("usbhid/UC-Logic_TWHL850/dumps_pen_coords.txt");
  EXPECT_EQ(pens.x.low, 0);
  EXPECT_EQ(pens.x.high, 31999);
  EXPECT_EQ(pens.y.low, 0);
  EXPECT_EQ(pens.y.high, 19999);
  EXPECT_EQ(pens.counts.samples, 1161U);
  EXPECT_EQ(decoded("usbhid/UC-Logic_TWHL850/dumps_pen_pressure.txt").pressure.high, 1023);
}

TEST(WacomRaw, PensStayOnTheirTablets) {
  REQUIRE_RECORDING("hid/Wacom_Cintiq_22HD_056a_00FA.hid");
  struct Expected {
    const char* file;
    double width_mm;
    double across, down, pressure;
    bool tilts;
    std::uint64_t reports;
  };
  for (const Expected& e :
       {Expected{"hid/Wacom_Cintiq_22HD_056a_00FA.hid", 477.2, 95440, 53860, 2047, true, 1269},
        Expected{"hid/Wacom_Intuos4_WL_056a_00BC.hid", 203.2, 40640, 25400, 2047, true, 2021},
        Expected{"hid/Wacom_Intuos_Pro_S_056a_0314.hid.gz", 157.48, 31496, 19685, 2047, true, 4277},
        Expected{"hid/Wacom_Graphire3_056a_0013.hid", 127.6, 10208, 7424, 511, false, 1317},
        Expected{"hid/Wacom_PenPartner_hidrecord.txt", 65, 3250, 2320, 255, false, 874}}) {
    const Pens pens = decoded(e.file);
    EXPECT_NEAR(pens.tablet.width->value, e.width_mm, 1e-9) << e.file;
    EXPECT_GE(std::min(pens.x.low, pens.y.low), 0) << e.file;
    EXPECT_LE(pens.x.high, e.across) << e.file;
    EXPECT_LE(pens.y.high, e.down) << e.file;
    EXPECT_GT(pens.pressure.high, e.pressure / 2) << e.file;
    EXPECT_LE(pens.pressure.high, e.pressure) << e.file;
    EXPECT_EQ(pens.tilt_x.high > pens.tilt_x.low, e.tilts) << e.file;
    EXPECT_TRUE(pens.tools.contains(PenTool::pen)) << e.file;
    EXPECT_EQ(pens.counts.reports + pens.counts.malformed + pens.counts.unknown, e.reports) << e.file;
    EXPECT_EQ(pens.counts.malformed, 0U) << e.file;
  }
}

}  // namespace
}  // namespace fude
