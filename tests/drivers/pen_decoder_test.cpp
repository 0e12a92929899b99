#include "drivers/tablet/pen_decoder.h"

#include <gtest/gtest.h>
#include <linux/input-event-codes.h>

#include <cmath>
#include <initializer_list>
#include <limits>

namespace fude {
namespace {

// As the Intuos4 6x9 describes itself.
DeviceDescription intuos4() {
  DeviceDescription device;
  device.keys = {BTN_TOOL_PEN,   BTN_TOOL_RUBBER, BTN_TOOL_BRUSH, BTN_TOOL_PENCIL, BTN_TOOL_AIRBRUSH,
                 BTN_TOOL_MOUSE, BTN_TOOL_LENS,   BTN_TOUCH,      BTN_STYLUS,      BTN_STYLUS2};
  device.axes = {{.code = ABS_X, .minimum = 0, .maximum = 44704},
                 {.code = ABS_Y, .minimum = 0, .maximum = 27940},
                 {.code = ABS_Z, .minimum = -900, .maximum = 899},
                 {.code = ABS_WHEEL, .minimum = 0, .maximum = 1023},
                 {.code = ABS_PRESSURE, .minimum = 0, .maximum = 2047},
                 {.code = ABS_DISTANCE, .minimum = 0, .maximum = 63},
                 {.code = ABS_TILT_X, .minimum = 0, .maximum = 127},
                 {.code = ABS_TILT_Y, .minimum = 0, .maximum = 127},
                 {.code = ABS_MISC}};
  return device;
}

// One frame closed by its SYN_REPORT.
Transfer frame(std::initializer_list<EvdevEvent> events, int milliseconds = 0) {
  std::vector<EvdevEvent> all(events);
  all.push_back({EV_SYN, SYN_REPORT, 0});
  Transfer transfer;
  transfer.time = Timestamp(std::chrono::milliseconds(milliseconds));
  transfer.payload = pack_events(all);
  return transfer;
}

EvdevEvent key(int code, int value) { return {EV_KEY, static_cast<std::uint16_t>(code), value}; }
EvdevEvent axis(int code, int value) { return {EV_ABS, static_cast<std::uint16_t>(code), value}; }
EvdevEvent serial(std::uint32_t value) { return {EV_MSC, MSC_SERIAL, static_cast<std::int32_t>(value)}; }

Transfer dropped() {
  Transfer transfer;
  const std::array events{axis(ABS_X, 7), EvdevEvent{EV_SYN, SYN_DROPPED, 0}};
  transfer.payload = pack_events(events);
  return transfer;
}

TEST(PenDecoder, FirstFrameOfARealDragCarriesEveryField) {
  PenDecoder decoder(intuos4());
  const auto sample = decoder.decode(
      frame({axis(ABS_X, 4488), axis(ABS_Y, 4680), axis(ABS_DISTANCE, 58), axis(ABS_TILT_X, 110),
             axis(ABS_TILT_Y, 44), axis(ABS_MISC, 2050), key(BTN_TOOL_PEN, 1), serial(0x99800b93)},
            12));
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample->tool, PenTool::pen);
  EXPECT_TRUE(sample->in_proximity);
  EXPECT_FALSE(sample->in_contact);
  EXPECT_EQ(sample->time.host, Timestamp(std::chrono::milliseconds(12)));
  EXPECT_EQ(sample->x_counts, 4488);
  EXPECT_EQ(sample->y_counts, 4680);
  EXPECT_EQ(sample->tool_serial, 0x99800b93u);
  EXPECT_EQ(sample->tool_id, 2050u);
  EXPECT_NEAR(in_degrees(*sample->tilt_x), 46, 1e-12);   // leans right
  EXPECT_NEAR(in_degrees(*sample->tilt_y), -20, 1e-12);  // and away
  EXPECT_NEAR(sample->distance->value, 58.0 / 63, 1e-12);
  EXPECT_EQ(sample->pressure, Fraction(0));
  EXPECT_FALSE(sample->after_gap);
}

TEST(PenDecoder, OnlyChangesAreSentAndTheRestStands) {
  PenDecoder decoder(intuos4());
  decoder.decode(frame({key(BTN_TOOL_PEN, 1), axis(ABS_X, 10), axis(ABS_Y, 20), axis(ABS_TILT_X, 127)}));
  const auto sample = decoder.decode(frame({axis(ABS_X, 11)}));
  EXPECT_EQ(sample->x_counts, 11);
  EXPECT_EQ(sample->y_counts, 20);
  EXPECT_NEAR(in_degrees(*sample->tilt_x), 63, 1e-12);
}

TEST(PenDecoder, AxesStartWhereTheDescriptionSaysTheyStood) {
  DeviceDescription device = intuos4();
  device.axes[0].value = 1234;
  PenDecoder decoder(device);
  EXPECT_EQ(decoder.decode(frame({key(BTN_TOOL_PEN, 1)}))->x_counts, 1234);
}

TEST(PenDecoder, EachToolKeyIsItsTool) {
  const std::pair<int, PenTool> tools[] = {{BTN_TOOL_PEN, PenTool::pen},
                                           {BTN_TOOL_RUBBER, PenTool::rubber},
                                           {BTN_TOOL_BRUSH, PenTool::brush},
                                           {BTN_TOOL_PENCIL, PenTool::pencil},
                                           {BTN_TOOL_AIRBRUSH, PenTool::airbrush}};
  for (const auto& [code, tool] : tools) {
    PenDecoder decoder(intuos4());
    EXPECT_EQ(decoder.decode(frame({key(code, 1)}))->tool, tool);
    EXPECT_EQ(decoder.decode(frame({key(code, 0)}))->tool, PenTool::none);
    EXPECT_FALSE(decoder.decode(frame({})));
  }
}

TEST(PenDecoder, APuckIsNoPen) {
  PenDecoder decoder(intuos4());
  EXPECT_FALSE(decoder.decode(frame({key(BTN_TOOL_MOUSE, 1), axis(ABS_X, 500)})));
  EXPECT_FALSE(decoder.decode(frame({key(BTN_TOOL_LENS, 1)})));
  EXPECT_EQ(decoder.counts().samples, 0u);
  EXPECT_EQ(decoder.counts().frames, 2u);
}

TEST(PenDecoder, LeavingIsToldOnceAndIsNoSample) {
  PenDecoder decoder(intuos4());
  decoder.decode(frame({key(BTN_TOOL_PEN, 1), key(BTN_TOUCH, 1), axis(ABS_PRESSURE, 900)}));
  const auto left = decoder.decode(frame({key(BTN_TOOL_PEN, 0), axis(ABS_PRESSURE, 0)}, 8));
  ASSERT_TRUE(left);
  EXPECT_EQ(left->tool, PenTool::none);
  EXPECT_FALSE(left->in_proximity);
  EXPECT_FALSE(left->in_contact);
  EXPECT_EQ(decoder.counts().samples, 1u);
}

TEST(PenDecoder, ContactIsTheTouchKeyWhereThereIsOne) {
  PenDecoder decoder(intuos4());
  const auto hovering = decoder.decode(frame({key(BTN_TOOL_PEN, 1), axis(ABS_PRESSURE, 30)}));
  EXPECT_FALSE(hovering->in_contact);
  EXPECT_NEAR(hovering->pressure.value, 30.0 / 2047, 1e-12);
  EXPECT_EQ(hovering->pressure_raw, 30);
  EXPECT_TRUE(decoder.decode(frame({key(BTN_TOUCH, 1)}))->in_contact);
  EXPECT_FALSE(decoder.decode(frame({key(BTN_TOUCH, 0)}))->in_contact);
  EXPECT_EQ(decoder.counts().strokes, 1u);
}

TEST(PenDecoder, ContactIsPressureWhereThereIsNoTouchKey) {
  DeviceDescription device = intuos4();
  device.keys = {BTN_TOOL_PEN};
  PenDecoder decoder(device);
  EXPECT_FALSE(decoder.decode(frame({key(BTN_TOOL_PEN, 1)}))->in_contact);
  EXPECT_TRUE(decoder.decode(frame({axis(ABS_PRESSURE, 1)}))->in_contact);
}

TEST(PenDecoder, WithoutToolKeysThePenIsAlwaysThere) {
  DeviceDescription device = intuos4();
  device.keys = {BTN_TOUCH, BTN_STYLUS};
  PenDecoder decoder(device);
  const auto sample = decoder.decode(frame({}));
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample->tool, PenTool::pen);
}

