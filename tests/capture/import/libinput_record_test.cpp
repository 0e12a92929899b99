#include "capture/import/libinput_record.h"

#include <gtest/gtest.h>
#include <linux/input-event-codes.h>

#include <string>

namespace fude {
namespace {

// As `libinput record` 1.22 prints it, shortened.
constexpr const char* two_devices = R"(# libinput record
version: 1
ndevices: 2
libinput:
  version: "1.22.1"
  git: "unknown"
system:
  os: "debian:12"
  kernel: "6.1.0"
  dmi: "dmi:"
devices:
- node: /dev/input/event5
  evdev:
    # Name: Wacom Intuos4 6x9
    # ID: bus 0x03 vendor 0x56a product 0xb9 version 0x104
    # Supported Events:
    # Event type 1 (EV_KEY)
    #   Event code 320 (BTN_TOOL_PEN)
    # Event type 3 (EV_ABS)
    #   Event code 0 (ABS_X)
    #       Value       77
    #       Min         0
    #       Max     44704
    #       Fuzz        4
    #       Flat        0
    #       Resolution    200
    # Properties:
    name: "Wacom Intuos4 6x9"
    id: [3, 1386, 185, 260]
    codes:
      0: [0, 1, 2, 3] # EV_SYN
      1: [330, 320] # EV_KEY
      3: [0] # EV_ABS
    absinfo:
      0: [0, 44704, 4, 0, 200]
    properties: [0]
  hid: [ 5, 13, 9 ]
  udev:
    properties:
    - ID_INPUT=1
  quirks:
  libinput:
    capabilities: [tablet]
  events:
  - evdev:
    - [  0,      0,   3,   0,    4488] # EV_ABS / ABS_X                 4488 (+4411)
    - [  0,      0,   1, 320,       1] # EV_KEY / BTN_TOOL_PEN             1
    - [  0,      0,   0,   0,       0] # ------------ SYN_REPORT (0) ---------- +0ms
    libinput:
    - {time: 0.000000, type: TABLET_TOOL_PROXIMITY}
  - libinput:
    - {time: 0.001000, type: DEVICE_ADDED}
  - evdev:
    - [  0,   4007,   3,   0,    4508]
    - [  0,   4007,   0,   0,       0]
- node: /dev/input/event6
  evdev:
    name: "Mouse"
    id: [3, 1133, 1, 1]
    codes:
      1: [272]
    properties: []
  events:
)";

TEST(LibinputRecord, EveryDeviceIsRead) {
  const auto recordings = import_libinput_record(two_devices);
  ASSERT_TRUE(recordings) << recordings.error().message;
  ASSERT_EQ(recordings->size(), 2u);
  const RawRecording& pen = recordings->at(0);
  EXPECT_EQ(pen.device->id, "056a:00b9:");
  EXPECT_EQ(pen.device->name, "Wacom Intuos4 6x9");
  EXPECT_EQ(pen.device->version, 260);
  EXPECT_EQ(pen.device->keys, (std::vector<std::uint16_t>{BTN_TOOL_PEN, BTN_TOUCH}));
  EXPECT_EQ(pen.device->properties, (std::vector<std::uint16_t>{INPUT_PROP_POINTER}));
  EXPECT_EQ(pen.device->axes, (std::vector<AxisRange>{{ABS_X, 0, 44704, 4, 0, 200, 77}}));
  EXPECT_EQ(pen.counts.events, 5u);
  EXPECT_EQ(pen.counts.frames, 2u);
  ASSERT_EQ(pen.transfers.size(), 2u);
  EXPECT_EQ(pen.transfers[1].time, Timestamp(Duration(4007000)));
  EXPECT_EQ(unpack_events(pen.transfers[0].payload).value(),
            (std::vector<EvdevEvent>{{3, 0, 4488}, {1, 320, 1}, {0, 0, 0}}));
  EXPECT_TRUE(recordings->at(1).transfers.empty());
}

void expect_refusal(const std::string& text, Fault fault, const std::string& message) {
  const auto recordings = import_libinput_record(text);
  ASSERT_FALSE(recordings) << text;
  EXPECT_EQ(recordings.error().fault, fault);
  EXPECT_NE(recordings.error().message.find(message), std::string::npos) << recordings.error().message;
  EXPECT_EQ(recordings.error().message.find('\n'), std::string::npos);
}

std::string with(const std::string& events, const std::string& description = "name: x") {
  return "version: 1\ndevices:\n- node: /dev/x\n  evdev: {" + description + "}\n  events:\n  - evdev:\n" +
         events;
}

TEST(LibinputRecord, BadFilesAreNamed) {
  expect_refusal("", Fault::malformed, "no version");
  expect_refusal("version: 2\ndevices: []\n", Fault::unsupported, "version 2");
  expect_refusal("version: 1\ndevices: []\n", Fault::malformed, "no devices");
  expect_refusal("version: 1\ndevices: [5]\n", Fault::malformed, "not a device");
  expect_refusal("version: [1\n", Fault::malformed, "line ");
  expect_refusal(with("    - [0, 0, 3, 0]\n"), Fault::malformed, "line 7");
  expect_refusal(with("    - [0, 0, 3, 0, nan]\n"), Fault::malformed, "line 7");
  expect_refusal(with("    - [0, 0, 3, 0, 9999999999]\n"), Fault::malformed, "out of range");
  expect_refusal(with("    - [0, 1000000, 3, 0, 1]\n"), Fault::malformed, "out of range");
  expect_refusal(with("    - [-1, 0, 3, 0, 1]\n"), Fault::malformed, "out of range");
  expect_refusal(with("    - [1, 0, 0, 0, 0]\n    - [0, 5, 0, 0, 0]\n"), Fault::malformed, "runs backwards");
  expect_refusal(with("    - [1, 0, 0, 0, 0]\n", "absinfo: {0: [5, 1, 0, 0, 0]}"), Fault::malformed,
                 "ends below");
  expect_refusal(with("    - [1, 0, 0, 0, 0]\n", "absinfo: {0: 5}"), Fault::malformed, "list of 5");
}

TEST(LibinputRecord, ARecordingCutInsideALineIsRefusedWithItsLine) {
  const std::string text = two_devices;
  expect_refusal(text.substr(0, text.find("4508]") + 2), Fault::malformed, "line ");
}

}  // namespace
}  // namespace fude
