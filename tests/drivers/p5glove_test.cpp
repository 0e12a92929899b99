#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "drivers/p5glove/p5glove_decoder.h"
#include "tests/fakes/transfers.h"

namespace fude {
namespace {

// Writes fields bit after bit, the highest first.
class BitWriter {
 public:
  void put(int value, int width) {
    for (int i = width - 1; i >= 0; --i, ++at_)
      if (value >> i & 1) bytes_[at_ / 8] |= static_cast<std::byte>(0x80 >> (at_ % 8));
  }
  const std::vector<std::byte>& bytes() const { return bytes_; }

 private:
  std::vector<std::byte> bytes_ = std::vector<std::byte>(p5glove::report_length);
  std::size_t at_ = 0;
};

std::vector<std::byte> report(int light, int vertical0, int vertical1, int horizontal) {
  BitWriter w;
  w.put(1, 8);
  for (int bend : {10, 20, 30, 40, 63}) w.put(bend, 6);
  w.put(0, 2);
  w.put(5, 4);
  for (int seen : {light, 15, 15, 15}) w.put(seen, 4);
  w.put(vertical1, 10);
  w.put(vertical0, 10);
  w.put(horizontal, 10);
  return w.bytes();
}

constexpr const char* heads = "06 00 00 00 00 4f";  // no correction, 7.9 inches
std::vector<std::byte> lights(unsigned kind) {
  auto bytes = octets({12, kind});
  bytes.resize(62);
  return bytes;
}

void calibrate(P5GloveDecoder& decoder) {
  decoded(decoder, from_device(TransferKind::hid_feature, from_hex(heads)));
  decoded(decoder, from_device(TransferKind::hid_feature, lights(0)));
}

GloveSample glove(P5GloveDecoder& decoder, std::vector<std::byte> bytes) {
  return std::get<GloveSample>(
      decoded(decoder, from_device(TransferKind::hid_report, std::move(bytes))).samples.at(0));
}

TEST(P5Glove, GoldenBytes) {
  // Bends 10 20 30 40 63, A and C, light 3 at 2, -1, 256; the rest unseen.
  const auto whole =
      p5glove::read_report(from_hex("01 2947a8fc 53fffffc 0240 00000000 00000000 00000000 00"));
  ASSERT_TRUE(whole);
  EXPECT_EQ(whole->bend, (std::array<std::uint8_t, 5>{10, 20, 30, 40, 63}));
  EXPECT_EQ(whole->buttons, 5);
  ASSERT_TRUE(whole->sightings[0]);
  EXPECT_EQ(whole->sightings[0]->light, 3);
  EXPECT_EQ(whole->sightings[0]->vertical, (std::array<std::int32_t, 2>{2, -1}));
  EXPECT_EQ(whole->sightings[0]->horizontal, 256);
  EXPECT_FALSE(whole->sightings[1]);
}

TEST(P5Glove, BendsAndButtonsThumbFirst) {
  P5GloveDecoder decoder;
  const GloveSample s = glove(decoder, report(2, 0, 0, 0));
  EXPECT_EQ(s.bend[0], Fraction(1));
  EXPECT_EQ(s.bend[1], Fraction(10.0 / 63));
  EXPECT_EQ(s.bend[4], Fraction(40.0 / 63));
  EXPECT_EQ(s.buttons, 5u);
  EXPECT_FALSE(s.lights[2]);  // how the tower stands is not known yet
}

TEST(P5Glove, TheGreetingEndsTheMouseAndAsks) {
  P5GloveDecoder decoder;
  const auto all = decoder.greeting();
  ASSERT_EQ(all.size(), 3u);
  EXPECT_EQ(all[0].kind, TransferKind::hid_feature);
  EXPECT_EQ(all[0].payload, from_hex("05 ff"));
  EXPECT_EQ(all[1].payload, from_hex("06"));
  EXPECT_EQ(all[2].payload, from_hex("0c"));
}

// A light at a known place, seen by heads of a known tower, is found there to the size of a count.
TEST(P5Glove, ALightIsWhereBothHeadsSeeIt) {
  constexpr double degree = std::numbers::pi / 180;
  constexpr double between = 79 * 0.00254;
  for (const Eigen::Vector3d& at : {Eigen::Vector3d(0.1, 0.05, 0.8), Eigen::Vector3d(-0.3, -0.1, 1.2)}) {
    const double far = std::hypot(at.x(), at.z());
    const auto counts = [&](double y, double tilt) {
      return static_cast<int>(std::lround(512 * std::tan(std::atan((at.y() - y) / far) - tilt)));
    };
    const int horizontal = static_cast<int>(std::lround(512 * std::tan(std::atan2(-at.x(), at.z()))));
    P5GloveDecoder decoder;
    calibrate(decoder);
    const GloveSample s = glove(
        decoder, report(5, counts(-between / 2, 17 * degree), counts(between / 2, -10 * degree), horizontal));
    ASSERT_TRUE(s.lights[5]);
    EXPECT_LT((*s.lights[5] - at).norm(), 0.015);
  }
}

TEST(P5Glove, ATangentBeyondTenBitsIsFollowed) {
  P5GloveDecoder decoder;
  calibrate(decoder);
  const double before = (*glove(decoder, report(1, -100, 100, 500)).lights[1]).x();
  const double after = (*glove(decoder, report(1, -100, 100, 530 - 1024)).lights[1]).x();
  EXPECT_LT(after, before);
  EXPECT_LT(std::abs(after - before), 0.1);
}

TEST(P5Glove, ViewsThatDoNotMeetAreNoPlace) {
  P5GloveDecoder decoder;
  calibrate(decoder);
  EXPECT_FALSE(glove(decoder, report(1, -511, 511, 0)).lights[1]);
}

TEST(P5Glove, AnUnknownKindOfGloveHasNoPlaces) {
  P5GloveDecoder decoder;
  decoded(decoder, from_device(TransferKind::hid_feature, from_hex(heads)));
  decoded(decoder, from_device(TransferKind::hid_feature, lights(7)));
  EXPECT_FALSE(decoder.tower());
  EXPECT_FALSE(p5glove::read_tower(from_hex("06 00 00 00 00 00"), lights(0)));
}

TEST(P5Glove, OtherLengthsAndNumbersAreCounted) {
  P5GloveDecoder decoder;
  auto bytes = report(0, 0, 0, 0);
  bytes.pop_back();
  decoded(decoder, from_device(TransferKind::hid_report, bytes));
  bytes = report(0, 0, 0, 0);
  bytes[0] = std::byte{2};
  decoded(decoder, from_device(TransferKind::hid_report, bytes));
  decoded(decoder, from_device(TransferKind::hid_feature));
  decoded(decoder, from_device(TransferKind::hid_feature, from_hex("09 04 03")));
  EXPECT_EQ(decoder.counts(), (ReportCounts{.malformed = 3, .unknown = 1}));
}

TEST(P5Glove, AbsenceAndSleepForgetTheTower) {
  for (const TransferKind away : {TransferKind::unplugged, TransferKind::suspended}) {
    P5GloveDecoder decoder;
    calibrate(decoder);
    decoded(decoder, from_device(away));
    EXPECT_FALSE(decoder.tower());
    EXPECT_TRUE(glove(decoder, report(0, 0, 0, 0)).after_gap);
  }
}

}  // namespace
}  // namespace fude
