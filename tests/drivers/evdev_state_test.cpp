#include "drivers/transport/evdev_state.h"

#include <gtest/gtest.h>
#include <linux/input-event-codes.h>

#include "drivers/touch/touch_decoder.h"

namespace fude {
namespace {

DeviceDescription surface() {
  DeviceDescription device;
  device.transport = "evdev";
  device.keys = {BTN_TOUCH};
  device.axes = {{ABS_X, 0, 1000, 0, 0, 10, 0},
                 {ABS_MT_SLOT, 0, 4, 0, 0, 0, 0},
                 {ABS_MT_POSITION_X, 0, 1000, 0, 0, 10, 0},
                 {ABS_MT_POSITION_Y, 0, 1000, 0, 0, 10, 0},
                 {ABS_MT_TRACKING_ID, 0, 65535, 0, 0, 0, 0}};
  return device;
}

using Frame = std::vector<EvdevEvent>;

// Three contacts come, one of them leaves, another moves.
const std::vector<Frame> fingers{
    {{EV_ABS, ABS_MT_TRACKING_ID, 7},
     {EV_ABS, ABS_MT_POSITION_X, 100},
     {EV_ABS, ABS_MT_POSITION_Y, 200},
     {EV_ABS, ABS_MT_SLOT, 1},
     {EV_ABS, ABS_MT_TRACKING_ID, 8},
     {EV_ABS, ABS_MT_POSITION_X, 300},
     {EV_KEY, BTN_TOUCH, 1},
     {EV_ABS, ABS_X, 100},
     {EV_SYN, SYN_REPORT, 0}},
    {{EV_ABS, ABS_MT_SLOT, 3},
     {EV_ABS, ABS_MT_TRACKING_ID, 9},
     {EV_ABS, ABS_MT_POSITION_Y, 400},
     {EV_ABS, ABS_MT_SLOT, 1},
     {EV_ABS, ABS_MT_TRACKING_ID, -1},
     {EV_SYN, SYN_REPORT, 0}},
    {{EV_ABS, ABS_MT_SLOT, 3}, {EV_ABS, ABS_MT_POSITION_X, 450}, {EV_SYN, SYN_REPORT, 0}},
    {{EV_ABS, ABS_MT_POSITION_X, 451}, {EV_SYN, SYN_REPORT, 0}}};

std::vector<TouchSample> decoded(TouchDecoder& decoder, const Frame& frame) {
  Transfer transfer;
  transfer.payload = pack_events(frame);
  Decoded out;
  decoder.decode(transfer, out);
  std::vector<TouchSample> samples;
  for (const Sample& sample : out.samples) {
    samples.push_back(std::get<TouchSample>(sample));
    samples.back().time.sequence = 0;
  }
  return samples;
}

TEST(EvdevState, WhoIsToldItReadsOnAsIfThereFromTheBeginning) {
  EvdevState state(surface());
  TouchDecoder whole(surface());
  for (std::size_t i = 0; i + 1 < fingers.size(); ++i) {
    state.apply(fingers[i]);
    decoded(whole, fingers[i]);
  }
  TouchDecoder late(surface());
  EXPECT_EQ(decoded(late, state.frame()).size(), 2u);
  EXPECT_EQ(decoded(late, fingers.back()), decoded(whole, fingers.back()));
}

TEST(EvdevState, ADeviceThatStandsAsDescribedIsToldNothing) {
  EvdevState state(surface());
  EXPECT_TRUE(state.frame().empty());
  state.apply(Frame{{EV_KEY, BTN_TOUCH, 1}, {EV_ABS, ABS_X, 5}});
  EXPECT_EQ(state.frame(), (Frame{{EV_KEY, BTN_TOUCH, 1}, {EV_ABS, ABS_X, 5}, {EV_SYN, SYN_REPORT, 0}}));
  state.apply(Frame{{EV_KEY, BTN_TOUCH, 0}, {EV_ABS, ABS_X, 0}});
  EXPECT_TRUE(state.frame().empty());
  state.apply(Frame{{EV_KEY, BTN_TOUCH, 1}});
  state.reset();
  EXPECT_TRUE(state.frame().empty());
}

}  // namespace
}  // namespace fude
