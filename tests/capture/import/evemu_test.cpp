#include "capture/import/evemu.h"

#include <gtest/gtest.h>
#include <linux/input-event-codes.h>

#include <string>

namespace fude {
namespace {

constexpr const char* comments =
    "# EVEMU 1.2\n"
    "# Input device name: \"A Pen\"\n"
    "# Input device ID: bus 0x03 vendor 0x56a product 0x304 version 0x90\n"
    "# Supported events:\n"
    "#   Event type 1 (EV_KEY)\n"
    "#     Event code 320 (BTN_TOOL_PEN)\n"
    "#   Event type 3 (EV_ABS)\n"
    "#     Event code 0 (ABS_X)\n"
    "#       Value  12391\n"
    "#       Min        0\n"
    "#       Max    32767\n"
    "#       Fuzz       4\n"
    "#       Flat       1\n"
    "#       Resolution 235\n"
    "# Properties:\n";
constexpr const char* letters =
    "N: A Pen\n"
    "I: 0003 056a 0304 0090\n"
    "P: 02 00 00 00 00 00 00 00\n"
    "B: 00 0b 00 00 00 00 00 00 00\n"
    "B: 01 00 00 00 00 00 00 00 00\n"
    "B: 01 00 00 00 00 00 00 00 00\n"
    "B: 01 00 00 00 00 00 00 00 00\n"
    "B: 01 00 00 00 00 00 00 00 00\n"
    "B: 01 00 00 00 00 00 00 00 00\n"
    "B: 01 01 1c 00 00 00 00 00 00\n"
    "A: 00 0 32767 4 1 200\n"
    "A: 1a -64 63 0 0\n";
constexpr const char* events =
    "E: 1369413757.964832 0003 0000 23122\t# EV_ABS / ABS_X  23122\n"
    "E: 1369413757.964832 0004 0000 -494927427\n"
    "E: 1369413757.964832 0000 0000 0000\n"
    "E: 1369413757.969824 0000 0000 0\n";

TEST(Evemu, CommentsAloneDescribeTheDevice) {
  const auto device = read_evemu_description(comments);
  ASSERT_TRUE(device) << device.error().message;
  EXPECT_EQ(device->id, "056a:0304:");
  EXPECT_EQ(device->name, "A Pen");
  EXPECT_EQ(device->transport, "evdev");
  EXPECT_EQ(device->bus, 3);
  EXPECT_EQ(device->version, 0x90);
  EXPECT_EQ(device->keys, (std::vector<std::uint16_t>{BTN_TOOL_PEN}));
  EXPECT_EQ(device->axes, (std::vector<AxisRange>{{ABS_X, 0, 32767, 4, 1, 235, 12391}}));
}

TEST(Evemu, LettersAloneDescribeTheDevice) {
  const auto device = read_evemu_description(letters);
  ASSERT_TRUE(device) << device.error().message;
  EXPECT_EQ(device->id, "056a:0304:");
  EXPECT_EQ(device->keys, (std::vector<std::uint16_t>{BTN_TOOL_PEN, BTN_TOUCH, BTN_STYLUS, BTN_STYLUS2}));
  EXPECT_EQ(device->properties, (std::vector<std::uint16_t>{INPUT_PROP_DIRECT}));
  EXPECT_EQ(device->axes,
            (std::vector<AxisRange>{{ABS_X, 0, 32767, 4, 1, 200, 0}, {ABS_TILT_X, -64, 63, 0, 0, 0, 0}}));
}

TEST(Evemu, ValuesAndMissingResolutionsComeFromTheComments) {
  const auto device = read_evemu_description(std::string(comments) + "N: A Pen\nA: 00 0 32767 4 1\n");
  ASSERT_TRUE(device);
  EXPECT_EQ(device->axes.at(0).value, 12391);
  EXPECT_EQ(device->axes.at(0).resolution, 235);
}

TEST(Evemu, EventsBecomeWholeFramesWithExactTimes) {
  const auto recording = import_evemu(std::string(letters) + events);
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(recording->counts.events, 4u);
  EXPECT_EQ(recording->counts.frames, 2u);
  ASSERT_EQ(recording->transfers.size(), 2u);
  EXPECT_EQ(recording->transfers[0].time, Timestamp(Duration(1369413757964832000)));
  EXPECT_EQ(recording->transfers[0].stamped_by, StampedBy::recording);
  EXPECT_EQ(unpack_events(recording->transfers[0].payload).value(),
            (std::vector<EvdevEvent>{{3, 0, 23122}, {4, 0, -494927427}, {0, 0, 0}}));
}

TEST(Evemu, WithoutADescriptionEventsAreKeptRaw) {
  const auto recording = import_evemu(events);
  ASSERT_TRUE(recording);
  EXPECT_FALSE(recording->device);
  EXPECT_EQ(recording->transfers.size(), 2u);
}

TEST(Evemu, WindowsLineEndsAndNoLastLineEnd) {
  const auto recording = import_evemu("N: A Pen\r\nE: 0.000001 0000 0000 0\r\nE: 2 0000 0000 0");
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(recording->device->name, "A Pen");
  EXPECT_EQ(recording->transfers.at(1).time, Timestamp(std::chrono::seconds(2)));
}

TEST(Evemu, ADropEndsItsFrame) {
  const auto recording = import_evemu("E: 0.1 0003 0000 5\nE: 0.1 0000 0003 0\nE: 0.2 0000 0000 0\n");
  ASSERT_TRUE(recording);
  EXPECT_EQ(recording->transfers.size(), 2u);
  EXPECT_EQ(recording->counts.frames, 1u);
}

TEST(Evemu, AFrameCutShortIsCounted) {
  const auto recording = import_evemu("E: 0.1 0000 0000 0\nE: 0.2 0003 0000 5\n");
  ASSERT_TRUE(recording);
  EXPECT_EQ(recording->counts.unclosed_events, 1u);
}

void expect_refusal(const std::string& text, const std::string& message) {
  const auto recording = import_evemu(text);
  ASSERT_FALSE(recording) << text;
  EXPECT_EQ(recording.error().fault, Fault::malformed);
  EXPECT_NE(recording.error().message.find(message), std::string::npos) << recording.error().message;
  EXPECT_EQ(recording.error().message.find('\n'), std::string::npos);
}

TEST(Evemu, BadLinesAreNamed) {
  expect_refusal("N: x\nE: 0.1 0003 0000\n", "line 2");
  expect_refusal("E: nan 0000 0000 0\n", "line 1");
  expect_refusal("E: -1.0 0000 0000 0\n", "line 1");
  expect_refusal("E: 99999999999.0 0000 0000 0\n", "line 1");
  expect_refusal("E: 0.1 0003 0000 99999999999\n", "line 1");
  expect_refusal("E: 0.1 0003 0000 5 6\n", "line 1");
  expect_refusal("# EVEMU 1.2\nhello\n", "line 2");
  expect_refusal("A: 00 0\n", "line 1");
  expect_refusal("A: ff 0 1 0 0\n", "line 1");
  expect_refusal("I: 0003 xyz\n", "line 1");
  expect_refusal("B: 01 zz\n", "line 1");
  expect_refusal("N: x\nA: 00 9 1 0 0\n", "ends below");
}

TEST(Evemu, TimeMayStandForAMomentButNotRunBackwards) {
  expect_refusal("E: 0.2 0000 0000 0\nE: 0.1 0000 0000 0\n", "line 2: time runs backwards by 0.1");
  expect_refusal("E: 5 0000 0000 0\nE: 5 0000 0000 0\nE: 5 0000 0000 0\n", "same time");
  const auto moment = import_evemu("E: 5 0000 0000 0\nE: 5 0000 0000 0\nE: 6 0000 0000 0\n");
  ASSERT_TRUE(moment);
  EXPECT_EQ(moment->counts.still_times, 1u);
}

}  // namespace
}  // namespace fude