TEST(PenDecoder, EverySignOfTilt) {
  for (const auto& [code, tilt] :
       {std::pair{ABS_TILT_X, &PenSample::tilt_x}, {ABS_TILT_Y, &PenSample::tilt_y}}) {
    PenDecoder decoder(intuos4());
    decoder.decode(frame({key(BTN_TOOL_PEN, 1)}));
    const auto at = [&](int counts) {
      return in_degrees(*((*decoder.decode(frame({axis(code, counts)}))).*tilt));
    };
    EXPECT_NEAR(at(0), -64, 1e-12);
    EXPECT_NEAR(at(63), -1, 1e-12);
    EXPECT_NEAR(at(64), 0, 1e-12);
    EXPECT_NEAR(at(65), 1, 1e-12);
    EXPECT_NEAR(at(127), 63, 1e-12);
  }
}

TEST(PenDecoder, TiltWithAResolutionIsInItsOwnUnit) {
  DeviceDescription device = intuos4();
  for (AxisRange& a : device.axes) {
    if (a.code == ABS_TILT_X) a = {.code = ABS_TILT_X, .minimum = -64, .maximum = 63, .resolution = 57};
    if (a.code == ABS_TILT_Y) a = {.code = ABS_TILT_Y, .minimum = -9000, .maximum = 9000, .resolution = 5730};
  }
  PenDecoder decoder(device);
  const auto sample =
      decoder.decode(frame({key(BTN_TOOL_PEN, 1), axis(ABS_TILT_X, -57), axis(ABS_TILT_Y, 4500)}));
  EXPECT_DOUBLE_EQ(sample->tilt_x->value, -1);
  EXPECT_DOUBLE_EQ(sample->tilt_y->value, 4500.0 / 5730);
}

