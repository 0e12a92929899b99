// Real recordings through the importers and the decoding: every frame and sample accounted for.
#include "tests/fakes/recordings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "capture/import/import.h"
#include "drivers/tablet/identify.h"
#include "drivers/tablet/pen_decoder.h"

namespace fude {
namespace {

struct Expected {
  const char* file;
  std::uint64_t events, frames, samples, strokes;
  double width_mm, height_mm;
};

void PrintTo(const Expected& expected, std::ostream* out) { *out << expected.file; }

class EvdevRecording : public testing::TestWithParam<Expected> {};

TEST_P(EvdevRecording, IsAccountedFor) {
  const Expected& expected = GetParam();
  REQUIRE_RECORDING(expected.file);
  const auto imported = import_file(recordings() / expected.file, {});
  ASSERT_TRUE(imported) << imported.error().message;
  EXPECT_EQ(imported->format, ImportFormat::evemu);
  const RawRecording& recording = imported->recordings.at(0);
  EXPECT_EQ(recording.counts.events, expected.events);
  EXPECT_EQ(recording.counts.frames, expected.frames);
  EXPECT_EQ(recording.counts.unclosed_events, 0u);
  EXPECT_EQ(recording.transfers.size(), expected.frames);

  const DeviceDescription device = identified(recording.device.value());
  EXPECT_EQ(device.kind, DeviceKind::pen_tablet);
  EXPECT_NEAR(device.width.value().value, expected.width_mm, 0.01);
  EXPECT_NEAR(device.height.value().value, expected.height_mm, 0.01);

  PenDecoder decoder(device);
  std::uint64_t samples = 0;
  Timestamp before{};
  for (const Transfer& transfer : recording.transfers) {
    const auto sample = decoder.decode(transfer);
    if (!sample || !sample->in_proximity) continue;
    ++samples;
    EXPECT_GE(sample->time.host, before);
    before = sample->time.host;
    EXPECT_GE(sample->x_counts, 0);
    EXPECT_LE(sample->x_counts, 59552);
  }
  EXPECT_EQ(samples, expected.samples);
  EXPECT_EQ(decoder.counts().samples, expected.samples);
  EXPECT_EQ(decoder.counts().strokes, expected.strokes);
  EXPECT_EQ(decoder.counts().lost, 0u);
  EXPECT_EQ(decoder.counts().out_of_range, 0u);
}

INSTANTIATE_TEST_SUITE_P(
    All, EvdevRecording,
    testing::Values(Expected{"evdev/Wacom_Cintiq_13HD.events.gz", 54966, 10037, 10008, 40, 297.76, 169.24},
                    Expected{"evdev/Wacom_Cintiq_12WX.events", 2260, 362, 360, 2, 265.1, 167.2},
                    Expected{"evdev/Wacom_Intuos4_6x9.stylus-drag.events", 1799, 361, 360, 1, 223.52, 139.7},
                    Expected{"evdev/Wacom_Intuos4_6x9.stylus-move.events", 2181, 444, 443, 0, 223.52, 139.7},
                    Expected{"evdev/Wacom_Intuos4_6x9.stylus-tap.events", 396, 88, 87, 1, 223.52, 139.7},
                    Expected{"evdev/UC-LOGIC_Tablet_WP5540U_Pen.events", 1458, 506, 506, 1, 139.43, 101.45}),
    [](const auto& one) { return "Recording" + std::to_string(one.index); });

TEST(Cintiq13HD, AllItsToolsAreHeard) {
  const char* file = "evdev/Wacom_Cintiq_13HD.events.gz";
  REQUIRE_RECORDING(file);
  const auto imported = import_file(recordings() / file, {});
  ASSERT_TRUE(imported);
  const RawRecording& recording = imported->recordings.at(0);
  PenDecoder decoder(recording.device.value());
  std::map<PenTool, int> samples;
  double widest_turn = 0;
  double fullest_wheel = 0;
  for (const Transfer& transfer : recording.transfers)
    if (const auto sample = decoder.decode(transfer)) {
      ++samples[sample->tool];
      widest_turn = std::max(widest_turn, std::abs(in_degrees(*sample->rotation)));
      fullest_wheel = std::max(fullest_wheel, sample->wheel->value);
    }
  for (PenTool tool : {PenTool::pen, PenTool::rubber, PenTool::pencil, PenTool::airbrush})
    EXPECT_GT(samples[tool], 0) << static_cast<int>(tool);
  EXPECT_GT(widest_turn, 90);
  EXPECT_EQ(fullest_wheel, 1);
}

TEST(Intuos4, DescriptionBesideTheFileIsFound) {
  const char* file = "evdev/Wacom_Intuos4_6x9.stylus-drag.events";
  REQUIRE_RECORDING(file);
  const auto imported = import_file(recordings() / file, {});
  ASSERT_TRUE(imported);
  EXPECT_EQ(imported->description->filename(), "Wacom_Intuos4_6x9.desc");
  EXPECT_EQ(imported->recordings.at(0).device->id, "056a:00b9:");
}

TEST(Intuos4, ADescriptionAloneIsAnEmptySession) {
  const char* file = "evdev/Wacom_Intuos4_6x9.desc";
  REQUIRE_RECORDING(file);
  const auto imported = import_file(recordings() / file, {});
  ASSERT_TRUE(imported) << imported.error().message;
  EXPECT_TRUE(imported->recordings.at(0).device);
  EXPECT_TRUE(imported->recordings.at(0).transfers.empty());
}

TEST(Painting, EveryRowIsASample) {
  const char* file = "strokes/painting30sec.dat";
  REQUIRE_RECORDING(file);
  const auto imported = import_file(recordings() / file, {});
  ASSERT_TRUE(imported) << imported.error().message;
  EXPECT_EQ(imported->format, ImportFormat::mypaint_events);
  std::vector<PenSample> samples;
  for (const Sample& sample : imported->recordings.at(0).samples)
    samples.push_back(std::get<PenSample>(sample));
  ASSERT_EQ(samples.size(), 2937u);
  int strokes = 0;
  for (std::size_t i = 0; i < samples.size(); ++i)
    strokes += samples[i].in_contact && (i == 0 || !samples[i - 1].in_contact);
  EXPECT_EQ(strokes, 30);
  EXPECT_EQ(samples[1].time.host, Timestamp(std::chrono::milliseconds(8)));
  EXPECT_EQ(samples[0].x_counts, 205.244514);
}

}  // namespace
}  // namespace fude
