// The real libevdev and libudev over a recorded tablet that umockdev pretends.
#include <gtest/gtest.h>
#include <linux/input-event-codes.h>
#include <umockdev.h>

#include <chrono>
#include <memory>
#include <thread>
#include <vector>

#include "capture/import/import.h"
#include "drivers/tablet/identify.h"
#include "drivers/tablet/pen_decoder.h"
#include "drivers/transport/device_nodes.h"
#include "drivers/transport/evdev_source.h"
#include "tests/fakes/mock_tablet.h"
#include "tests/fakes/recordings.h"

namespace fude {
namespace {

DeviceDescription pen_tablet() {
  DeviceDescription device;
  device.name = "Mock Pen";
  device.transport = "evdev";
  device.bus = 3;
  device.vendor = 0x056a;
  device.product = 0x0304;
  device.version = 0x90;
  device.serial = "4711";
  device.keys = {BTN_TOOL_PEN, BTN_TOOL_RUBBER, BTN_TOUCH};
  device.properties = {INPUT_PROP_DIRECT};
  device.axes = {{ABS_X, 0, 59552, 4, 0, 200, 123},
                 {ABS_Y, 0, 33848, 4, 0, 200, 0},
                 {ABS_PRESSURE, 0, 1023, 0, 0, 0, 0}};
  device.id = device_id(device);
  return device;
}

class EvdevTransport : public testing::Test {
 protected:
  EvdevTransport() : testbed_(umockdev_testbed_new(), g_object_unref) {}

  // Only so that a failure ends.
  static Timestamp soon() { return monotonic_now() + std::chrono::minutes(5); }