TEST(PenDecoder, BarrelTurnsClockwiseByAFifthOfADegreeACount) {
  PenDecoder decoder(intuos4());
  decoder.decode(frame({key(BTN_TOOL_PEN, 1)}));
  const auto at = [&](int counts) {
    return in_degrees(*decoder.decode(frame({axis(ABS_Z, counts)}))->rotation);
  };
  EXPECT_NEAR(at(-900), -180, 1e-12);
  EXPECT_NEAR(at(-450), -90, 1e-12);
  EXPECT_NEAR(at(0), 0, 1e-12);
  EXPECT_NEAR(at(1), 0.2, 1e-12);
  EXPECT_NEAR(at(899), 179.8, 1e-12);
}

TEST(PenDecoder, WheelAndButtons) {
  PenDecoder decoder(intuos4());
  const auto pressed = decoder.decode(
      frame({key(BTN_TOOL_AIRBRUSH, 1), axis(ABS_WHEEL, 1023), key(BTN_STYLUS, 1), key(BTN_STYLUS2, 1)}));
  EXPECT_EQ(pressed->wheel, Fraction(1));
  EXPECT_EQ(pressed->buttons, 3u);
  EXPECT_EQ(decoder.decode(frame({key(BTN_STYLUS, 0), key(BTN_STYLUS3, 1)}))->buttons, 6u);
}

TEST(PenDecoder, MissingAxesAreAbsentAndNotZero) {
  DeviceDescription device;
  device.keys = {BTN_TOUCH};
  device.axes = {{.code = ABS_X, .maximum = 100}, {.code = ABS_Y, .maximum = 100}, {.code = ABS_TILT_X}};
  PenDecoder decoder(device);
  const auto sample = decoder.decode(frame({key(BTN_TOUCH, 1)}));
  EXPECT_FALSE(sample->tilt_x || sample->tilt_y || sample->rotation || sample->distance || sample->wheel);
  EXPECT_EQ(sample->pressure, Fraction(1));  // a pen without pressure is all or nothing
}

TEST(PenDecoder, WhatThePadSaysIsNotThePens) {
  PenDecoder decoder(intuos4());
  decoder.decode(frame({key(BTN_TOOL_PEN, 1), axis(ABS_MISC, 2050), axis(ABS_WHEEL, 5), serial(77)}));
  const auto sample = decoder.decode(frame({axis(ABS_WHEEL, 900), axis(ABS_MISC, 15), serial(0xffffffff)}));
  EXPECT_EQ(sample->tool_serial, 77u);
  EXPECT_EQ(sample->tool_id, 2050u);
  EXPECT_NEAR(sample->wheel->value, 5.0 / 1023, 1e-12);
}

TEST(PenDecoder, AfterADropEverythingUpToTheNextReportIsStale) {
  PenDecoder decoder(intuos4());
  const auto before = decoder.decode(frame({key(BTN_TOOL_PEN, 1), axis(ABS_X, 100)}));
  EXPECT_FALSE(decoder.decode(dropped()));
  EXPECT_FALSE(decoder.decode(frame({axis(ABS_X, 999)})));
  const auto after = decoder.decode(frame({axis(ABS_Y, 40)}));
  ASSERT_TRUE(after);
  EXPECT_EQ(after->x_counts, 100);
  EXPECT_EQ(after->y_counts, 40);
  EXPECT_TRUE(after->after_gap);
  EXPECT_EQ(after->time.sequence, before->time.sequence + 2);  // the hole shows
  EXPECT_EQ(decoder.counts().lost, 1u);
  EXPECT_FALSE(decoder.decode(frame({}))->after_gap);
}

TEST(PenDecoder, UnplugEndsTheStrokeAndForgetsTheState) {
  PenDecoder decoder(intuos4());
  decoder.decode(frame({key(BTN_TOOL_PEN, 1), key(BTN_TOUCH, 1), axis(ABS_PRESSURE, 500)}));
  Transfer gone;
  gone.kind = TransferKind::unplugged;
  const auto left = decoder.decode(gone);
  ASSERT_TRUE(left);
  EXPECT_EQ(left->tool, PenTool::none);
  EXPECT_FALSE(decoder.decode(gone));
  Transfer back;
  back.kind = TransferKind::plugged;
  EXPECT_FALSE(decoder.decode(back));
  EXPECT_FALSE(decoder.decode(frame({axis(ABS_X, 3)})));  // no pen near yet
  const auto again = decoder.decode(frame({key(BTN_TOOL_PEN, 1)}));
  EXPECT_TRUE(again->after_gap);
  EXPECT_FALSE(again->in_contact);
}

