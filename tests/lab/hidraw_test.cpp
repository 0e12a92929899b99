// HID devices read and written by HidrawSource: made by uhid, where each report is in our hands, and on the
// virtual USB host, where usbhid and the wire lie between.
#include <gtest/gtest.h>
#include <unistd.h>

#include <memory>
#include <string>
#include <vector>

#include "drivers/transport/hidraw_source.h"
#include "tests/lab/attached_node.h"
#include "tests/lab/byte_literals.h"
#include "tests/lab/patience.h"
#include "tests/lab/reopened.h"
#include "tests/lab/replugs.h"
#include "tests/lab/scripted_device.h"
#include "tests/lab/session_recording.h"
#include "tests/lab/uhid_device.h"

namespace fude::lab {
namespace {

// Input 1 of seven bytes, feature 2 of four, output 3 of four.
Bytes numbered_descriptor() {
  return bytes({0x06, 0x00, 0xff, 0x09, 0x01, 0xa1, 0x01, 0x15, 0x00, 0x26, 0xff, 0x00, 0x75,
                0x08, 0x85, 0x01, 0x95, 0x07, 0x09, 0x02, 0x81, 0x02, 0x85, 0x02, 0x95, 0x04,
                0x09, 0x03, 0xb1, 0x02, 0x85, 0x03, 0x95, 0x04, 0x09, 0x04, 0x91, 0x02, 0xc0});
}

// Input of eight bytes without a number.
Bytes plain_descriptor() {
  return bytes({0x06, 0x00, 0xff, 0x09, 0x01, 0xa1, 0x01, 0x15, 0x00, 0x26, 0xff,
                0x00, 0x75, 0x08, 0x95, 0x08, 0x09, 0x02, 0x81, 0x02, 0xc0});
}

Bytes report(unsigned count) { return bytes({1, count & 0xff, count >> 8, 3, 5, 7, 11, 13}); }

struct Uhid {
  explicit Uhid(const Bytes& descriptor) {
    node = attached_node(NodeKind::hidraw, "1209:0001:LABHID", [&] {
      device = std::make_unique<UhidDevice>(HidIdentity{"lab HID", 0x1209, 0x0001, "LABHID"}, descriptor);
    });
    auto opened = HidrawSource::open(node.path);
    if (!opened) throw std::runtime_error(opened.error().message);
    source = std::move(*opened);
  }
  std::unique_ptr<UhidDevice> device;
  DeviceNode node;
  std::unique_ptr<HidrawSource> source;
};

TEST(Hidraw, ADialogueIsRecordedAsItWas) {
  Uhid hid(numbered_descriptor());
  EXPECT_EQ(hid.node.description.name, "lab HID");
  EXPECT_EQ(hid.node.description.transport, "hidraw");
  const auto descriptor = hid.source->report_descriptor();
  EXPECT_EQ(Bytes(descriptor.begin(), descriptor.end()), numbered_descriptor());

  SessionRecording recording(hid.node.description);
  hid.device->set_feature(bytes({2, 10, 20, 30, 40}));
  hid.device->send(report(1));
  recording.drain(*hid.source);
  ASSERT_TRUE(hid.source->write(to_device(TransferKind::hid_ask, bytes({2}))));
  recording.drain(*hid.source);
  ASSERT_TRUE(hid.source->write(to_device(TransferKind::hid_feature, bytes({2, 50, 60, 70, 80}))));
  EXPECT_EQ(hid.device->feature(2), bytes({2, 50, 60, 70, 80}));
  ASSERT_TRUE(hid.source->write(to_device(TransferKind::hid_report, bytes({3, 1, 2, 3, 4}))));
  hid.device->send(report(2));
  recording.drain(*hid.source);
  const auto refused = hid.source->write(to_device(TransferKind::hid_ask, bytes({9})));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().fault, Fault::unsupported) << refused.error().message;

