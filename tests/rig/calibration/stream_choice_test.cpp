// Which stream a name means, and what is said where it means none or several.
#include "rig/calibration/stream_choice.h"

#include <gtest/gtest.h>

namespace fude {
namespace {

PoseSample pose(const std::string& tool) { return {.tool = tool}; }

// Two trackers of one name, the first with two tools; and an inertial unit beside a pen.
StreamChoice choice(StreamWish wish) {
  StreamChoice choice(std::move(wish));
  choice.begin(1, {.id = "0f44:ff20:A", .name = "Liberty", .kind = DeviceKind::tracker});
  choice.begin(2, {.id = "0f44:ff20:B", .name = "Liberty", .kind = DeviceKind::tracker});
  choice.begin(3, {.id = "057e:2006:", .name = "Joy-Con", .kind = DeviceKind::imu});
  return choice;
}

TEST(StreamChoice, EveryWayOfNamingOneMeansIt) {
  for (const char* name : {"probe", "Liberty/probe", "Liberty #1/probe", "Liberty pose/probe"}) {
    StreamChoice named = choice({.name = name});
    EXPECT_FALSE(*named.takes(2, pose("1"))) << name;
    EXPECT_TRUE(*named.takes(1, pose("probe"))) << name;
    EXPECT_TRUE(*named.takes(1, pose("probe"))) << name;
    EXPECT_FALSE(*named.takes(1, pose("brush"))) << name;
    ASSERT_TRUE(named.found()) << name;
    EXPECT_EQ(named.found()->part, "probe");
    EXPECT_EQ(named.found()->device.id, "0f44:ff20:A");
  }
  for (const char* name : {"imu", "Joy-Con", "Joy-Con imu"}) {
    StreamChoice named = choice({.name = name, .kinds = is_kind<ImuSample>});
    EXPECT_FALSE(*named.takes(3, PenSample{})) << name;
    EXPECT_TRUE(*named.takes(3, ImuSample{})) << name;
  }
}

TEST(StreamChoice, WithoutANameItIsTheOnlyOne) {
  StreamChoice only = choice({.kinds = is_kind<PoseSample>, .but = "easel"});
  EXPECT_FALSE(*only.takes(1, pose("easel")));
  EXPECT_TRUE(*only.takes(1, pose("brush")));
  EXPECT_FALSE(*only.takes(3, ImuSample{}));
  const auto second = only.takes(1, pose("probe"));
  ASSERT_FALSE(second);
  EXPECT_NE(second.error().message.find("--tool (brush, probe)"), std::string::npos)
      << second.error().message;
}

TEST(StreamChoice, DevicesOfOneNameAreToldApartByNumber) {
  StreamChoice twice = choice({.name = "Liberty"});
  EXPECT_TRUE(*twice.takes(1, pose("")));
  const auto second = twice.takes(2, pose(""));
  ASSERT_FALSE(second);
  EXPECT_NE(second.error().message.find("(Liberty #1, Liberty #2)"), std::string::npos)
      << second.error().message;
}

TEST(StreamChoice, WhatIsNotThereIsNamed) {
  StreamChoice missing = choice({.name = "fude", .kinds = is_kind<PoseSample>});
  EXPECT_EQ(missing.found().error().message, "there is no tool 'fude'; none was heard");
  EXPECT_FALSE(*missing.takes(1, pose("brush")));
  EXPECT_EQ(missing.found().error().message, "there is no tool 'fude'; there is: brush");
}

}  // namespace
}  // namespace fude
