// Recordings of raw reports: kept byte by byte, with the descriptor beside them.
#include <gtest/gtest.h>

#include "capture/import/hid_recorder.h"
#include "capture/import/import.h"
#include "capture/import/joycon_uart.h"
#include "capture/import/usbhid_dump.h"
#include "tests/fakes/recordings.h"

namespace fude {
namespace {

std::vector<unsigned> bytes(const std::vector<std::byte>& payload) {
  std::vector<unsigned> numbers;
  for (const std::byte b : payload) numbers.push_back(std::to_integer<unsigned>(b));
  return numbers;
}

TEST(HidRecorder, DevicesTakeTurnsByTheirNumber) {
  const auto read = import_hid_recorder(
      "# 021:0 -> 056A:0314\nD:0\nR: 4 85 02 81 02\nN: A Pen\nP: usb-1\nI: 3 056A 0314\n"
      "D:1\nR: 2 81 02\nN: Its Touch\nI: 3 056A 0314\nE: 0.5 2 01 02\n"
      "D:0\n# SET_REPORT\nE: 1.25 3 02 ff 00\nD:1\nE: 2.000001 1 7f\nE:\n");
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->size(), 2U);
  const RawRecording &pen = (*read)[0], &touch = (*read)[1];
  EXPECT_EQ(pen.device->name, "A Pen");
  EXPECT_EQ(pen.device->id, "056a:0314:");
  EXPECT_EQ(pen.device->transport, "hidraw");
  EXPECT_EQ(bytes(pen.device->hid_descriptor), (std::vector<unsigned>{0x85, 2, 0x81, 2}));
  ASSERT_EQ(pen.transfers.size(), 1U);
  EXPECT_EQ(pen.transfers[0].kind, TransferKind::hid_report);
  EXPECT_EQ(pen.transfers[0].time, Timestamp(std::chrono::milliseconds(1250)));
  EXPECT_EQ(bytes(pen.transfers[0].payload), (std::vector<unsigned>{2, 0xff, 0}));
  // Reports without numbers stand behind a 0.
  ASSERT_EQ(touch.transfers.size(), 2U);
  EXPECT_EQ(bytes(touch.transfers[0].payload), (std::vector<unsigned>{0, 1, 2}));
  EXPECT_TRUE(pen.passed_over.empty() && touch.passed_over.empty());
}

TEST(HidRecorder, WhatCannotBeReadIsCounted) {
  const auto read = import_hid_recorder(
      "R: 3 85 02\nI: 3 xyz\nN: A Pen\nhello\nE: 0.5 3 01 02\nE: 0.6 2 01 0g\nE: 0.7 1 01\nE: 0.6 1 01\n");
  ASSERT_TRUE(read) << read.error().message;
  const RawRecording& pen = (*read)[0];
  EXPECT_EQ(pen.transfers.size(), 1U);
  EXPECT_EQ(pen.passed_over.at("reports that are cut off or no bytes"), 2U);
  EXPECT_EQ(pen.passed_over.at("reports whose time runs backwards"), 1U);
  EXPECT_EQ(pen.passed_over.at("report descriptors that are cut off or no bytes"), 1U);
  EXPECT_EQ(pen.passed_over.at("I: lines that are not bus, vendor, product"), 1U);
  EXPECT_EQ(pen.passed_over.at("lines of no known kind"), 1U);
}

TEST(HidRecorder, PublishedRecordingsKeepEveryReport) {
  REQUIRE_RECORDING("hid/Wacom_Intuos_Pro_S_056a_0314.hid.gz");
  struct Expected {
    const char* file;
    std::size_t devices, reports;
  };
  for (const Expected e : {Expected{"hid/Wacom_Intuos_Pro_S_056a_0314.hid.gz", 2, 5937},
                           Expected{"hid/Wacom_Cintiq_22HD_056a_00FA.hid", 1, 1269},
                           Expected{"hid/Wacom_Intuos4_WL_056a_00BC.hid", 1, 2021},
                           Expected{"hid/Wacom_Graphire3_056a_0013.hid", 1, 1317},
                           Expected{"hid/Wacom_PenPartner_hidrecord.txt", 1, 874},
                           Expected{"hid/Wacom_Inkling_hidrecord.txt", 1, 0},
                           Expected{"hid/oculus_rift_dk1_2833_0001.hid.gz", 1, 0}}) {
    const auto file = import_file(recordings() / e.file, {});
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_EQ(file->format, ImportFormat::hid_recorder);
    ASSERT_EQ(file->recordings.size(), e.devices) << e.file;
    std::size_t reports = 0;
    for (const RawRecording& r : file->recordings) {
      reports += r.transfers.size();
      EXPECT_TRUE(r.passed_over.empty()) << e.file;
      EXPECT_FALSE(r.device->hid_descriptor.empty());
    }
    EXPECT_EQ(reports, e.reports) << e.file;
  }
}

TEST(UsbhidDump, BlocksBecomeReports) {
  const auto read = import_usbhid_dump(
      "003:007:000:DESCRIPTOR         1557634280.000001\n 05 0D\n 85 08\n\n"
      "003:007:000:STREAM             1557634289.487561\n 08 80 88\n 47\n\n"
      "003:007:001:STREAM             1557634289.5\n 01 02\n"
      "003:007:000:STREAM             1557634289.6\n 08 zz\n\nwhat\n");
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->size(), 2U);
  const RawRecording& first = (*read)[0];
  EXPECT_EQ(bytes(first.device->hid_descriptor), (std::vector<unsigned>{5, 0x0d, 0x85, 8}));
  ASSERT_EQ(first.transfers.size(), 1U);
  EXPECT_EQ(bytes(first.transfers[0].payload), (std::vector<unsigned>{8, 0x80, 0x88, 0x47}));
  EXPECT_EQ(first.transfers[0].time.time_since_epoch(), Duration(1557634289487561000));
  EXPECT_EQ(first.passed_over.at("blocks that are no bytes"), 1U);
  EXPECT_EQ(first.passed_over.at("lines outside of blocks"), 1U);
}

