// Live devices and recording, over the tablets that umockdev pretends.
#include "rig/devices.h"

#include <gtest/gtest.h>
#include <linux/input-event-codes.h>
#include <umockdev.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>

#include "capture/session.h"
#include "drivers/falcon/falcon_decoder.h"
#include "drivers/falcon/simulated_arm.h"
#include "drivers/openigtlink/message.h"
#include "drivers/openigtlink/openigtlink_decoder.h"
#include "drivers/transport/tcp_source.h"
#include "drivers/transport/waker.h"
#include "rig/named_device.h"
#include "rig/pose_relay.h"
#include "rig/record_session.h"
#include "tests/fakes/mock_tablet.h"

namespace fude {
namespace {

DeviceDescription pen(const std::string& serial) {
  DeviceDescription device;
  device.name = "Mock Pen " + serial;
  device.bus = 3;
  device.vendor = 0x056a;
  device.product = 0x0304;
  device.serial = serial;
  device.keys = {BTN_TOOL_PEN, BTN_TOUCH};
  device.axes = {
      {ABS_X, 0, 59552, 4, 0, 200, 0}, {ABS_Y, 0, 33848, 4, 0, 200, 0}, {ABS_PRESSURE, 0, 1023, 0, 0, 0, 0}};
  return device;
}

void draw(MockTablet& tablet, int x) {
  const EvdevEvent events[] = {{EV_KEY, BTN_TOOL_PEN, 1},
                               {EV_KEY, BTN_TOUCH, 1},
                               {EV_ABS, ABS_PRESSURE, 300},
                               {EV_ABS, ABS_X, x},
                               {EV_SYN, SYN_REPORT, 0}};
  tablet.send(events);
}

constexpr Duration patience = std::chrono::minutes(5);  // of a test that would otherwise hang

std::filesystem::path scratch(const std::string& name) {
  const auto path =
      std::filesystem::path(testing::TempDir()) / ("fude-" + std::to_string(getpid()) + "-" + name);
  std::filesystem::remove(path);
  return path;
}

struct Heard {
  std::mutex mutex;
  std::vector<std::string> appeared;
  std::vector<std::pair<std::size_t, PenSample>> samples;
  std::vector<TransferKind> plugs;