  const auto transfers = recording.finish();
  ASSERT_EQ(transfers.size(), 3u);
  EXPECT_EQ(transfers[0].kind, TransferKind::hid_report);
  EXPECT_EQ(transfers[0].payload, report(1));
  EXPECT_EQ(transfers[0].stamped_by, StampedBy::arrival);
  EXPECT_EQ(transfers[1].kind, TransferKind::hid_feature);
  EXPECT_EQ(transfers[1].payload, bytes({2, 10, 20, 30, 40}));
  EXPECT_EQ(transfers[2].payload, report(2));
  // The output report travels to the device's thread by itself.
  for (const Timestamp end = patience(); hid.device->outputs().empty() && monotonic_now() < end;)
    usleep(1000);
  EXPECT_EQ(hid.device->outputs(), std::vector<Bytes>{bytes({3, 1, 2, 3, 4})});
}

TEST(Hidraw, AReportWithoutNumberHasTheNumberNought) {
  Uhid hid(plain_descriptor());
  hid.device->send(bytes({1, 2, 3, 4, 5, 6, 7, 8}));
  SessionRecording recording(hid.node.description);
  recording.drain(*hid.source);
  EXPECT_EQ(recording.finish().at(0).payload, bytes({0, 1, 2, 3, 4, 5, 6, 7, 8}));
}

TEST(Hidraw, ASecondReaderIsToldWhoTheFirstIs) {
  const Uhid hid(numbered_descriptor());
  const auto second = HidrawSource::open(hid.node.path);
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().fault, Fault::busy);
  EXPECT_NE(second.error().message.find("fude_lab (process " + std::to_string(getpid()) + ")"),
            std::string::npos)
      << second.error().message;
}

// The kernel says nothing of what it drops; the device's own count does.
TEST(Hidraw, AnOverfullBufferKeepsTheOldest) {
  constexpr unsigned flood = 200;
  Uhid hid(numbered_descriptor());
  SessionRecording recording(hid.node.description);
  for (unsigned i = 0; i < flood; ++i) hid.device->send(report(i));
  const std::size_t kept = recording.drain(*hid.source);
  hid.device->send(report(flood));
  recording.drain(*hid.source);
  const auto transfers = recording.finish();
  EXPECT_GE(kept, 60u);
  EXPECT_LT(kept, 70u);
  ASSERT_EQ(transfers.size(), kept + 1);
  for (unsigned i = 0; i < kept; ++i) EXPECT_EQ(transfers[i].payload, report(i));
  EXPECT_EQ(transfers.back().payload, report(flood));
}

TEST(Hidraw, PulledOutWithReportsUnread) {
  Uhid hid(numbered_descriptor());
  SessionRecording recording(hid.node.description);
  for (unsigned i = 0; i < 10; ++i) hid.device->send(report(i));
  hid.device.reset();
  recording.drain_until(*hid.source, 100);
  ASSERT_TRUE(recording.error());
  EXPECT_EQ(recording.error()->fault, Fault::device_gone);
  const auto transfers = recording.finish();
  ASSERT_EQ(transfers.size(), 11u);
  for (unsigned i = 0; i < 10; ++i) EXPECT_EQ(transfers[i].payload, report(i));
  EXPECT_EQ(transfers.back().kind, TransferKind::unplugged);
  const auto gone = hid.source->write(to_device(TransferKind::hid_report, bytes({3, 1, 2, 3, 4})));
  ASSERT_FALSE(gone);
  EXPECT_EQ(gone.error().fault, Fault::device_gone);
}

constexpr std::uint8_t reports_in = 0x81;

ScriptedInterface hid_interface() { return {3, {{reports_in, false, 8}}, numbered_descriptor()}; }

