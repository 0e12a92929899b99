// Poses seen from a reference as they come: the same whenever the reference's own come, and bounded.
#include "rig/calibration/tool_poses.h"

#include <gtest/gtest.h>

#include "tests/fakes/scripted_tracker.h"

namespace fude {
namespace {

// The easel is carried along x at 0.1 m/s and turns about z at 0.3 rad/s; the brush stands still on it.
const Eigen::Vector3d brush_m(0.2, 0.1, 0.05);

PoseSample easel(double t_s) {
  PoseSample sample = pose_sample({Eigen::Quaterniond(Eigen::AngleAxisd(0.3 * t_s, Eigen::Vector3d::UnitZ())),
                                   Eigen::Vector3d(0.1 * t_s, 0, 0)},
                                  t_s);
  sample.tool = "easel";
  return sample;
}

PoseSample brush(double t_s) {
  const Pose<Tracker, Tool> carried = easel(t_s).tracker_from_tool;
  return pose_sample({carried.rotation, carried * brush_m}, t_s);
}

ToolPoses poses() {
  ToolPoses poses({.tool = "brush", .reference = "easel"});
  poses.begin(1, {.id = "0f44:ff20:A", .name = "Liberty"});
  return poses;
}

void expect_on_the_easel(const std::vector<PoseSample>& seen) {
  for (const PoseSample& s : seen) {
    EXPECT_TRUE(s.valid);
    EXPECT_LT((s.tracker_from_tool.translation - brush_m).norm(), 1e-5);
    EXPECT_LT(s.tracker_from_tool.rotation.angularDistance(Eigen::Quaterniond::Identity()), 1e-6);
  }
}

TEST(ToolPoses, AReferenceThatComesLateIsWaitedFor) {
  ToolPoses seen = poses();
  std::size_t count = 0;
  // The easel is told of 0.3 s after the brush.
  for (int i = 0; i < 300; ++i) {
    for (const auto& ready :
         {*seen.hear(1, brush(0.01 * i + 0.005)), *seen.hear(1, easel(0.01 * (i - 30)))}) {
      expect_on_the_easel(ready);
      count += ready.size();
    }
  }
  EXPECT_EQ(count, 269U);
  const auto rest = *seen.rest();
  EXPECT_EQ(rest.size(), 31U);
  for (const PoseSample& s : rest) EXPECT_FALSE(s.valid);
}

TEST(ToolPoses, AReferenceThatIsGoneIsNotWaitedForWithoutEnd) {
  ToolPoses seen = poses();
  ASSERT_TRUE(seen.hear(1, easel(0)));
  std::size_t count = 0;
  for (int i = 1; i <= 10000; ++i) {
    const auto ready = seen.hear(1, brush(0.001 * i));
    ASSERT_TRUE(ready);
    for (const PoseSample& s : *ready) EXPECT_FALSE(s.valid);
    count += ready->size();
  }
  EXPECT_EQ(count, 10000U - 4096U);
}

TEST(ToolPoses, AReferenceOfAnotherTrackerIsRefusedByName) {
  ToolPoses seen = poses();
  seen.begin(2, {.id = "1234:5678:B", .name = "Fastrak"});
  ASSERT_TRUE(seen.hear(1, brush(0)));
  const auto other = seen.hear(2, easel(0.1));
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().message,
            "--reference easel is seen by Fastrak, brush by Liberty: the same tracker must see both");
}

TEST(ToolPoses, TheReportSaysWhatTheyCameFrom) {
  ToolPoses seen = poses();
  ASSERT_TRUE(seen.hear(1, brush(0)));
  EXPECT_EQ(seen.rest().error().message, "there is no reference 'easel'; there is: brush");
  ASSERT_TRUE(seen.hear(1, easel(0)));
  CalibrationReport tool, frame;
  seen.sign_tool(tool);
  EXPECT_EQ(tool.devices, std::vector<std::string>{"0f44:ff20:A"});
  EXPECT_EQ(tool.tool, "brush");
  EXPECT_EQ(tool.reference, "");
  seen.sign_frame(frame);
  EXPECT_EQ(frame.devices, std::vector<std::string>{"0f44:ff20:A"});
  EXPECT_EQ(frame.tool, "");
  EXPECT_EQ(frame.reference, "easel");
}

}  // namespace
}  // namespace fude
