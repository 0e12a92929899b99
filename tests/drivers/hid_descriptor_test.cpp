#include "drivers/transport/hid_descriptor.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>

#include "tests/fakes/recordings.h"

namespace fude::hid {
namespace {

// A pen: number 7, in range, tip, six bits of padding, x and y in sixteen bits of 1/1000 inch, tilt in a
// signed byte.
const std::vector<std::byte> pen =
    octets({0x05, 0x0d, 0x09, 0x02, 0xa1, 0x01, 0x85, 0x07, 0x09, 0x20, 0xa1, 0x00, 0x09, 0x32, 0x09, 0x42,
            0x15, 0x00, 0x25, 0x01, 0x75, 0x01, 0x95, 0x02, 0x81, 0x02, 0x95, 0x06, 0x81, 0x03, 0xa4, 0x05,
            0x01, 0x09, 0x30, 0x75, 0x10, 0x95, 0x01, 0x55, 0x0d, 0x65, 0x13, 0x35, 0x00, 0x46, 0x40, 0x1f,
            0x27, 0x00, 0x7d, 0x00, 0x00, 0x81, 0x02, 0x09, 0x31, 0x46, 0x88, 0x13, 0x26, 0x20, 0x4e, 0x81,
            0x02, 0xb4, 0x09, 0x3d, 0x15, 0x81, 0x25, 0x7f, 0x75, 0x08, 0x95, 0x01, 0x81, 0x02, 0xc0, 0xc0});

TEST(HidDescriptor, FieldsStandWhereTheItemsPutThem) {
  const auto parsed = parse_descriptor(pen);
  ASSERT_TRUE(parsed) << parsed.error().message;
  EXPECT_TRUE(parsed->numbered);
  ASSERT_EQ(parsed->inputs.size(), 5U);
  const Field &tip = parsed->inputs[1], &x = parsed->inputs[2], &y = parsed->inputs[3],
              &tilt = parsed->inputs[4];
  EXPECT_EQ(tip.usage, usage(0x0d, 0x42));
  EXPECT_EQ(tip.application, usage(0x0d, 0x02));
  EXPECT_EQ(tip.report, 7);
  EXPECT_EQ(tip.first_bit, 1U);
  EXPECT_EQ(x.usage, usage(0x01, 0x30));
  EXPECT_EQ(x.first_bit, 8U);
  EXPECT_EQ(x.logical_maximum, 32000);
  EXPECT_NEAR(span_mm(x).value(), 8 * 25.4, 1e-9);
  EXPECT_NEAR(span_mm(y).value(), 5 * 25.4, 1e-9);
  EXPECT_EQ(tilt.usage, usage(0x0d, 0x3d));  // the page came back with the pop
  EXPECT_FALSE(span_mm(tilt).has_value());

  const auto report = octets({7, 0x02, 0x34, 0x12, 0xff, 0x00, 0xc4});
  EXPECT_EQ(value(tip, report), 1);
  EXPECT_EQ(value(x, report), 0x1234);
  EXPECT_EQ(value(tilt, report), -60);
  EXPECT_EQ(bytes_through(tip), 2U);
  EXPECT_EQ(bytes_through(tilt), report.size());
  EXPECT_FALSE(value(x, octets({8, 0, 0, 0, 0, 0, 0})).has_value());
  EXPECT_FALSE(value(y, octets({7, 0, 0, 0})).has_value());
}

TEST(HidDescriptor, ValuesOfAnyWidthCrossBytes) {
  Field field{.first_bit = 5, .bits = 12};
  EXPECT_EQ(value(field, octets({0xe0, 0xff, 0x01})), 0xfff);
  field.logical_minimum = -1;
  EXPECT_EQ(value(field, octets({0xe0, 0xff, 0x01})), -1);
  EXPECT_EQ(bytes_through(field), 3U);
  field = {.first_bit = 7, .bits = 32};
  EXPECT_EQ(bytes_through(field), 5U);
  EXPECT_EQ(value(field, octets({0x80, 0, 0, 0, 0x40})), static_cast<std::int32_t>(0x80000001));
}

TEST(HidDescriptor, BrokenOnesAreRefusedInOneLine) {
  for (std::size_t length = 0; length < pen.size(); ++length) {
    const auto parsed = parse_descriptor(Bytes(pen).first(length));  // whole items or an error, never more
    if (!parsed) {
      EXPECT_EQ(parsed.error().fault, Fault::malformed);
    }
  }
  EXPECT_FALSE(parse_descriptor(octets({0xb4})));  // a pop
  EXPECT_FALSE(
      parse_descriptor(octets({0x77, 0xff, 0xff, 0xff, 0x7f, 0x97, 0xff, 0xff, 0xff, 0x7f, 0x81, 2})));
  EXPECT_FALSE(parse_descriptor(octets({0x75, 1, 0x96, 0xff, 0xff, 0x81, 2})));  // 65535 fields
  std::vector<std::byte> deep;
  for (int i = 0; i < 100; ++i) append(deep, octets({0xa1, 0x00}));
  EXPECT_FALSE(parse_descriptor(deep));
}

TEST(HidDescriptor, ThoseOfRealTabletsAreRead) {
  REQUIRE_RECORDING("hid_descriptors");
  int read = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(recordings() / "hid_descriptors")) {
    if (!entry.is_regular_file()) continue;
    std::ifstream file(entry.path(), std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    const auto parsed = parse_descriptor(std::as_bytes(std::span(text.data(), text.size())));
    ASSERT_TRUE(parsed) << entry.path() << parsed.error().message;
    ++read;
    for (const Field& field : parsed->inputs) EXPECT_LE(field.bits, 32U);
  }
  EXPECT_EQ(read, 14);
}

}  // namespace
}  // namespace fude::hid