// A brush handle on the virtual USB host: the kernel's usbhid asks for its descriptor, feature reports are
// control transfers that this test answers.
TEST(UsbHid, FeatureReportsGoOverTheWire) {
  Bytes kept = bytes({2, 1, 2, 3, 4});
  std::unique_ptr<ScriptedDevice> device;
  const auto answer = [&kept](const ScriptedRequest& request) -> std::optional<Bytes> {
    constexpr std::uint8_t get_report = 1;
    constexpr std::uint8_t set_report = 9;
    if (request.request == get_report && request.value == 0x0302) return kept;
    if (request.request != set_report) return std::nullopt;
    kept = request.data;
    return Bytes{};
  };
  const DeviceNode node = attached_node(NodeKind::hidraw, "1209:0001:HANDLE1", [&] {
    device = std::make_unique<ScriptedDevice>(UsbIdentity{0x1209, 0x0001, "HANDLE1", "brush handle"}, 0,
                                              hid_interface(), answer);
  });
  auto source = HidrawSource::open(node.path);
  ASSERT_TRUE(source) << source.error().message;
  SessionRecording recording(node.description);
  ASSERT_TRUE((*source)->write(to_device(TransferKind::hid_ask, bytes({2}))));
  recording.drain_until(**source, 1);
  ASSERT_TRUE((*source)->write(to_device(TransferKind::hid_feature, bytes({2, 9, 8, 7, 6}))));
  ASSERT_TRUE((*source)->write(to_device(TransferKind::hid_ask, bytes({2}))));
  recording.drain_until(**source, 2);
  EXPECT_FALSE((*source)->write(to_device(TransferKind::hid_ask, bytes({5}))));  // it stalls
  EXPECT_TRUE(device->send(reports_in, report(7)));
  recording.drain_until(**source, 3);
  EXPECT_TRUE(device->send(reports_in, bytes({1, 2})));  // cut short: not every kernel hands it on
  EXPECT_TRUE(device->send(reports_in, report(8)));
  while (recording.last().payload != report(8)) ASSERT_TRUE(recording.drain_one(**source));
  const auto transfers = recording.finish();
  ASSERT_LE(transfers.size(), 5u);
  EXPECT_EQ(transfers[0].payload, bytes({2, 1, 2, 3, 4}));
  EXPECT_EQ(transfers[1].payload, bytes({2, 9, 8, 7, 6}));
  EXPECT_EQ(transfers[2].payload, report(7));
  if (transfers.size() == 5) {
    EXPECT_EQ(transfers[3].payload, bytes({1, 2}));
  }
}

// The one report that the host had taken when the device was pulled out and had not handed on.
constexpr std::size_t in_the_wire = 1;

// The device streams without pause; it is pulled out whenever, and comes back.
TEST(UsbHid, PulledOutAndPutBackInMidStream) {
  const std::string id = "256f:c635:MOUSE1";
  ScriptedDevice device({0x256f, 0xc635, "MOUSE1", "SpaceMouse"}, 1, hid_interface());
  ReturningSource source =
      returning(NodeKind::hidraw, id, [](const auto& path) { return HidrawSource::open(path); });
  DeviceDescription described;
  described.id = id;
  SessionRecording recording(described);
  std::vector<std::vector<Bytes>> sent;  // in each life
  unsigned count = 0;
  for (int life = 0; life <= replugs(); ++life) {
    if (life > 0) device.plug();
    const std::size_t begun = recording.size();
    ASSERT_EQ(recording.drain_until(source, begun + 1), begun + 1) << "life " << life;
    sent.emplace_back();
    std::thread stream([&] {
      while (device.send(reports_in, report(count))) {
        sent.back().push_back(report(count++));
        usleep(1000);  // as devices do, some thousand a second
      }
    });
    recording.drain_until(source, begun + 10 + static_cast<std::size_t>(life % 7));
    wait_for_any_moment(life, std::chrono::milliseconds(2));
    device.unplug();
    stream.join();
    while (recording.last().kind != TransferKind::unplugged)
      ASSERT_TRUE(recording.drain_one(source))
          << "life " << life << ": " << (recording.error() ? recording.error()->message : "silence");
  }
  const auto transfers = recording.finish();
  std::size_t at = 0;
  std::size_t reports = 0;
  std::size_t lost = 0;
  for (const auto& life : sent) {
    ASSERT_EQ(transfers.at(at++).kind, TransferKind::plugged);
    std::size_t arrived = 0;
    for (; transfers.at(at).kind == TransferKind::hid_report; ++at, ++arrived, ++reports) {
      ASSERT_LT(arrived, life.size());
      ASSERT_EQ(transfers[at].payload, life[arrived]);
    }
    EXPECT_GE(arrived, 9u);
    lost += life.size() - arrived;
    EXPECT_LE(life.size() - arrived, in_the_wire);
    EXPECT_EQ(transfers.at(at++).kind, TransferKind::unplugged);
  }
  EXPECT_EQ(at, transfers.size());
  std::printf(
      "figure: a USB HID device pulled out %d times in mid-stream, %zu reports, %zu lost by the kernel\n",
      replugs() + 1, reports, lost);
}

}  // namespace
}  // namespace fude::lab
