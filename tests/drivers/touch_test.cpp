#include <gtest/gtest.h>
#include <linux/input-event-codes.h>
#include <linux/input.h>

#include <numbers>

#include "drivers/touch/touch_decoder.h"
#include "tests/fakes/sound_sample.h"
#include "tests/fakes/transfers.h"

namespace fude {
namespace {

DeviceDescription surface() {
  DeviceDescription device;
  device.transport = "evdev";
  device.keys = {BTN_TOUCH};
  device.axes = {{.code = ABS_MT_SLOT, .maximum = 9},
                 {.code = ABS_MT_TOUCH_MAJOR, .maximum = 255},
                 {.code = ABS_MT_TOUCH_MINOR, .maximum = 255},
                 {.code = ABS_MT_ORIENTATION, .minimum = -90, .maximum = 90},
                 {.code = ABS_MT_POSITION_X, .maximum = 4000},
                 {.code = ABS_MT_POSITION_Y, .maximum = 3000},
                 {.code = ABS_MT_TRACKING_ID, .maximum = 65535},
                 {.code = ABS_MT_PRESSURE, .maximum = 200}};
  return device;
}

EvdevEvent axis(int code, int value) { return {EV_ABS, static_cast<std::uint16_t>(code), value}; }

std::vector<TouchSample> frame(TouchDecoder& decoder, std::vector<EvdevEvent> events, int milliseconds = 0) {
  events.push_back({EV_SYN, SYN_REPORT, 0});
  std::vector<TouchSample> all;
  for (const Sample& s :
       decoded(decoder, from_device(TransferKind::evdev_frame, pack_events(events), milliseconds)).samples) {
    EXPECT_TRUE(is_sound(s));
    all.push_back(std::get<TouchSample>(s));
  }
  return all;
}

std::vector<EvdevEvent> down(int slot, int contact, int x, int y) {
  return {axis(ABS_MT_SLOT, slot), axis(ABS_MT_TRACKING_ID, contact), axis(ABS_MT_POSITION_X, x),
          axis(ABS_MT_POSITION_Y, y)};
}

TEST(Touch, IsASurfaceAndNoTablet) {
  EXPECT_TRUE(is_touch_surface(surface()));
  DeviceDescription tablet = surface();
  tablet.keys = {BTN_TOOL_PEN};
  tablet.axes.push_back({.code = ABS_X, .maximum = 1});
  tablet.axes.push_back({.code = ABS_Y, .maximum = 1});
  EXPECT_FALSE(is_touch_surface(tablet));
  EXPECT_FALSE(is_touch_surface({}));
}

TEST(Touch, AContactCarriesEveryField) {
  TouchDecoder decoder(surface());
  auto events = down(0, 17, 1000, 600);
  for (const auto& e : {axis(ABS_MT_TOUCH_MAJOR, 40), axis(ABS_MT_TOUCH_MINOR, 25),
                        axis(ABS_MT_ORIENTATION, 45), axis(ABS_MT_PRESSURE, 50)})
    events.push_back(e);
  const auto all = frame(decoder, events, 12);
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].time.host, Timestamp(std::chrono::milliseconds(12)));
  EXPECT_EQ(all[0].contact, 17);
  EXPECT_TRUE(all[0].down);
  EXPECT_EQ(all[0].x_counts, 1000);
  EXPECT_EQ(all[0].y_counts, 600);
  EXPECT_EQ(all[0].major_counts, 40.0);
  EXPECT_EQ(all[0].minor_counts, 25.0);
  EXPECT_NEAR(all[0].orientation->value, std::numbers::pi / 4, 1e-12);
  EXPECT_EQ(all[0].pressure, Fraction(0.25));
}

TEST(Touch, ContactsOfAReportShareItsTimeAndOnlyChangesAreSent) {
  TouchDecoder decoder(surface());
  auto both = down(0, 1, 10, 20);
  for (const auto& e : down(1, 2, 30, 40)) both.push_back(e);
  EXPECT_EQ(frame(decoder, both).size(), 2u);
  const auto moved = frame(decoder, {axis(ABS_MT_POSITION_X, 31)}, 8);
  ASSERT_EQ(moved.size(), 2u);
  EXPECT_EQ(moved[0].x_counts, 10);
  EXPECT_EQ(moved[1].x_counts, 31);
  EXPECT_EQ(moved[0].time, moved[1].time);
  EXPECT_EQ(moved[0].time.sequence, 1u);
}

