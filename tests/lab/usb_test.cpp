// USB devices with bulk endpoints on the kernel's virtual host, scripted to answer like the hardware, read
// and written by UsbSource.
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "drivers/transport/hidraw_source.h"
#include "drivers/transport/usb_hid_source.h"
#include "drivers/transport/usb_source.h"
#include "tests/lab/attached_node.h"
#include "tests/lab/byte_literals.h"
#include "tests/lab/patience.h"
#include "tests/lab/reopened.h"
#include "tests/lab/replugs.h"
#include "tests/lab/scripted_device.h"
#include "tests/lab/session_recording.h"

namespace fude::lab {
namespace {

constexpr std::uint8_t in = 0x81;
constexpr std::uint8_t out = 0x02;
const ScriptedInterface bulk_pair{0xff, {{in, true}, {out, true}}, {}};

// A report descriptor: one input of `size` bytes without a number.
Bytes vendor_reports(unsigned size) {
  return bytes({0x06, 0x00, 0xff, 0x09, 0x01, 0xa1, 0x01, 0x15, 0x00, 0x26, 0xff,
                0x00, 0x75, 0x08, 0x95, size, 0x09, 0x02, 0x81, 0x02, 0xc0});
}

struct Usb {
  Usb(const UsbIdentity& identity, const ScriptedInterface& interface, Answer answer = {}) {
    char id[32];
    std::snprintf(id, sizeof id, "%04x:%04x:", unsigned{identity.vendor}, unsigned{identity.product});
    node = attached_node(NodeKind::usb, id + identity.serial, [&] {
      device = std::make_unique<ScriptedDevice>(identity, 2, interface, std::move(answer));
    });
    auto opened = UsbSource::open(node.path, {0});
    if (!opened) throw std::runtime_error(opened.error().message);
    source = std::move(*opened);
  }
  std::unique_ptr<ScriptedDevice> device;
  DeviceNode node;
  std::unique_ptr<UsbSource> source;
};

// FTDI's chip in a Novint Falcon: vendor requests set it up; while its firmware is loaded it sends back
// what it is sent, behind two bytes of modem status in each packet.
TEST(Usb, AFalconsFirmwareIsEchoed) {
  constexpr unsigned chunks = 50;
  constexpr std::size_t chunk = 60;
  std::vector<ScriptedRequest> asked;
  Usb falcon({0x0403, 0xcb48, "FALCON1", "Falcon HAPTIC"}, bulk_pair,
             [&asked](const ScriptedRequest& request) -> std::optional<Bytes> {
               constexpr std::uint8_t get_latency = 0x0a;
               asked.push_back(request);
               if (request.request == get_latency) return bytes({16});
               if ((request.type & 0x80) != 0) return std::nullopt;
               return Bytes{};
             });
  EXPECT_EQ(falcon.node.description.name, "Falcon HAPTIC");
  std::thread echo([&] {
    while (auto received = falcon.device->receive(out)) {
      received->insert(received->begin(), {std::byte{0x01}, std::byte{0x60}});
      if (!falcon.device->send(in, *received)) return;
    }
  });
  SessionRecording recording(falcon.node.description);
  const auto write = [&](const Transfer& transfer) {
    const auto written = falcon.source->write(transfer);
    ASSERT_TRUE(written) << written.error().message;
    recording.add(transfer);
  };
  write(to_device(TransferKind::usb_control, bytes({0x40, 0x00, 0, 0, 0, 0, 0, 0})));        // reset
  write(to_device(TransferKind::usb_control, bytes({0x40, 0x03, 0x38, 0x41, 0, 0, 0, 0})));  // 9600 baud
  write(to_device(TransferKind::usb_control, bytes({0xc0, 0x0a, 0, 0, 0, 0, 1, 0})));  // the latency timer
  recording.drain_until(*falcon.source, 4);
  for (unsigned i = 0; i < chunks; ++i) {
    write(to_device(TransferKind::usb_bulk, numbered(i, chunk), out));
    ASSERT_TRUE(recording.drain_one(*falcon.source)) << i;
  }
  falcon.device->unplug();
  echo.join();
  ASSERT_EQ(asked.size(), 3u);
  EXPECT_EQ(asked[1].value, 0x4138);

  const auto transfers = recording.finish();
  ASSERT_EQ(transfers.size(), 4 + 2 * chunks);
  EXPECT_EQ(transfers[3].kind, TransferKind::usb_control);
  EXPECT_EQ(transfers[3].payload, bytes({0xc0, 0x0a, 0, 0, 0, 0, 1, 0, 16}));
  for (unsigned i = 0; i < chunks; ++i) {
    const Transfer& sent = transfers[4 + 2 * i];
    const Transfer& back = transfers[5 + 2 * i];
    EXPECT_EQ(sent.direction, Direction::to_device);
    EXPECT_EQ(back.direction, Direction::from_device);
    EXPECT_EQ(sent.endpoint, out);
    EXPECT_EQ(back.endpoint, in);
    ASSERT_EQ(back.payload.size(), chunk + 2);
    EXPECT_EQ(Bytes(back.payload.begin() + 2, back.payload.end()), numbered(i, chunk));
  }
}

TEST(Usb, WhatTheDeviceRefusesOrLeavesUnansweredIsSaid) {
  std::atomic<bool> hang = false;
  Usb usb({0x0f44, 0xef12, "TRACKER0", "PATRIOT"}, bulk_pair,
          [&hang](const ScriptedRequest&) -> std::optional<Bytes> {
            while (hang) std::this_thread::sleep_for(std::chrono::milliseconds(1));
            return std::nullopt;
          });
  const Bytes setup = bytes({0xc0, 0x55, 0, 0, 0, 0, 4, 0});
  const auto refused = usb.source->write(to_device(TransferKind::usb_control, setup));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().fault, Fault::unsupported);
  const auto answer = usb.source->read(patience());
  ASSERT_TRUE(answer && *answer);
  EXPECT_EQ((*answer)->payload, setup);  // and nothing after it
  hang = true;
  const auto silent = usb.source->write(to_device(TransferKind::usb_control, setup));
  hang = false;
  ASSERT_FALSE(silent);
  EXPECT_EQ(silent.error().fault, Fault::busy);
  const auto second = UsbSource::open(usb.node.path, {0});
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().fault, Fault::busy);
  EXPECT_NE(second.error().message.find("fude_lab"), std::string::npos) << second.error().message;
}

