// Which earlier calibration counts for which device and tool.
#include "rig/calibration/known_calibrations.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

namespace fude {
namespace {

namespace fs = std::filesystem;

class KnownPivots : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path pivot(const std::string& device, const std::string& tool, double tip_m) {
    StoredCalibration made;
    made.report = {.procedure = "pivot", .accepted = true, .devices = {device}, .tool = tool};
    made.result = {{"tool", tool}, {"tip_m", std::vector{tip_m, 0.0, 0.0}}};
    const fs::path file = folder_ / (std::to_string(++count_) + ".toml");
    std::ofstream(file) << toml_of(made);
    return file;
  }

  static ChosenStream tool(const std::string& device, const std::string& part) {
    return {1, {.id = device}, part};
  }

  fs::path folder_ = fs::path(testing::TempDir()) / ("fude-known-" + std::to_string(getpid()));
  int count_ = 0;
};

TEST_F(KnownPivots, TheOneOfDeviceAndToolIsFound) {
  const auto known = KnownCalibrations::read(
      {pivot("0f44:ff20:A", "probe", 1), pivot("0f44:ff20:B", "brush", 2), pivot("0f44:ff20:A", "brush", 3)});
  ASSERT_TRUE(known);
  EXPECT_EQ(tip_of("surface", {}, *known, tool("0f44:ff20:A", "brush"))->x(), 3);
  EXPECT_EQ(tip_of("surface", Eigen::Vector3d(4, 0, 0), *known, tool("0f44:ff20:A", "brush"))->x(), 4);
  EXPECT_EQ(tip_of("surface", {}, *known, tool("text:poses", "brush"))->x(), 2);  // a table is any device's
}

TEST_F(KnownPivots, OneOfAnotherDeviceOrToolIsRefusedByName) {
  const auto known = KnownCalibrations::read({pivot("0f44:ff20:A", "probe", 1)});
  ASSERT_TRUE(known);
  const auto device = tip_of("surface", {}, *known, tool("0f44:ff20:B", "probe"));
  ASSERT_FALSE(device);
  EXPECT_NE(device.error().message.find("0f44:ff20:A"), std::string::npos) << device.error().message;
  const auto other = tip_of("surface", {}, *known, tool("0f44:ff20:A", "brush"));
  ASSERT_FALSE(other);
  EXPECT_NE(other.error().message.find("with the tool probe"), std::string::npos) << other.error().message;
}

TEST_F(KnownPivots, WhereThereIsNoneItIsAskedFor) {
  const auto tip = tip_of("surface", {}, {}, tool("0f44:ff20:A", "brush"));
  ASSERT_FALSE(tip);
  EXPECT_EQ(tip.error().fault, Fault::usage);
  EXPECT_FALSE(KnownCalibrations::read({folder_ / "absent.toml"}));
}

}  // namespace
}  // namespace fude