  DeviceListener listener() {
    return {[this](std::size_t, const DeviceDescription& device) {
              const std::lock_guard lock(mutex);
              appeared.push_back(device.id);
            },
            [this](std::size_t tablet, const Transfer& transfer, std::span<const Sample> made) {
              const std::lock_guard lock(mutex);
              if (transfer.kind != TransferKind::evdev_frame) plugs.push_back(transfer.kind);
              for (const Sample& sample : made) samples.emplace_back(tablet, std::get<PenSample>(sample));
            },
            [](const Error&) {}};
  }
  // Waits for another thread; the limit only ends a test that has failed.
  bool until(const std::function<bool()>& come) {
    for (const Timestamp end = monotonic_now() + patience; monotonic_now() < end;) {
      {
        const std::lock_guard lock(mutex);
        if (come()) return true;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
  }
};

class LiveDevices : public testing::Test {
 protected:
  LiveDevices() : testbed_(umockdev_testbed_new(), g_object_unref) {}
  std::unique_ptr<UMockdevTestbed, decltype(&g_object_unref)> testbed_;
  Heard heard_;
};

TEST_F(LiveDevices, TwoTabletsAreReadAtOnce) {
  MockTablet one(testbed_.get(), pen("1"), 5);
  MockTablet two(testbed_.get(), pen("2"), 6);
  const auto tablets = Devices::open(heard_.listener(), {});
  ASSERT_TRUE(tablets) << tablets.error().message;
  EXPECT_EQ(heard_.appeared, (std::vector<std::string>{"056a:0304:1", "056a:0304:2"}));
  draw(one, 100);
  draw(two, 200);
  ASSERT_TRUE(heard_.until([&] { return heard_.samples.size() == 2; }));
  for (const auto& [tablet, sample] : heard_.samples) EXPECT_EQ(sample.x_counts, tablet == 0 ? 100 : 200);
}

TEST_F(LiveDevices, UnpluggedInMidStrokeAndBackUnderAnotherNodeItIsTheSame) {
  MockTablet tablet(testbed_.get(), pen("1"), 5);
  const auto tablets = Devices::open(heard_.listener(), {});
  ASSERT_TRUE(tablets);
  draw(tablet, 100);
  ASSERT_TRUE(heard_.until([&] { return heard_.samples.size() == 1; }));
  tablet.announce_removal();
  ASSERT_TRUE(heard_.until([&] { return heard_.samples.size() == 2; }));
  EXPECT_EQ(heard_.samples[1].second.tool, PenTool::none);

  MockTablet back(testbed_.get(), pen("1"), 9);
  ASSERT_TRUE(heard_.until([&] { return heard_.plugs.size() == 2; }));
  EXPECT_EQ(heard_.plugs, (std::vector{TransferKind::unplugged, TransferKind::plugged}));
  draw(back, 700);
  ASSERT_TRUE(heard_.until([&] { return heard_.samples.size() == 3; }));
  EXPECT_EQ(heard_.samples[2].first, 0u);
  EXPECT_TRUE(heard_.samples[2].second.after_gap);
  EXPECT_EQ(heard_.samples[2].second.x_counts, 700);
  EXPECT_EQ(heard_.appeared.size(), 1u);
}

TEST_F(LiveDevices, ATabletThatStaysWhileTheMachineSleepsGoesOnAfterAGap) {
  std::atomic<std::int64_t> asleep_s{0};
  const auto awake = [] { return monotonic_now().time_since_epoch(); };
  const SleepWatch sleep(awake, [&] { return awake() + std::chrono::seconds(asleep_s); });
  MockTablet tablet(testbed_.get(), pen("1"), 5);
  const auto tablets = Devices::open(heard_.listener(), {.sleep = sleep});
  ASSERT_TRUE(tablets);
  draw(tablet, 100);
  ASSERT_TRUE(heard_.until([&] { return heard_.samples.size() == 1; }));
  asleep_s += 3600;  // noticed without an event too
  ASSERT_TRUE(heard_.until([&] { return heard_.plugs.size() == 2; }));
  EXPECT_EQ(heard_.plugs, (std::vector{TransferKind::suspended, TransferKind::plugged}));
  EXPECT_EQ(heard_.samples.at(1).second.tool, PenTool::none);
  draw(tablet, 700);
  ASSERT_TRUE(heard_.until([&] { return heard_.samples.size() == 3; }));
  EXPECT_EQ(heard_.samples[2].first, 0u);
  EXPECT_TRUE(heard_.samples[2].second.after_gap);
  EXPECT_EQ(heard_.samples[2].second.x_counts, 700);
}

TEST_F(LiveDevices, ARecordingHoldsWhatWasDrawnAndItsReceiptAddsUp) {
  const std::filesystem::path file = scratch("recorded.fude");
  MockTablet tablet(testbed_.get(), pen("1"), 5);
  auto recording = RecordingSession::start(file, {}, [](const std::string&) {});
  ASSERT_TRUE(recording) << recording.error().message;
  // One at a time: umockdev's pipe holds 4 kB.
  const auto heard = [&](std::uint64_t count) {
    return heard_.until([&] { return (*recording)->samples() >= count; });
  };
  for (int i = 1; i <= 50; ++i) {
    draw(tablet, i);
    ASSERT_TRUE(heard(static_cast<std::uint64_t>(i)));
  }
  const EvdevEvent drop[] = {{EV_ABS, ABS_X, 51}, {EV_SYN, SYN_DROPPED, 0}, {EV_SYN, SYN_REPORT, 0}};
  tablet.send(drop);
  ASSERT_TRUE(heard(51));  // what the kernel was asked after the drop
  draw(tablet, 60);
  ASSERT_TRUE(heard(52));
  const auto streams = (*recording)->finish();
  ASSERT_TRUE(streams) << streams.error().message;
  ASSERT_EQ(streams->size(), 1u);
  EXPECT_EQ(streams->at(0).expected, streams->at(0).received + streams->at(0).dropped);
  EXPECT_EQ(streams->at(0).dropped, 1);
  EXPECT_EQ(streams->at(0).figures.gaps, 1);
  EXPECT_EQ(streams->at(0).received, 52);

  const auto session = read_session(file);
  ASSERT_TRUE(session) << session.error().message;
  EXPECT_TRUE(session->complete);
  EXPECT_EQ(session->devices.at(0).description.id, "056a:0304:1");
  ASSERT_GE(session->pens.size(), 50u);
  EXPECT_EQ(session->pens[49].sample.x_counts, 50);
  EXPECT_EQ(session->receipts.at(0).dropped, 1);
  std::filesystem::remove(file);
}

// One program serves a pose over VRPN, the relay reads it as `fude serve` does, and a third program has it
// over OpenIGTLink.
TEST_F(LiveDevices, WhatATrackerSeesIsGivenOn) {
  PoseServers tracker({.openigtlink = 0, .vrpn = 0});
  PoseSample seen;
  seen.tracker_from_tool = {Eigen::Quaterniond(0.6, 0, 0.8, 0), Eigen::Vector3d(0.25, -0.5, 1)};
  const std::size_t brush = tracker.add("brush");

  PoseRelay::Wish wish{.doors = {.openigtlink = 0, .vrpn = 0},
                       .named = {},
                       .fused_with_up = Eigen::Vector3d::UnitZ(),
                       .fused_ahead = {}};
  wish.named.push_back(*named_device("vrpn:127.0.0.1:" + std::to_string(tracker.vrpn()->port())));
  const auto relay = PoseRelay::open(std::move(wish), [](const std::string&) {});
  ASSERT_TRUE(relay) << relay.error().message;
  const TcpServer& door = *(*relay)->servers().openigtlink();
  auto reader = TcpSource::open({.port = door.port(), .fit = openigtlink::fit_message});
  ASSERT_TRUE(reader);

  OpenIgtLinkDecoder decoder;
  Decoded out;
  const Timestamp end = monotonic_now() + patience;
  while (out.samples.empty() && monotonic_now() < end) {
    seen.time.host = monotonic_now();
    tracker.send(brush, seen);
    (*relay)->attend();
    const auto transfer = (*reader)->read(monotonic_now() + std::chrono::milliseconds(20));
    ASSERT_TRUE(transfer);
    if (*transfer) decoder.decode(**transfer, out);
  }
  ASSERT_FALSE(out.samples.empty());
  const auto& given = std::get<PoseSample>(out.samples[0]);
  EXPECT_EQ(given.tool, "brush");
  EXPECT_LT((given.tracker_from_tool.translation - seen.tracker_from_tool.translation).norm(), 1e-7);
  EXPECT_LT(given.tracker_from_tool.rotation.angularDistance(seen.tracker_from_tool.rotation), 1e-6);
  // By itself, and as what is fused of it.
  ASSERT_EQ((*relay)->relayed().size(), 2u);
  EXPECT_EQ((*relay)->relayed()[1].name, "fused");
  for (const PoseRelay::Relayed& tool : (*relay)->relayed()) EXPECT_GE(tool.given, 1u);
}

// The whole dialogue with an arm is in the session, and decodes to what was felt: no force, for nobody
// paints.
TEST_F(LiveDevices, AnArmIsRecordedByItsLoop) {
  const std::filesystem::path file = scratch("arm.fude");
  std::atomic<int> asked{0};
  NamedDevice arm;
  arm.family = find_family("falcon", "usb");
  arm.description.name = "Falcon";
  arm.description.kind = arm.family->kind;
  arm.description.transport = "usb";
  arm.open = [&]() -> Result<std::unique_ptr<ByteSource>> {
    return std::make_unique<falcon::SimulatedArm>([&](Timestamp) {
      ++asked;
      return Eigen::Vector3d(0.01, 0.02, -0.01);
    });
  };
  auto recording =
      RecordingSession::start(file, {.overwrite = false, .named = {arm}}, [](const std::string&) {});
  ASSERT_TRUE(recording) << recording.error().message;
  while (asked < 200) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  const auto streams = (*recording)->finish();
  ASSERT_TRUE(streams) << streams.error().message;

  const auto session = read_session(file);
  ASSERT_TRUE(session) << session.error().message;
  EXPECT_GE(session->samples.size(), 199u);
  FalconDecoder decoder({}, false);
  Decoded again;
  for (const RecordedTransfer& recorded : session->transfers) decoder.decode(recorded.transfer, again);
  ASSERT_EQ(again.samples.size(), session->samples.size());
  for (std::size_t i = 0; i < again.samples.size(); ++i) {
    const auto& sample = std::get<HapticSample>(session->samples[i].sample);
    EXPECT_EQ(sample.encoder_counts, std::get<HapticSample>(again.samples[i]).encoder_counts);
    EXPECT_TRUE(sample.force_n.isZero());
  }
  std::filesystem::remove(file);
}

TEST_F(LiveDevices, WithoutATabletNoSessionIsMade) {
  const std::filesystem::path file = scratch("none.fude");
  const auto recording = RecordingSession::start(file, {}, [](const std::string&) {});
  ASSERT_FALSE(recording);
  EXPECT_EQ(recording.error().fault, Fault::not_found);
  EXPECT_FALSE(std::filesystem::exists(file));
}

}  // namespace
}  // namespace fude