TEST(Usb, AHaltedEndpointIsClearedAndGoesOn) {
  Usb usb({0x0f44, 0xef12, "TRACKER1", "PATRIOT"}, bulk_pair);
  SessionRecording recording(usb.node.description);
  for (unsigned i = 0; i < 3; ++i) {
    usb.device->stall(in);
    while (usb.source->faults().stalls == i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    ASSERT_TRUE(usb.device->send(in, numbered(i, 40)));
    ASSERT_TRUE(recording.drain_one(*usb.source));
  }
  const auto transfers = recording.finish();
  for (unsigned i = 0; i < 3; ++i) EXPECT_EQ(transfers.at(i).payload, numbered(i, 40));
}

// A bulk transfer ends with a short packet, or when sixteen packets of 512 are full.
TEST(Usb, TransfersOfAnyLengthArriveWhole) {
  Usb usb({0x0f44, 0xef12, "TRACKER2", "PATRIOT"}, bulk_pair);
  SessionRecording recording(usb.node.description);
  Bytes sent;
  Bytes received;
  for (const std::size_t size : {1u, 2u, 511u, 512u, 513u, 1024u, 8191u, 8192u, 8193u, 20000u, 3u}) {
    const Bytes message = numbered(static_cast<unsigned>(size), size);
    ASSERT_TRUE(usb.device->send(in, message)) << size;
    sent.insert(sent.end(), message.begin(), message.end());
  }
  std::size_t total = 0;
  while (total < sent.size()) {
    ASSERT_TRUE(recording.drain_one(*usb.source)) << total << " of " << sent.size();
    total += recording.last().payload.size();
  }
  for (const Transfer& transfer : recording.finish())
    received.insert(received.end(), transfer.payload.begin(), transfer.payload.end());
  EXPECT_EQ(received, sent);
}

// The kernel's HID driver leaves the P5 Glove alone (hid-quirks.c): no hidraw node ever appears.
TEST(Usb, AP5GloveIsReadWithoutTheKernelsHidDriver) {
  const auto answer = [](const ScriptedRequest& request) -> std::optional<Bytes> {
    if ((request.type & 0x80) == 0) return Bytes{};
    if (request.value == 0x0306) return numbered(6, 30);
    return std::nullopt;
  };
  std::unique_ptr<ScriptedDevice> glove;
  const DeviceNode node = attached_node(NodeKind::usb, "0d7f:0100:GLOVE1", [&] {
    glove =
        std::make_unique<ScriptedDevice>(UsbIdentity{0x0d7f, 0x0100, "GLOVE1", "P5"}, 2,
                                         ScriptedInterface{3, {{in, false, 24}}, vendor_reports(24)}, answer);
  });
  auto source = UsbHidSource::open(node.path, 0, true);
  ASSERT_TRUE(source) << source.error().message;
  SessionRecording recording(node.description);
  EXPECT_TRUE((*source)->write(to_device(TransferKind::hid_feature, bytes({5, 0xff}))));
  ASSERT_TRUE((*source)->write(to_device(TransferKind::hid_ask, bytes({6}))));
  ASSERT_TRUE(recording.drain_one(**source));
  EXPECT_FALSE((*source)->write(to_device(TransferKind::hid_ask, bytes({12}))));
  recording.drain(**source);
  for (unsigned i = 0; i < 20; ++i) {
    ASSERT_TRUE(glove->send(in, numbered(i, 24)));
    ASSERT_TRUE(recording.drain_one(**source));
  }
  const auto transfers = recording.finish();
  ASSERT_EQ(transfers.size(), 21u);
  EXPECT_EQ(transfers[0].kind, TransferKind::hid_feature);
  EXPECT_EQ(transfers[0].payload, numbered(6, 30));
  for (unsigned i = 0; i < 20; ++i) {
    EXPECT_EQ(transfers[i + 1].kind, TransferKind::hid_report);
    EXPECT_EQ(transfers[i + 1].payload, numbered(i, 24));
  }
}

// Reports reach us while we have the interface, and the kernel's driver before and afterwards.
TEST(Usb, AnInterfaceIsTakenFromTheKernelAndGivenBack) {
  const std::string id = "1209:0001:HANDLE2";
  std::unique_ptr<ScriptedDevice> handle;
  attached_node(NodeKind::hidraw, id, [&] {
    handle = std::make_unique<ScriptedDevice>(UsbIdentity{0x1209, 0x0001, "HANDLE2", "brush handle"}, 2,
                                              ScriptedInterface{3, {{in, false, 24}}, vendor_reports(24)});
  });
  const auto usb = find_nodes(NodeKind::usb);
  ASSERT_TRUE(usb);
  std::filesystem::path path;
  for (const DeviceNode& node : *usb)
    if (node.description.id == id) path = node.path;
  const DeviceNode back = attached_node(NodeKind::hidraw, id, [&] {
    auto source = UsbSource::open(path, {0});
    ASSERT_TRUE(source) << source.error().message;
    ASSERT_TRUE(handle->send(in, numbered(5, 24)));
    const auto transfer = (*source)->read(patience());
    ASSERT_TRUE(transfer && *transfer);
    EXPECT_EQ((*transfer)->payload, numbered(5, 24));
  });
  auto source = HidrawSource::open(back.path);
  ASSERT_TRUE(source) << source.error().message;
  ASSERT_TRUE(handle->send(in, numbered(6, 24)));
  const auto transfer = (*source)->read(patience());
  ASSERT_TRUE(transfer && *transfer);
  EXPECT_EQ((*transfer)->payload.size(), 25u);
}

// Transfers that the host had completed when the device was pulled out and had not handed on.
constexpr std::size_t in_the_wire = 4;

TEST(Usb, PulledOutAndPutBackInMidStream) {
  const std::string id = "0f44:ef12:TRACKER3";
  ScriptedDevice device({0x0f44, 0xef12, "TRACKER3", "PATRIOT"}, 2, bulk_pair);
  ReturningSource source =
      returning(NodeKind::usb, id, [](const auto& path) { return UsbSource::open(path, {0}); });
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
      while (device.send(in, numbered(count, 60))) {
        sent.back().push_back(numbered(count++, 60));
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
  std::size_t frames = 0;
  std::size_t lost = 0;
  for (const auto& life : sent) {
    ASSERT_EQ(transfers.at(at++).kind, TransferKind::plugged);
    std::size_t arrived = 0;
    for (; transfers.at(at).kind == TransferKind::usb_bulk; ++at, ++arrived, ++frames) {
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
      "figure: a USB bulk device pulled out %d times in mid-stream, %zu frames, %zu lost by the kernel\n",
      replugs() + 1, frames, lost);
}

}  // namespace
}  // namespace fude::lab
