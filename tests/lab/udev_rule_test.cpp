// The rule that gives whoever is logged in access, as udev applies it.
#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "drivers/transport/udev_device.h"
#include "tests/lab/attached_node.h"
#include "tests/lab/attached_pen.h"
#include "tests/lab/byte_literals.h"
#include "tests/lab/scripted_port.h"
#include "tests/lab/uhid_device.h"
#include "tests/lab/uinput_pen.h"

namespace fude::lab {
namespace {

bool user_may_open(const char* subsystem, const std::filesystem::path& node) {
  const Udev context(udev_new(), udev_unref);
  const std::string name = node.filename();
  const UdevDevice device(udev_device_new_from_subsystem_sysname(context.get(), subsystem, name.c_str()),
                          udev_device_unref);
  return device && udev_device_has_tag(device.get(), "uaccess") == 1;
}

bool hid_may_be_opened(std::uint16_t vendor, std::uint16_t product) {
  const Bytes descriptor = bytes({0x06, 0x00, 0xff, 0x09, 0x01, 0xa1, 0x01, 0x15, 0x00, 0x26, 0xff,
                                  0x00, 0x75, 0x08, 0x95, 0x08, 0x09, 0x02, 0x81, 0x02, 0xc0});
  char id[32];
  std::snprintf(id, sizeof id, "%04x:%04x:RULE", unsigned{vendor}, unsigned{product});
  std::unique_ptr<UhidDevice> device;
  const DeviceNode node = attached_node(NodeKind::hidraw, id, [&] {
    device = std::make_unique<UhidDevice>(HidIdentity{"rule", vendor, product, "RULE"}, descriptor);
  });
  return user_may_open("hidraw", node.path);
}

TEST(UdevRule, HidDevicesOfOursAndNoOthers) {
  EXPECT_TRUE(hid_may_be_opened(0x046d, 0xc62b));  // SpaceMouse Pro
  EXPECT_TRUE(hid_may_be_opened(0x256f, 0xc635));
  EXPECT_TRUE(hid_may_be_opened(0x057e, 0x2006));
  EXPECT_TRUE(hid_may_be_opened(0x057e, 0x2007));
  EXPECT_TRUE(hid_may_be_opened(0x1209, 0x0001));
  EXPECT_FALSE(hid_may_be_opened(0x046d, 0xc31c));  // a keyboard
  EXPECT_FALSE(hid_may_be_opened(0x1209, 0x0003));
}

TEST(UdevRule, PensAndSerialPorts) {
  std::unique_ptr<UinputPen> pen;
  const DeviceNode found = attached_pen([&] { pen = std::make_unique<UinputPen>("lab pen"); });
  EXPECT_TRUE(user_may_open("input", found.path));
  std::optional<ScriptedPort> port;
  const DeviceNode node = attached_node(NodeKind::serial, "1209:0002:SOUND2", [&] {
    port.emplace(UsbIdentity{0x1209, 0x0002, "SOUND2", "ultrasonic receiver"}, 0);
  });
  EXPECT_TRUE(user_may_open("tty", node.path));
}

}  // namespace
}  // namespace fude::lab
