// Devices that answer as the hardware is described to, each with its own family's driver at the other end of
// the kernel's USB: what was sent is what was decoded, and what was left out is counted.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "drivers/falcon/haptic_loop.h"
#include "drivers/falcon/message.h"
#include "drivers/transport/hidraw_source.h"
#include "drivers/transport/serial_source.h"
#include "drivers/transport/usb_source.h"
#include "tests/fakes/family_streams.h"
#include "tests/lab/attached_node.h"
#include "tests/lab/byte_literals.h"
#include "tests/lab/dialogue.h"
#include "tests/lab/patience.h"
#include "tests/lab/reopened.h"
#include "tests/lab/scripted_device.h"
#include "tests/lab/scripted_port.h"

namespace fude::lab {
namespace {

constexpr std::uint8_t in = 0x81;
constexpr std::uint8_t out = 0x02;

// Vendor-defined: input 1 and, where there is one, feature 2, of so many bytes behind their numbers.
Bytes report_descriptor(unsigned input, unsigned feature) {
  Bytes all = bytes({0x06, 0x00, 0xff, 0x09, 0x01, 0xa1, 0x01,  0x15, 0x00, 0x26, 0xff,
                     0x00, 0x75, 0x08, 0x85, 0x01, 0x95, input, 0x09, 0x02, 0x81, 0x02});
  if (feature > 0) {
    const Bytes more = bytes({0x85, 0x02, 0x95, feature, 0x09, 0x03, 0xb1, 0x02});
    all.insert(all.end(), more.begin(), more.end());
  }
  all.push_back(std::byte{0xc0});
  return all;
}

TEST(FamilyOnTheWire, BrushHandle) {
  constexpr unsigned count = 200;
  const std::string id = "1209:0001:HANDLE3";
  const auto length = [](const Bytes& report) { return static_cast<unsigned>(report.size()) - 1; };
  const ScriptedInterface interface {
    3, {{in, false, 64}}, report_descriptor(length(handle_motion(0)), length(handle_scale()))
  };
  std::unique_ptr<ScriptedDevice> handle;
  const DeviceNode node = attached_node(NodeKind::hidraw, id, [&] {
    handle = std::make_unique<ScriptedDevice>(
        UsbIdentity{0x1209, 0x0001, "HANDLE3", "brush handle"}, 0, interface,
        [](const ScriptedRequest& request) -> std::optional<Bytes> {
          return request.value == 0x0302 ? std::optional(handle_scale()) : std::nullopt;
        });
  });
  auto source = returning(NodeKind::hidraw, id, [](const auto& path) { return HidrawSource::open(path); });
  ASSERT_TRUE(source.read(patience()));
  Dialogue dialogue(source, node.description);
  ASSERT_TRUE(dialogue.hear_one());  // the scale
  std::vector<unsigned> told;
  for (unsigned i = 0; i < count; ++i) {
    if (i >= 100 && i < 105) continue;  // five that the radio lost
    ASSERT_TRUE(handle->send(in, handle_motion(i)));
    told.push_back(i);
    ASSERT_TRUE(dialogue.hear(told.size()));
  }
  Bytes damaged = handle_motion(count);
  damaged[20] ^= std::byte{1};
  ASSERT_TRUE(handle->send(in, damaged));
  ASSERT_TRUE(dialogue.hear_one());
  EXPECT_EQ(dialogue.counts().lost, 5u);
  EXPECT_EQ(dialogue.counts().malformed, 1u);
  handle->unplug();
  while (dialogue.last().kind != TransferKind::unplugged) ASSERT_TRUE(dialogue.hear_one());
  handle->plug();
  while (dialogue.last().kind != TransferKind::hid_feature) ASSERT_TRUE(dialogue.hear_one());
  ASSERT_TRUE(handle->send(in, handle_motion(0)));  // it counts from the beginning
  told.push_back(0);
  ASSERT_TRUE(dialogue.hear(told.size()));

  ASSERT_EQ(dialogue.samples.size(), told.size());
  for (std::size_t i = 0; i < told.size(); ++i) {
    const auto& sample = std::get<ImuSample>(dialogue.samples[i]);
    EXPECT_EQ(sample.after_gap, told[i] == 105 || i + 1 == told.size()) << i;
    if (i + 1 < told.size()) {
      EXPECT_EQ(*sample.time.device_tick, 1000u * told[i]);
    }
    EXPECT_NEAR(sample.specific_force_mps2.z(), 9.80665, 1e-6);  // 2048 of 32768 counts of 16 g
  }
  const auto again = dialogue.again();
  ASSERT_EQ(again.size(), told.size());
  for (std::size_t i = 0; i < told.size(); ++i)
    EXPECT_EQ(std::get<ImuSample>(again[i]), std::get<ImuSample>(dialogue.samples[i]));
}

TEST(FamilyOnTheWire, SpaceMouse) {
  constexpr unsigned count = 100;
  std::unique_ptr<ScriptedDevice> mouse;
  const DeviceNode node = attached_node(NodeKind::hidraw, "256f:c632:MOUSE2", [&] {
    mouse =
        std::make_unique<ScriptedDevice>(UsbIdentity{0x256f, 0xc632, "MOUSE2", "SpaceMouse"}, 1,
                                         ScriptedInterface{3, {{in, false, 32}}, report_descriptor(12, 0)});
  });
  auto source = HidrawSource::open(node.path);
  ASSERT_TRUE(source) << source.error().message;
  Dialogue dialogue(**source, node.description);
  for (unsigned i = 0; i < count; ++i) {
    ASSERT_TRUE(mouse->send(in, spacemouse_motion(i)));
    ASSERT_TRUE(dialogue.hear(i + 1));
    const auto& sample = std::get<PuckSample>(dialogue.samples[i]);
    EXPECT_NEAR(sample.push.x(), (static_cast<int>(3 * i % 200) - 100) / 350.0, 1e-12);
  }
  EXPECT_EQ(dialogue.counts(), (ReportCounts{.reports = count, .samples = count}));
  EXPECT_EQ(dialogue.again().size(), count);
}

// It takes commands on one endpoint and, told to go on without being asked, streams on the other.
TEST(FamilyOnTheWire, PolhemusPatriot) {
  constexpr unsigned count = 200;
  std::unique_ptr<ScriptedDevice> tracker;
  const DeviceNode node = attached_node(NodeKind::usb, "0f44:ef12:TRACKER4", [&] {
    tracker = std::make_unique<ScriptedDevice>(UsbIdentity{0x0f44, 0xef12, "TRACKER4", "PATRIOT"}, 2,
                                               ScriptedInterface{0xff, {{in, true}, {out, true}}, {}});
  });
  std::string heard;
  std::thread device([&] {
    while (!heard.ends_with("C\r")) {
      const auto command = tracker->receive(out);
      if (!command) return;
      for (const std::byte byte : *command) heard.push_back(static_cast<char>(byte));
    }
    for (unsigned i = 0; i < count; ++i)
      if (i < 50 || i >= 55) tracker->send(in, patriot_record(i));
  });
  auto source = UsbSource::open(node.path, {0});
  ASSERT_TRUE(source) << source.error().message;
  Dialogue dialogue(**source, node.description, {{0x04, out}});
  const bool all = dialogue.hear(count - 5);
  tracker->unplug();
  device.join();
  ASSERT_TRUE(all);
  EXPECT_TRUE(heard.starts_with("P")) << heard;
  EXPECT_EQ(dialogue.counts().lost, 5u);
  EXPECT_EQ(dialogue.counts().malformed, 0u);
  for (unsigned i = 0; i < count - 5; ++i) {
    const auto& sample = std::get<PoseSample>(dialogue.samples[i]);
    const unsigned frame = i < 50 ? i : i + 5;
    EXPECT_NEAR(sample.tracker_from_tool.translation.x(), 0.1 + 0.001 * frame, 1e-6);
    EXPECT_EQ(sample.after_gap, frame == 55);
  }
  EXPECT_EQ(dialogue.again().size(), count - 5);
}

// An arm that runs its firmware says where it is each time it is told a force.
TEST(FamilyOnTheWire, NovintFalcon) {
  constexpr unsigned count = 200;
  unsigned requests = 0;
  std::unique_ptr<ScriptedDevice> arm;
  const DeviceNode node = attached_node(NodeKind::usb, "0403:cb48:FALCON2", [&] {
    arm = std::make_unique<ScriptedDevice>(UsbIdentity{0x0403, 0xcb48, "FALCON2", "FALCON HAPTIC"}, 2,
                                           ScriptedInterface{0xff, {{in, true}, {out, true}}, {}},
                                           [&](const ScriptedRequest&) {
                                             ++requests;
                                             return std::optional(Bytes{});
                                           });
  });
  unsigned answered = 0;
  std::thread device([&] {
    while (arm->receive(out)) {
      Bytes answer = bytes({0x01, 0x60});
      const Bytes message = falcon_answer(answered);
      answer.insert(answer.end(), message.begin(), message.end());
      if (!arm->send(in, answer)) return;
      ++answered;
    }
  });
  auto source = UsbSource::open(node.path, {0});
  ASSERT_TRUE(source) << source.error().message;
  Dialogue dialogue(**source, node.description);
  const bool all = dialogue.hear(count);
  arm->unplug();
  device.join();
  ASSERT_TRUE(all);
  EXPECT_GT(requests, 3u);  // its serial chip was set up
  EXPECT_EQ(dialogue.counts().malformed, 0u);
  for (unsigned i = 0; i < count; ++i) {
    const auto& sample = std::get<HapticSample>(dialogue.samples[i]);
    EXPECT_TRUE(sample.homed);
    EXPECT_EQ(sample.encoder_counts[0], static_cast<int>(3 * i % 200) - 100);
    EXPECT_TRUE(sample.force_n.isZero());
  }
  EXPECT_EQ(dialogue.again().size(), count);
}

// Driven by its loop, an arm is told the force that is wanted, and none from 20 ms after nobody wants it any
// more; unplugged, it ends the loop.
TEST(FamilyOnTheWire, NovintFalconDrivenByItsLoop) {
  using namespace falcon;
  constexpr unsigned count = 200;
  std::unique_ptr<ScriptedDevice> arm;
  const DeviceNode node = attached_node(NodeKind::usb, "0403:cb48:FALCON4", [&] {
    arm = std::make_unique<ScriptedDevice>(UsbIdentity{0x0403, 0xcb48, "FALCON4", "FALCON HAPTIC"}, 2,
                                           ScriptedInterface{0xff, {{in, true}, {out, true}}, {}},
                                           [](const ScriptedRequest&) { return std::optional(Bytes{}); });
  });
  std::vector<ToArm> told;
  std::thread device([&] {
    while (const auto message = arm->receive(out)) {
      if (const auto read = read_to_arm(*message)) told.push_back(*read);
      Bytes answer = bytes({0x01, 0x60});
      const Bytes state = write_from_arm({.homed = 7});
      answer.insert(answer.end(), state.begin(), state.end());
      if (!arm->send(in, answer)) return;
    }
  });
  auto source = UsbSource::open(node.path, {0});
  ASSERT_TRUE(source) << source.error().message;
  MonotonicLoopClock clock;
  FalconDecoder decoder({}, false);
  std::optional<Eigen::Vector3d> wish = Eigen::Vector3d(0, 2, 0);
  std::vector<ToArm> said;
  bool heard_it_go = false;
  HapticLoop loop(
      **source, clock, decoder, [&](const HapticSample&) { return wish; },
      [&](const Transfer& transfer, const Decoded&) {
        heard_it_go = heard_it_go || transfer.kind == TransferKind::unplugged;
        if (transfer.direction == Direction::from_device) return;
        if (const auto message = read_to_arm(transfer.payload)) said.push_back(*message);
      });
  bool all = true;
  const Timestamp end = patience();
  while (all && loop.counts().samples < count && clock.now() < end) all = loop.step().has_value();
  const auto with_force = [](const ToArm& m) { return m.motors != std::array<std::int16_t, 3>{}; };
  const auto forces = std::ranges::count_if(said, with_force);
  wish.reset();
  const Timestamp gone_by = clock.now() + std::chrono::milliseconds(20);
  while (all && clock.now() < gone_by) all = loop.step().has_value();
  all = all && loop.step().has_value();
  const ToArm last = said.back();
  arm->unplug();
  device.join();
  ASSERT_TRUE(all);
  while (loop.step()) continue;
  EXPECT_TRUE(heard_it_go);
  EXPECT_GE(loop.counts().samples, count);
  EXPECT_GT(forces, 0);
  EXPECT_FALSE(with_force(last));
  EXPECT_EQ(decoder.counts().malformed, 0u);
  // What the arm was told is what is recorded; of the last words some may not have come through.
  ASSERT_GE(told.size(), count);
  ASSERT_LE(told.size(), said.size());
  for (std::size_t i = 0; i < told.size(); ++i) EXPECT_EQ(told[i], said[i]) << i;
}

TEST(FamilyOnTheWire, UltrasonicBoard) {
  constexpr unsigned count = 100;
  std::optional<ScriptedPort> board;
  const DeviceNode node = attached_node(NodeKind::serial, "1209:0002:SOUND3", [&] {
    board.emplace(UsbIdentity{0x1209, 0x0002, "SOUND3", "ultrasonic receiver"}, 0);
  });
  auto source = SerialSource::open(node.path, 921600);
  ASSERT_TRUE(source) << source.error().message;
  Dialogue dialogue(**source, node.description);
  // A zero, and two commands, each ended by one.
  std::ptrdiff_t zeros = 0;
  while (zeros < 3) {
    const Bytes said = board->receive(1);
    ASSERT_FALSE(said.empty());
    zeros += std::ranges::count(said, std::byte{0});
  }
  std::size_t told = 0;
  for (unsigned i = 0; i < count; ++i) {
    if (i >= 40 && i < 43) continue;
    if (i == 70) {
      ASSERT_TRUE(board->send(bytes({0xaa, 0x55, 0x12, 0x00})));  // noise on the line
    }
    ASSERT_TRUE(board->send(ultrasonic_pulse(i)));
    ASSERT_TRUE(dialogue.hear(++told));
    const auto& sample = std::get<RangeSample>(dialogue.samples.back());
    EXPECT_EQ(*sample.time.device_tick, 20'000u * i);
    EXPECT_NEAR(*sample.flight_s[1], 1.1e-3 + 1e-6 * i, 1e-12);
    EXPECT_EQ(sample.after_gap, i == 43);
  }
  EXPECT_EQ(dialogue.counts().lost, 3u);
  EXPECT_EQ(dialogue.counts().malformed, 1u);
  EXPECT_EQ(dialogue.again().size(), told);
}

}  // namespace
}  // namespace fude::lab
