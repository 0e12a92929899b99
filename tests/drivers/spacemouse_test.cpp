#include <gtest/gtest.h>

#include "drivers/spacemouse/spacemouse_decoder.h"
#include "tests/fakes/transfers.h"

namespace fude {
namespace {

constexpr std::uint16_t space_navigator = 0xc626;
constexpr std::uint16_t pro_wireless = 0xc632;

PuckSample puck(SpaceMouseDecoder& decoder, std::string_view hex, int milliseconds = 0) {
  return std::get<PuckSample>(
      decoded(decoder, from_device(TransferKind::hid_report, from_hex(hex), milliseconds)).samples.at(0));
}

TEST(SpaceMouse, PushAndTurnInTwoReports) {
  SpaceMouseDecoder decoder(0x046d, space_navigator);
  const PuckSample pushed = puck(decoder, "01 5e01 afff 2300", 8);  // 350, -81, 35
  EXPECT_EQ(pushed.time.host, Timestamp(std::chrono::milliseconds(8)));
  EXPECT_TRUE(pushed.push.isApprox(Eigen::Vector3d(1, 81.0 / 350, -0.1)));
  EXPECT_EQ(pushed.turn, Eigen::Vector3d::Zero());
  const PuckSample turned = puck(decoder, "02 0000 e2ff a2fe");  // 0, -30, -350
  EXPECT_EQ(turned.push, pushed.push);
  EXPECT_TRUE(turned.turn.isApprox(Eigen::Vector3d(0, 30.0 / 350, 1)));
  EXPECT_EQ(turned.time.sequence, 1u);
}

TEST(SpaceMouse, BothInOneReport) {
  SpaceMouseDecoder decoder(0x256f, pro_wireless);
  const PuckSample s = puck(decoder, "01 2300 0000 0000 0000 0000 ddff");
  EXPECT_TRUE(s.push.isApprox(Eigen::Vector3d(0.1, 0, 0)));
  EXPECT_TRUE(s.turn.isApprox(Eigen::Vector3d(0, 0, 0.1)));
}

TEST(SpaceMouse, ButtonsAreThoseOfTheModel) {
  SpaceMouseDecoder two(0x046d, space_navigator);
  EXPECT_EQ(puck(two, "03 03 00").buttons, 3u);
  EXPECT_EQ(puck(two, "03 ff ff").buttons, 3u);
  SpaceMouseDecoder many(0x256f, pro_wireless);
  EXPECT_EQ(puck(many, "03 01 10 80 04 00 00").buttons, 0x04801001u);
}

TEST(SpaceMouse, BeyondTheRangeIsItsEnd) {
  SpaceMouseDecoder decoder(0x046d, space_navigator);
  EXPECT_EQ(puck(decoder, "01 ff7f 0080 0080").push, Eigen::Vector3d(1, 1, 1));
}

TEST(SpaceMouse, OtherLengthsAndNumbersAreCounted) {
  SpaceMouseDecoder decoder(0x046d, space_navigator);
  for (const char* hex :
       {"", "01", "01 0000 0000 00", "02 0000 0000 0000 00", "03", "03 00 00 00 00 00 00 00 00"})
    EXPECT_TRUE(decoded(decoder, from_device(TransferKind::hid_report, from_hex(hex))).samples.empty())
        << hex;
  decoded(decoder, from_device(TransferKind::hid_report, from_hex("17 64")));
  decoded(decoder, from_device(TransferKind::hid_report, from_hex("1c 00 00")));
  EXPECT_EQ(decoder.counts(), (ReportCounts{.reports = 1, .malformed = 6, .unknown = 1}));
}

TEST(SpaceMouse, UnplugLetsGo) {
  SpaceMouseDecoder decoder(0x046d, space_navigator);
  puck(decoder, "01 5e01 0000 0000");
  decoded(decoder, from_device(TransferKind::unplugged));
  const PuckSample s = puck(decoder, "03 00 00");
  EXPECT_TRUE(s.after_gap);
  EXPECT_EQ(s.push, Eigen::Vector3d::Zero());
}

}  // namespace
}  // namespace fude