TEST(UsbhidDump, ThePageBesideItNamesTheTablet) {
  const auto tablet = read_tablet_page(
      "---\nVID: \"256c\"\nPID: \"006d\"\nvendor: Huion\nproduct: HS610\nworking_area:\n    width: 10\n"
      "    height: 6.25\n    resolution: 5080\npen:\n    pressure_levels: 8192\n---\n");
  ASSERT_TRUE(tablet.has_value());
  EXPECT_EQ(tablet->name, "Huion HS610");
  EXPECT_EQ(tablet->vendor, 0x256c);
  EXPECT_NEAR(tablet->width->value, 254, 1e-9);
  EXPECT_NEAR(tablet->height->value, 158.75, 1e-9);
  ASSERT_EQ(tablet->axes.size(), 3U);
  EXPECT_EQ(tablet->axes[0].maximum, 50800);
  EXPECT_EQ(tablet->axes[2].maximum, 8191);
  EXPECT_FALSE(read_tablet_page("# a page about something else\n").has_value());
}

TEST(JoyconUart, TheTimerOfTheReportsGivesTheTime) {
  std::string packet = "0x19 0x81 0x3 0x38 0x0 0x92 0x0 0x31 0x0 0x0 0x0 0x0 0x30";
  const std::string rest = [] {
    std::string zeros;
    for (int i = 0; i < 47; ++i) zeros += " 0x0";
    return zeros;
  }();
  const auto read = import_joycon_uart("0x19 0x81 0x3 0x7 0x0 0x94\n" + packet + " 0xfe" + rest + "\n" +
                                       packet + " 0x1" + rest + "\nnot bytes\n");
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->transfers.size(), 3U);
  EXPECT_EQ(read->transfers[1].time, Timestamp{});
  EXPECT_EQ(read->transfers[2].time, Timestamp(std::chrono::milliseconds(15)));
  EXPECT_EQ(read->transfers[2].payload.size(), 61U);
  EXPECT_EQ(read->passed_over.at("lines that are no packets"), 1U);
}

}  // namespace
}  // namespace fude
