// Input devices given back by UinputDevice, as the kernel shows them and EvdevSource reads them.
#include "drivers/transport/uinput_device.h"

#include <gtest/gtest.h>
#include <linux/input-event-codes.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "drivers/transport/evdev_source.h"
#include "tests/lab/attached_pen.h"
#include "tests/lab/patience.h"

namespace fude::lab {
namespace {

DeviceDescription pen() {
  DeviceDescription device;
  device.name = "Played pen";
  device.transport = "evdev";
  device.bus = 3;
  device.vendor = 0x056a;
  device.product = 0x0314;
  device.version = 0x0110;
  device.keys = {BTN_TOOL_PEN, BTN_TOOL_RUBBER, BTN_TOUCH, BTN_STYLUS};
  device.properties = {INPUT_PROP_POINTER};
  device.axes = {{ABS_X, 0, 31496, 4, 0, 200, 1234},
                 {ABS_Y, -100, 19685, 4, 2, 200, -5},
                 {ABS_PRESSURE, 0, 2047, 0, 0, 0, 0},
                 {ABS_TILT_X, -64, 63, 0, 0, 57, 7}};
  return device;
}

TEST(UinputDevices, StandAsDescribedAndSendWhatTheyAreGiven) {
  const EvdevEvent serial{EV_MSC, MSC_SERIAL, 0};
  std::unique_ptr<UinputDevice> device;
  const DeviceNode found = attached_pen([&] {
    auto made = UinputDevice::create(pen(), {&serial, 1});
    if (!made) throw std::runtime_error(made.error().message);
    device = std::move(*made);
  });
  EXPECT_EQ(device->node(), found.path);
  auto source = EvdevSource::open(found.path);
  ASSERT_TRUE(source) << source.error().message;
  DeviceDescription expected = pen();
  for (AxisRange& axis : expected.axes) axis.fuzz = 0;
  expected.id = (*source)->description().id;
  EXPECT_EQ((*source)->description(), expected);

  // Steps of one count, which a fuzz of four would swallow.
  std::vector<std::vector<EvdevEvent>> sent{{{EV_MSC, MSC_SERIAL, 99},
                                             {EV_KEY, BTN_TOOL_PEN, 1},
                                             {EV_KEY, BTN_TOUCH, 1},
                                             {EV_ABS, ABS_PRESSURE, 700},
                                             {EV_SYN, SYN_REPORT, 0}}};
  for (int i = 1; i <= 500; ++i)
    sent.push_back({{EV_ABS, ABS_X, 1234 + i}, {EV_ABS, ABS_Y, i % 2}, {EV_SYN, SYN_REPORT, 0}});
  for (const auto& frame : sent) {
    ASSERT_TRUE(device->send(frame));
    const auto read = (*source)->read(patience());
    ASSERT_TRUE(read && *read);
    EXPECT_EQ((*read)->payload, pack_events(frame));
  }
  device.reset();
  const auto gone = (*source)->read(patience());
  ASSERT_TRUE(gone && *gone);
  EXPECT_EQ((*gone)->kind, TransferKind::unplugged);
}

TEST(UinputDevices, ADescriptionThatNoDeviceHasIsRefused) {
  DeviceDescription device = pen();
  device.axes[0].maximum = device.axes[0].minimum - 1;
  const auto made = UinputDevice::create(device);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().fault, Fault::unsupported);
}

}  // namespace
}  // namespace fude::lab