TEST(Touch, LeavingIsToldOnce) {
  TouchDecoder decoder(surface());
  frame(decoder, down(0, 1, 10, 20));
  const auto left = frame(decoder, {axis(ABS_MT_TRACKING_ID, -1)});
  ASSERT_EQ(left.size(), 1u);
  EXPECT_EQ(left[0].contact, 1);
  EXPECT_FALSE(left[0].down);
  EXPECT_TRUE(frame(decoder, {}).empty());
}

TEST(Touch, ANewContactInAUsedSlotEndsTheOldOne) {
  TouchDecoder decoder(surface());
  frame(decoder, down(0, 1, 10, 20));
  const auto all = frame(decoder, down(0, 2, 500, 600));
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].contact, 1);
  EXPECT_FALSE(all[0].down);
  EXPECT_EQ(all[0].x_counts, 10);
  EXPECT_EQ(all[1].contact, 2);
  EXPECT_TRUE(all[1].down);
}

TEST(Touch, APalmIsMarkedForAsLongAsItStays) {
  TouchDecoder decoder(surface());
  auto events = down(0, 1, 10, 20);
  events.push_back(axis(ABS_MT_TOOL_TYPE, MT_TOOL_PALM));
  EXPECT_TRUE(frame(decoder, events).at(0).palm);
  EXPECT_TRUE(frame(decoder, {}).at(0).palm);
  EXPECT_FALSE(frame(decoder, down(0, 2, 10, 20)).at(1).palm);
}

TEST(Touch, AfterADropEverythingUpToTheNextReportIsStale) {
  TouchDecoder decoder(surface());
  const auto before = frame(decoder, down(0, 1, 10, 20));
  EXPECT_TRUE(
      frame(decoder, {axis(ABS_MT_POSITION_X, 900), {EV_SYN, SYN_DROPPED, 0}, axis(ABS_MT_POSITION_X, 901)})
          .empty());
  const auto after = frame(decoder, {axis(ABS_MT_POSITION_Y, 21)});
  ASSERT_EQ(after.size(), 1u);
  EXPECT_EQ(after[0].x_counts, 10);
  EXPECT_TRUE(after[0].after_gap);
  EXPECT_EQ(after[0].time.sequence, before[0].time.sequence + 2);
  EXPECT_FALSE(frame(decoder, {}).at(0).after_gap);
  EXPECT_EQ(decoder.counts().lost, 1u);
}

TEST(Touch, AbsenceAndSleepLiftEveryFinger) {
  for (const TransferKind away : {TransferKind::unplugged, TransferKind::suspended}) {
    TouchDecoder decoder(surface());
    auto both = down(0, 1, 10, 20);
    for (const auto& e : down(3, 2, 30, 40)) both.push_back(e);
    frame(decoder, both);
    const Decoded gone = decoded(decoder, from_device(away));
    ASSERT_EQ(gone.samples.size(), 2u);
    EXPECT_FALSE(std::get<TouchSample>(gone.samples[1]).down);
    EXPECT_TRUE(frame(decoder, {}).empty());
    EXPECT_TRUE(frame(decoder, down(0, 3, 1, 1)).at(0).after_gap);
  }
}

TEST(Touch, HostileSlotsAndValuesAreHeld) {
  TouchDecoder decoder(surface());
  for (int slot : {-1, 10, 1 << 30, INT32_MIN}) EXPECT_TRUE(frame(decoder, down(slot, 1, 1, 1)).empty());
  auto events = down(2, 5, INT32_MAX, INT32_MIN);
  for (int code : {ABS_MT_TOUCH_MAJOR, ABS_MT_ORIENTATION, ABS_MT_PRESSURE})
    events.push_back(axis(code, INT32_MIN));
  const auto all = frame(decoder, events);
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].x_counts, 8000);
  EXPECT_EQ(all[0].y_counts, -3000);
  Transfer cut = from_device(TransferKind::evdev_frame, std::vector<std::byte>(7));
  EXPECT_TRUE(decoded(decoder, cut).samples.empty());
  EXPECT_EQ(decoder.counts().malformed, 1u);
}

}  // namespace
}  // namespace fude
