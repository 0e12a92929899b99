#include "capture/import/mypaint_events.h"

#include <gtest/gtest.h>

#include <string>

namespace fude {
namespace {

TEST(MypaintEvents, RowsBecomeSamples) {
  const auto recording = import_mypaint_events(
      "# seconds x y pressure\n\n"
      "0.000000000000000000e+00 2.052445140000000094e+02 10 0\n"
      "8.000000000000000167e-03\t-5.5\t20\t0.25\n",
      default_mm_per_pixel);
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(recording->counts.ignored_lines, 2u);
  EXPECT_EQ(recording->device->mm_per_count, 0.1);
  EXPECT_EQ(recording->device->kind, DeviceKind::pen_tablet);
  ASSERT_EQ(recording->samples.size(), 2u);
  const PenSample& first = std::get<PenSample>(recording->samples[0]);
  EXPECT_EQ(first.x_counts, 205.244514);
  EXPECT_TRUE(first.in_proximity);
  EXPECT_FALSE(first.in_contact);
  const PenSample& second = std::get<PenSample>(recording->samples[1]);
  EXPECT_EQ(second.time.host, Timestamp(std::chrono::milliseconds(8)));
  EXPECT_EQ(second.time.stamped_by, StampedBy::recording);
  EXPECT_EQ(second.time.sequence, 1u);
  EXPECT_EQ(second.tool, PenTool::pen);
  EXPECT_EQ(second.x_counts, -5.5);
  EXPECT_EQ(second.pressure, Fraction(0.25));
  EXPECT_TRUE(second.in_contact);
  EXPECT_FALSE(second.tilt_x || second.rotation);
}

void expect_refusal(const std::string& text, const std::string& message) {
  const auto recording = import_mypaint_events(text, default_mm_per_pixel);
  ASSERT_FALSE(recording) << text;
  EXPECT_NE(recording.error().message.find(message), std::string::npos) << recording.error().message;
}

TEST(MypaintEvents, BadRowsAreNamed) {
  expect_refusal("0 1 2 0\n0.1 1 2\n", "line 2: not the four numbers");
  expect_refusal("0 1 2 0 5\n", "line 1: not the four numbers");
  expect_refusal("0 1 2 x\n", "line 1: not the four numbers");
  expect_refusal("0 nan 2 0\n", "line 1: the position");
  expect_refusal("0 1 inf 0\n", "line 1: the position");
  expect_refusal("0 1 2e6 0\n", "line 1: the position");
  expect_refusal("0 1 2 nan\n", "line 1: the pressure");
  expect_refusal("0 1 2 1.5\n", "line 1: the pressure");
  expect_refusal("0 1 2 -0.1\n", "line 1: the pressure");
  expect_refusal("nan 1 2 0\n", "line 1: the time");
  expect_refusal("-1 1 2 0\n", "line 1: the time");
  expect_refusal("1e300 1 2 0\n", "line 1: the time");
  expect_refusal("1 1 2 0\n0.5 1 2 0\n", "line 2: time runs backwards");
  expect_refusal("1 1 2 0\n1 1 3 0\n1 1 4 0\n", "same time");
}

TEST(MypaintEvents, PixelsHaveASensibleSize) {
  for (double size : {0.0, -1.0, 1e9}) {
    const auto recording = import_mypaint_events("0 1 2 0\n", Millimetres(size));
    ASSERT_FALSE(recording);
    EXPECT_EQ(recording.error().fault, Fault::usage);
  }
}

}  // namespace
}  // namespace fude