// The kernel lets go of the keys, and tells of an axis again only once it has moved.
TEST(PenDecoder, SuspensionEndsTheStrokeAndKeepsTheAxes) {
  PenDecoder decoder(intuos4());
  decoder.decode(frame({key(BTN_TOOL_PEN, 1), key(BTN_TOUCH, 1), key(BTN_STYLUS, 1), axis(ABS_PRESSURE, 500),
                        axis(ABS_X, 70), axis(ABS_Y, 80)}));
  Transfer slept;
  slept.kind = TransferKind::suspended;
  const auto left = decoder.decode(slept);
  ASSERT_TRUE(left);
  EXPECT_EQ(left->tool, PenTool::none);
  EXPECT_FALSE(decoder.decode(slept));
  EXPECT_FALSE(decoder.decode(frame({key(BTN_TOOL_PEN, 0)})));  // the kernel's own word of it
  const auto again = decoder.decode(frame({key(BTN_TOOL_PEN, 1), axis(ABS_X, 75)}));
  ASSERT_TRUE(again);
  EXPECT_TRUE(again->after_gap);
  EXPECT_FALSE(again->in_contact);
  EXPECT_EQ(again->buttons, 0u);
  EXPECT_EQ(again->x_counts, 75);
  EXPECT_EQ(again->y_counts, 80);
  EXPECT_EQ(decoder.counts().lost, 0u);
}

TEST(PenDecoder, HostileValuesAreHeldAndCounted) {
  PenDecoder decoder(intuos4());
  constexpr int lowest = std::numeric_limits<std::int32_t>::min();
  constexpr int highest = std::numeric_limits<std::int32_t>::max();
  for (int value : {lowest, highest}) {
    const auto sample = decoder.decode(frame(
        {key(BTN_TOOL_PEN, 1), axis(ABS_X, value), axis(ABS_Y, value), axis(ABS_PRESSURE, value),
         axis(ABS_TILT_X, value), axis(ABS_Z, value), axis(ABS_DISTANCE, value), axis(ABS_WHEEL, value)}));
    EXPECT_EQ(sample->x_counts, value > 0 ? 2 * 44704 : -44704);
    EXPECT_EQ(sample->pressure, Fraction(value > 0 ? 1 : 0));
    EXPECT_LE(std::abs(in_degrees(*sample->tilt_x)), 64);
    EXPECT_LE(std::abs(in_degrees(*sample->rotation)), 180);
    EXPECT_TRUE(std::isfinite(sample->distance->value) && std::isfinite(sample->wheel->value));
  }
  EXPECT_EQ(decoder.counts().out_of_range, 14u);
}

TEST(PenDecoder, OverhangAtTheEdgeIsKept) {
  PenDecoder decoder(intuos4());
  EXPECT_EQ(decoder.decode(frame({key(BTN_TOOL_PEN, 1), axis(ABS_X, -40)}))->x_counts, -40);
}

TEST(PenDecoder, HostileRangesNeverGiveNotANumber) {
  DeviceDescription device = intuos4();
  for (AxisRange& a : device.axes) {
    a.minimum = std::numeric_limits<std::int32_t>::min();
    a.maximum = std::numeric_limits<std::int32_t>::max();
    a.resolution = a.code % 2 ? -1 : 1;
  }
  PenDecoder decoder(device);
  const auto sample =
      decoder.decode(frame({key(BTN_TOOL_PEN, 1), axis(ABS_TILT_X, -5), axis(ABS_PRESSURE, 0)}));
  EXPECT_TRUE(std::isfinite(sample->tilt_x->value) && std::isfinite(sample->tilt_y->value));
  EXPECT_LE(std::abs(in_degrees(*sample->tilt_x)), 90.0001);
  EXPECT_NEAR(sample->pressure.value, 0.5, 1e-9);
}

TEST(PenDecoder, BytesThatAreNoEventsAreAGap) {
  PenDecoder decoder(intuos4());
  decoder.decode(frame({key(BTN_TOOL_PEN, 1)}));
  Transfer cut = frame({axis(ABS_X, 5)});
  cut.payload.pop_back();
  EXPECT_FALSE(decoder.decode(cut));
  EXPECT_EQ(decoder.counts().malformed, 1u);
  EXPECT_TRUE(decoder.decode(frame({}))->after_gap);
}

}  // namespace
}  // namespace fude