  std::unique_ptr<UMockdevTestbed, decltype(&g_object_unref)> testbed_;
};

constexpr EvdevEvent report{EV_SYN, SYN_REPORT, 0};

TEST_F(EvdevTransport, RunsInThePretendedSystem) {
  ASSERT_TRUE(umockdev_in_mock_environment()) << "run this program under umockdev-wrapper";
}

TEST_F(EvdevTransport, TheKernelsDescriptionIsRead) {
  MockTablet tablet(testbed_.get(), pen_tablet(), 5);
  const auto source = EvdevSource::open(tablet.node());
  ASSERT_TRUE(source) << source.error().message;
  EXPECT_EQ((*source)->description(), pen_tablet());
}

TEST_F(EvdevTransport, TabletsAreFoundAndOthersPassedOver) {
  DeviceDescription keyboard = pen_tablet();
  keyboard.keys = {KEY_A};
  keyboard.axes.clear();
  MockTablet other(testbed_.get(), keyboard, 3);
  MockTablet tablet(testbed_.get(), pen_tablet(), 5);
  const auto found = find_nodes(NodeKind::input);
  ASSERT_TRUE(found) << found.error().message;
  ASSERT_EQ(found->size(), 1u);
  EXPECT_EQ(found->at(0).path, tablet.node());
  EXPECT_TRUE(found->at(0).access);
  EXPECT_EQ(found->at(0).description, identified(pen_tablet()));
  EXPECT_EQ(found->at(0).description.id, "056a:0304:4711");
}

TEST_F(EvdevTransport, ADeviceThatCallsItselfNothingHasUdevsSerial) {
  DeviceDescription device = pen_tablet();
  device.serial.clear();
  MockTablet tablet(testbed_.get(), device, 5);
  EXPECT_EQ(find_nodes(NodeKind::input).value().at(0).description.id, "056a:0304:FROMUDEV");
}

TEST_F(EvdevTransport, WhatIsHeldAtTheStartIsToldFirst) {
  MockTablet tablet(testbed_.get(), pen_tablet(), 5, {BTN_TOOL_PEN});
  const auto source = EvdevSource::open(tablet.node());
  ASSERT_TRUE(source);
  const auto first = (*source)->read(soon());
  ASSERT_TRUE(first && *first);
  PenDecoder decoder((*source)->description());
  const auto sample = decoder.decode(**first);
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample->tool, PenTool::pen);
  EXPECT_EQ(sample->x_counts, 123);
}

TEST_F(EvdevTransport, AFrameComesWhole) {
  MockTablet tablet(testbed_.get(), pen_tablet(), 5);
  const auto source = EvdevSource::open(tablet.node());
  ASSERT_TRUE(source);
  const std::vector<EvdevEvent> half{{EV_KEY, BTN_TOOL_PEN, 1}, {EV_ABS, ABS_X, 500}};
  tablet.send(half);
  EXPECT_EQ((*source)->read(monotonic_now() + std::chrono::milliseconds(50)).value(), std::nullopt);
  tablet.send({&report, 1});
  const auto read = (*source)->read(soon());
  ASSERT_TRUE(read && *read);
  EXPECT_EQ(unpack_events((*read)->payload).value(), (std::vector<EvdevEvent>{half[0], half[1], report}));
}

TEST_F(EvdevTransport, WakingEndsABlockingRead) {
  MockTablet tablet(testbed_.get(), pen_tablet(), 5);
  const auto source = EvdevSource::open(tablet.node());
  ASSERT_TRUE(source);
  std::thread other([&] { (*source)->wake(); });
  EXPECT_EQ((*source)->read(std::nullopt).value(), std::nullopt);
  other.join();
}

TEST_F(EvdevTransport, DroppedEventsAreAGapAndTheStateIsAskedForAgain) {
  MockTablet tablet(testbed_.get(), pen_tablet(), 5, {BTN_TOOL_PEN, BTN_TOUCH});
  const auto source = EvdevSource::open(tablet.node());
  ASSERT_TRUE(source);
  PenDecoder decoder((*source)->description());
  ASSERT_TRUE(decoder.decode((*source)->read(soon()).value().value()));
  // The pretended kernel still says x = 123 when it is asked after the drop.
  const std::vector<EvdevEvent> lossy{{EV_ABS, ABS_X, 900}, report,
                                      {EV_ABS, ABS_X, 950}, {EV_SYN, SYN_DROPPED, 0},
                                      {EV_ABS, ABS_X, 999}, report};
  tablet.send(lossy);
  EXPECT_EQ(decoder.decode((*source)->read(soon()).value().value())->x_counts, 900);
  EXPECT_FALSE(decoder.decode((*source)->read(soon()).value().value()));  // the cut frame
  const auto after = decoder.decode((*source)->read(soon()).value().value());
  ASSERT_TRUE(after);
  EXPECT_TRUE(after->after_gap);
  EXPECT_TRUE(after->in_contact);
  EXPECT_EQ(after->x_counts, 123);
  EXPECT_EQ(decoder.counts().lost, 1u);
}

TEST_F(EvdevTransport, UnplugInMidStrokeIsAnEventThenDeviceGone) {
  MockTablet tablet(testbed_.get(), pen_tablet(), 5, {BTN_TOOL_PEN, BTN_TOUCH});
  const auto source = EvdevSource::open(tablet.node());
  ASSERT_TRUE(source);
  PenDecoder decoder((*source)->description());
  EXPECT_TRUE(decoder.decode((*source)->read(soon()).value().value())->in_contact);
  tablet.hang_up();
  const auto gone = (*source)->read(soon());
  ASSERT_TRUE(gone && *gone);
  EXPECT_EQ((*gone)->kind, TransferKind::unplugged);
  EXPECT_EQ(decoder.decode(**gone)->tool, PenTool::none);
  const auto after = (*source)->read(soon());
  ASSERT_FALSE(after);
  EXPECT_EQ(after.error().fault, Fault::device_gone);
}

TEST_F(EvdevTransport, ComingAndGoingIsFollowed) {
  const auto monitor = NodeMonitor::open(all_node_kinds);
  ASSERT_TRUE(monitor) << monitor.error().message;
  MockTablet tablet(testbed_.get(), pen_tablet(), 5);
  const auto came = (*monitor)->next(soon());
  ASSERT_TRUE(came);
  EXPECT_TRUE(came->plugged);
  EXPECT_EQ(came->node.path, tablet.node());
  EXPECT_EQ(came->node.description.id, "056a:0304:4711");
  tablet.announce_removal();
  auto went = (*monitor)->next(soon());
  if (went && went->plugged) went = (*monitor)->next(soon());  // it was told of twice
  ASSERT_TRUE(went);
  EXPECT_FALSE(went->plugged);
  EXPECT_EQ(went->node.path, tablet.node());
}

TEST_F(EvdevTransport, MissingAndForeignFilesAreNamed) {
  EXPECT_EQ(EvdevSource::open("/dev/input/event99").error().fault, Fault::not_found);
  EXPECT_EQ(EvdevSource::open("/dev/null").error().fault, Fault::unsupported);
}

TEST_F(EvdevTransport, ARecordingThroughTheRealLibrariesDecodesAsTheImportDoes) {
  const char* file = "evdev/Wacom_Cintiq_12WX.events";
  REQUIRE_RECORDING(file);
  const auto imported = import_file(recordings() / file, {});
  ASSERT_TRUE(imported);
  const RawRecording& recording = imported->recordings.at(0);
  MockTablet tablet(testbed_.get(), *recording.device, 5);
  const auto source = EvdevSource::open(tablet.node());
  ASSERT_TRUE(source) << source.error().message;
  EXPECT_EQ((*source)->description().axes, recording.device->axes);
  EXPECT_EQ((*source)->description().keys, recording.device->keys);

  PenDecoder live((*source)->description());
  PenDecoder filed(*recording.device);
  for (const Transfer& transfer : recording.transfers) {
    tablet.send(unpack_events(transfer.payload).value());
    const auto read = (*source)->read(soon());
    ASSERT_TRUE(read && *read);
    auto sample = live.decode(**read);
    auto expected = filed.decode(transfer);
    ASSERT_EQ(sample.has_value(), expected.has_value());
    if (!sample) continue;
    sample->time = expected->time;  // the pretended kernel knows no monotonic clock
    EXPECT_EQ(*sample, *expected);
  }
  EXPECT_EQ(live.counts(), filed.counts());
}

}  // namespace
}  // namespace fude
