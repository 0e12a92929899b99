#include "signal/transfer.h"

#include <gtest/gtest.h>

namespace fude {
namespace {

TEST(Transfer, EventsPackToGoldenBytes) {
  const std::vector<EvdevEvent> events{{3, 0, 0x01020304}, {0, 0, 0}, {4, 0, -1719661677}};
  const std::vector<std::byte> bytes = pack_events(events);
  const unsigned char golden[24] = {3, 0, 0, 0, 4, 3, 2, 1, 0, 0, 0, 0, 0, 0, 0, 0, 4, 0, 0, 0, 0x93, 0x0b, 0x80, 0x99};
  ASSERT_EQ(bytes.size(), sizeof golden);
  for (std::size_t i = 0; i < sizeof golden; ++i) EXPECT_EQ(std::to_integer<unsigned>(bytes[i]), golden[i]) << i;
  EXPECT_EQ(unpack_events(bytes).value(), events);
}

TEST(Transfer, CutFrameIsRefused) {
  const std::vector<std::byte> cut(11);
  ASSERT_FALSE(unpack_events(cut).has_value());
  EXPECT_EQ(unpack_events(cut).error().fault, Fault::malformed);
}

}  // namespace
}  // namespace fude
