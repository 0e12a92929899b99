// Pens made of the report descriptors of real tablets, driven by the kernel's own wacom driver and
// hid-generic, read by EvdevSource and decoded by PenDecoder.
#include <gtest/gtest.h>
#include <linux/input-event-codes.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include "drivers/tablet/pen_axes.h"
#include "drivers/tablet/pen_decoder.h"
#include "drivers/transport/evdev_source.h"
#include "tests/fakes/recordings.h"
#include "tests/lab/attached_pen.h"
#include "tests/lab/hid_record.h"
#include "tests/lab/pen_reports.h"
#include "tests/lab/raw_events.h"
#include "tests/lab/session_recording.h"
#include "tests/lab/uhid_device.h"

namespace fude::lab {
namespace {

// What one report says, worked out from its bytes alone.
using Meaning = std::optional<PenReport> (*)(const Bytes& report);

struct Played {
  DeviceDescription description;
  std::size_t reports = 0;
  std::size_t told = 0;  // reports that say where the pen is
  std::size_t frames = 0;
  std::vector<PenSample> samples;
};

// Sends each report alone and decodes what came of it, from the session file.
Played play(const HidIdentity& identity, const Bytes& descriptor, const std::vector<Bytes>& reports,
            Meaning meaning, int position_fuzz) {
  std::unique_ptr<UhidDevice> device;
  const DeviceNode found = attached_pen([&] { device = std::make_unique<UhidDevice>(identity, descriptor); });
  Played played;
  played.description = found.description;
  EXPECT_TRUE(found.access);
  EXPECT_EQ(found.description.vendor, identity.vendor);
  EXPECT_EQ(found.description.product, identity.product);
  EXPECT_EQ(found.description.serial, identity.serial);

  auto source = EvdevSource::open(found.path);
  if (!source) throw std::runtime_error(source.error().message);
  RawEvents raw(found.path);
  SessionRecording recording(found.description);
  std::vector<RawFrame> sent;
  std::vector<std::size_t> after;  // transfers recorded once report i was sent
  std::vector<std::pair<Timestamp, Timestamp>> between;
  for (const Bytes& report : reports) {
    const Timestamp before = monotonic_now();
    device->send(report);
    for (RawFrame& frame : raw.take()) {
      EXPECT_GE(frame.time, before - std::chrono::microseconds(1));
      EXPECT_LE(frame.time, monotonic_now());
      sent.push_back(std::move(frame));
    }
    after.push_back(recording.drain(**source));
  }
  device.reset();
  recording.drain_until(**source, recording.size() + 2);
  EXPECT_TRUE(recording.error() && recording.error()->fault == Fault::device_gone);

  // What was recorded is what a plain reader saw, bit for bit and to the microsecond.
  const std::vector<Transfer> transfers = recording.finish();
  EXPECT_FALSE(transfers.empty() || sent.empty());
  EXPECT_EQ(transfers.size(), sent.size() + 1);
  for (std::size_t i = 0; i < std::min(transfers.size(), sent.size()); ++i) {
    EXPECT_EQ(transfers[i].payload, pack_events(sent[i].events)) << "frame " << i;
    EXPECT_EQ(transfers[i].time, sent[i].time) << "frame " << i;
    EXPECT_EQ(transfers[i].stamped_by, StampedBy::kernel);
  }
  EXPECT_EQ(transfers.back().kind, TransferKind::unplugged);

  // And it says what the bytes say. The kernel keeps back what changes nothing, so the pen stands still.
  PenDecoder decoder(found.description);
  PenSample pen;
  std::size_t at = 0;
  for (std::size_t i = 0; i < reports.size(); ++i) {
    for (; at < after[i] && at < transfers.size(); ++at)
      if (const auto sample = decoder.decode(transfers[at])) {
        pen = *sample;
        played.samples.push_back(*sample);
      }
    const auto said = meaning(reports[i]);
    if (!said || pen.tool == PenTool::none) continue;
    ++played.told;
    EXPECT_LE(std::abs(pen.x_counts - said->x), position_fuzz) << "report " << i;
    EXPECT_LE(std::abs(pen.y_counts - said->y), position_fuzz) << "report " << i;
    EXPECT_EQ(pen.pressure_raw, said->pressure) << "report " << i;
    if (testing::Test::HasFailure()) break;
  }
  EXPECT_EQ(decoder.counts().lost, 0u);
  EXPECT_EQ(decoder.counts().malformed, 0u);
  played.reports = reports.size();
  played.frames = sent.size();
  return played;
}

std::size_t in_contact(const Played& played) {
  return static_cast<std::size_t>(std::count_if(played.samples.begin(), played.samples.end(),
                                                [](const PenSample& s) { return s.in_contact; }));
}

void say(const char* name, const Played& played) {
  std::printf("figure: %s: %zu reports, %zu with a place, %zu frames, %zu samples in contact\n", name,
              played.reports, played.told, played.frames, in_contact(played));
}

void replay(const char* file, const char* name, std::uint16_t product, int fuzz) {
  const HidRecord record = read_hid_record(recordings() / file);
  ASSERT_GT(record.reports.size(), 1000u);
  const Played played =
      play({name, 0x056a, product, "LAB1"}, record.descriptor, record.reports, intuos_report, fuzz);
  say(name, played);
  EXPECT_GT(played.told, 500u);
  EXPECT_GT(in_contact(played), 100u);
}

// The wacom driver asks the input layer to smooth positions by four counts.
constexpr int wacom_fuzz = 4;

TEST(WacomPens, Intuos4AsRecorded) {
  const char* file = "hid/Wacom_Intuos4_WL_056a_00BC.hid";
  REQUIRE_RECORDING(file);
  replay(file, "Intuos4 WL", 0x00bc, wacom_fuzz);
}

TEST(WacomPens, Cintiq22AsRecorded) {
  const char* file = "hid/Wacom_Cintiq_22HD_056a_00FA.hid";
  REQUIRE_RECORDING(file);
  replay(file, "Cintiq 22HD", 0x00fa, wacom_fuzz);
}

TEST(WacomPens, CintiqPro16FromItsDescriptor) {
  const char* file = "hid_descriptors/Wacom_Cintiq_Pro_16/0003_056A_0350.000B.hid.bin";
  REQUIRE_RECORDING(file);
  const Played played = play({"Cintiq Pro 16", 0x056a, 0x0350, "LAB2"}, read_bytes(recordings() / file),
                             strokes(cintiq_pro_report), read_cintiq_pro_report, wacom_fuzz);
  say("Cintiq Pro 16", played);
  const DeviceDescription& tablet = played.description;
  ASSERT_NE(find_axis(tablet, ABS_PRESSURE), nullptr);
  EXPECT_EQ(find_axis(tablet, ABS_X)->maximum, 69920);
  EXPECT_EQ(find_axis(tablet, ABS_Y)->maximum, 39680);
  EXPECT_EQ(find_axis(tablet, ABS_PRESSURE)->maximum, 8191);
  EXPECT_GT(in_contact(played), 100u);
}

TEST(GenericPens, HuionKamvasProFromItsDescriptor) {
  const char* file = "hid_descriptors/Huion_Kamvas_Pro_13/0003_256C_006D.0020.hid.bin";
  REQUIRE_RECORDING(file);
  const Played played = play({"Kamvas Pro 13", 0x256c, 0x006d, "LAB3"}, read_bytes(recordings() / file),
                             strokes(huion_report), read_huion_report, 0);
  say("Kamvas Pro 13", played);
  EXPECT_GT(in_contact(played), 100u);
}

// Always there: a pen of the plainest kind, described here.
TEST(GenericPens, PlainPen) {
  const Played played = play({"Plain pen", 0x1209, 0x0001, "LAB4"}, plain_pen_descriptor(),
                             strokes(plain_report), read_plain_report, 0);
  say("plain pen", played);
  EXPECT_GT(in_contact(played), 100u);
  EXPECT_EQ(played.told, 600u);
}

}  // namespace
}  // namespace fude::lab
