#include "drivers/tablet/identify.h"

#include <gtest/gtest.h>
#include <linux/input-event-codes.h>

namespace fude {
namespace {

DeviceDescription tablet(std::uint16_t vendor, std::uint16_t product, int resolution) {
  DeviceDescription device;
  device.vendor = vendor;
  device.product = product;
  device.keys = {BTN_TOOL_PEN, BTN_TOUCH};
  device.axes = {{.code = ABS_X, .maximum = 44704, .resolution = resolution},
                 {.code = ABS_Y, .maximum = 27940, .resolution = resolution}};
  return device;
}

TEST(Identify, SizeComesFromTheResolution) {
  const DeviceDescription device = identified(tablet(0x5543, 4, 100));
  EXPECT_EQ(device.kind, DeviceKind::pen_tablet);
  EXPECT_DOUBLE_EQ(device.width->value, 447.04);
  EXPECT_DOUBLE_EQ(device.height->value, 279.40);
}

TEST(Identify, AWacomWithoutResolutionHasItsFamilysDensity) {
  EXPECT_DOUBLE_EQ(identified(tablet(0x056a, 0xb9, 0)).width->value, 223.52);  // Intuos4 6x9
  EXPECT_DOUBLE_EQ(identified(tablet(0x056a, 0x13, 0)).width->value, 558.8);   // Graphire3: 80 a mm
}

TEST(Identify, OthersAreLookedUpInLibwacom) {
  DeviceDescription gaomon = tablet(0x256c, 0x006d, 0);
  EXPECT_DOUBLE_EQ(identified(gaomon).width.value().value, 9 * 25.4);  // the row without a name
  gaomon.name = "GAOMON Gaomon Tablet Pen";
  EXPECT_DOUBLE_EQ(identified(gaomon).width.value().value, 6 * 25.4);
  EXPECT_DOUBLE_EQ(identified(gaomon).height.value().value, 4 * 25.4);
}

TEST(Identify, AnUnknownTabletHasNoSize) {
  const DeviceDescription device = identified(tablet(0xfffe, 0xfffe, 0));
  EXPECT_EQ(device.kind, DeviceKind::pen_tablet);
  EXPECT_FALSE(device.width || device.height);
}

TEST(Identify, FingersAndMiceAreNoPens) {
  DeviceDescription pad = tablet(0x06cb, 1, 20);
  pad.keys = {BTN_LEFT, BTN_TOOL_FINGER, BTN_TOUCH};
  pad.axes.push_back({.code = ABS_PRESSURE, .maximum = 255});
  EXPECT_FALSE(is_pen_tablet(pad));
  DeviceDescription mouse;
  mouse.keys = {BTN_LEFT};
  EXPECT_FALSE(is_pen_tablet(mouse));
  EXPECT_EQ(identified(mouse).kind, DeviceKind::other);
}

TEST(Identify, APenWithoutToolKeysIsKnownByPressureAndTouch) {
  DeviceDescription device = tablet(0x5543, 4, 235);
  device.keys = {BTN_TOUCH, BTN_STYLUS};
  EXPECT_FALSE(is_pen_tablet(device));
  device.axes.push_back({.code = ABS_PRESSURE, .maximum = 1023});
  EXPECT_TRUE(is_pen_tablet(device));
}

TEST(Identify, CapabilitiesNameWhatItSenses) {
  DeviceDescription device = tablet(0x056a, 0xb9, 0);
  EXPECT_EQ(capabilities(device), (std::vector<std::string>{"x", "y"}));
  device.keys.push_back(BTN_TOOL_RUBBER);
  for (int code : {ABS_Z, ABS_WHEEL, ABS_PRESSURE, ABS_DISTANCE, ABS_TILT_X, ABS_TILT_Y})
    device.axes.push_back({.code = static_cast<std::uint16_t>(code), .maximum = 10});
  EXPECT_EQ(capabilities(device), (std::vector<std::string>{"x", "y", "pressure", "tilt", "rotation",
                                                            "distance", "wheel", "eraser"}));
}

}  // namespace
}  // namespace fude
