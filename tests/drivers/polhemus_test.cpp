#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

#include "drivers/polhemus/polhemus_decoder.h"
#include "tests/fakes/sound_sample.h"
#include "tests/fakes/transfers.h"

namespace fude {
namespace {

using polhemus::Dialect;

void put_real(std::vector<std::byte>& bytes, double value) {
  put_little_endian(bytes, std::bit_cast<std::uint32_t>(static_cast<float>(value)));
}

// 10, -20, 30 cm; a quarter turn about z.
void put_pose(std::vector<std::byte>& bytes) {
  for (double value : {10.0, -20.0, 30.0, std::sqrt(0.5), 0.0, 0.0, std::sqrt(0.5)}) put_real(bytes, value);
}

std::vector<std::byte> fastrak(char station, char error = ' ') {
  auto record = octets({'0', static_cast<unsigned char>(station), static_cast<unsigned char>(error)});
  put_pose(record);
  append(record, octets({'\r', '\n'}));
  return record;
}

std::vector<std::byte> liberty(unsigned station, std::uint32_t frame, unsigned error = ' ',
                               char second = 'Y') {
  auto record = octets({static_cast<unsigned>(second == 'A' ? 'P' : 'L'), static_cast<unsigned char>(second),
                        station, 'C', error, 0});
  put_little_endian(record, std::uint16_t{44});
  put_little_endian(record, std::uint32_t{4 * frame});  // 240 Hz, in whole milliseconds
  put_little_endian(record, frame);
  put_little_endian(record, std::uint32_t{1});
  put_little_endian(record, std::int32_t{3});
  put_pose(record);
  return record;
}

PolhemusDecoder patriot() { return PolhemusDecoder(0xef12, false); }

std::vector<PoseSample> poses(PolhemusDecoder& decoder, std::vector<std::byte> bytes,
                              TransferKind kind = TransferKind::serial) {
  std::vector<PoseSample> all;
  for (const Sample& s : decoded(decoder, from_device(kind, std::move(bytes), 5)).samples)
    all.push_back(std::get<PoseSample>(s));
  return all;
}

// 1.0f is 00 00 80 3f, 0.5f 00 00 00 3f, 2.54f 29 5c 22 40: written by hand, in inches.
TEST(PolhemusRecords, GoldenBytes) {
  const polhemus::Layout inches{Dialect::fastrak, {2, 11, 1}, false};
  const auto one = polhemus::read_record(
      from_hex("30 32 20 0000803f 00000040 000080bf 0000003f 0000003f 0000003f 000000bf 0d0a"), inches);
  ASSERT_TRUE(one);
  EXPECT_EQ(one->station, 2u);
  EXPECT_TRUE(one->position_m->isApprox(Eigen::Vector3d(0.0254, 0.0508, -0.0254)));
  EXPECT_TRUE(one->rotation->coeffs().isApprox(Eigen::Vector4d(0.5, 0.5, -0.5, 0.5)));

  const polhemus::Layout plain{Dialect::liberty, {2, 4, 1}, true};
  const auto two = polhemus::read_record(
      from_hex("4c59 01 43 20 00 1a00 0000803f 00000040 00004040 0000b442 00000000 00000000 0d0a"), plain);
  ASSERT_TRUE(two);
  EXPECT_TRUE(two->position_m->isApprox(Eigen::Vector3d(0.01, 0.02, 0.03)));
  EXPECT_TRUE((*two->rotation * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitY()));
}

TEST(Polhemus, AFastrakRecordIsAPoseOfItsStation) {
  PolhemusDecoder decoder(0x0002, false);
  const auto all = poses(decoder, fastrak('1'));
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].tool, "1");
  EXPECT_TRUE(all[0].tracker_from_tool.translation.isApprox(Eigen::Vector3d(0.1, -0.2, 0.3), 1e-6));
  EXPECT_TRUE((all[0].tracker_from_tool.rotation * Eigen::Vector3d::UnitX())
                  .isApprox(Eigen::Vector3d::UnitY(), 1e-6));
  EXPECT_TRUE(all[0].valid);
  EXPECT_FALSE(all[0].time.device_tick);
}

TEST(Polhemus, StationsOfOneCycleShareItsSequence) {
  PolhemusDecoder decoder(0x0002, false);
  std::vector<std::byte> stream;
  for (int cycle = 0; cycle < 3; ++cycle)
    for (char station : {'1', '2', '4'}) append(stream, fastrak(station));
  const auto all = poses(decoder, stream);
  ASSERT_EQ(all.size(), 9u);
  for (std::size_t i = 0; i < 9; ++i) EXPECT_EQ(all[i].time.sequence, i / 3);
}

TEST(Polhemus, LibertyAndPatriotTellTimeFrameAndStylus) {
  for (const char second : {'Y', 'A', 'U'}) {
    PolhemusDecoder decoder = patriot();
    const auto all = poses(decoder, liberty(2, 100, ' ', second), TransferKind::usb_bulk);
    ASSERT_EQ(all.size(), 1u);
    EXPECT_EQ(all[0].tool, "2");
    EXPECT_EQ(all[0].time.device_tick, 400'000u);
    EXPECT_EQ(all[0].buttons, 1u);
    EXPECT_TRUE(all[0].valid);
  }
}

TEST(Polhemus, MissingFramesAreCountedOnceForAllStations) {
  PolhemusDecoder decoder = patriot();
  std::vector<PoseSample> all;
  for (std::uint32_t frame : {7u, 8u, 11u, 12u})
    for (unsigned station : {1u, 2u})
      for (const PoseSample& s : poses(decoder, liberty(station, frame))) all.push_back(s);
  ASSERT_EQ(all.size(), 8u);
  EXPECT_EQ(decoder.counts().lost, 2u);
  const bool gaps[] = {false, false, false, false, true, true, false, false};
  const std::uint64_t sequences[] = {0, 0, 1, 1, 4, 4, 5, 5};
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_EQ(all[i].after_gap, gaps[i]) << i;
    EXPECT_EQ(all[i].time.sequence, sequences[i]) << i;
  }
}

TEST(Polhemus, FlaggedAndDistortedPosesAreNotValid) {
  PolhemusDecoder fast(0x0002, false);
  EXPECT_FALSE(poses(fast, fastrak('1', 'C')).at(0).valid);
  PolhemusDecoder decoder = patriot();
  EXPECT_FALSE(poses(decoder, liberty(1, 1, 'e')).at(0).valid);
  EXPECT_TRUE(poses(decoder, liberty(1, 2)).at(0).valid);
  PolhemusDecoder strict({.most_distortion = 2});
  EXPECT_FALSE(poses(strict, liberty(1, 1)).at(0).valid);
}

TEST(Polhemus, TheGreetingSetsEverythingAndStarts) {
  const auto text = [](PolhemusDecoder decoder) {
    std::string all;
    for (const Transfer& t : decoder.greeting()) {
      EXPECT_EQ(t.direction, Direction::to_device);
      for (std::byte b : t.payload) all.push_back(static_cast<char>(b));
    }
    return all;
  };
  EXPECT_EQ(text(PolhemusDecoder(0x0002, false)), "cfuO1,2,11,1\rO2,2,11,1\rO3,2,11,1\rO4,2,11,1\rC");
  EXPECT_EQ(text(patriot()), "PF1\rU1\rO*,8,9,10,11,2,7\rC\r");
  const auto usb = PolhemusDecoder(0xff20, true).greeting();
  EXPECT_EQ(usb.at(0).kind, TransferKind::usb_bulk);
  EXPECT_EQ(usb.at(0).endpoint, 0x04);
}

TEST(Polhemus, GarbageBetweenAndAnyCutOfTheStream) {
  for (const bool old : {false, true}) {
    for (const char* noise :
         {"", "30", "30 31 20", "4c", "4c59", "4c59 01 43 20 00 2c00", "ff00ff00 0d0a", "504150"}) {
      PolhemusDecoder decoder(old ? 0x0002 : 0xff20, false);
      std::vector<std::byte> stream;
      for (std::uint32_t i = 0; i < 6; ++i) {
        if (i % 2 == 1) append(stream, from_hex(noise));
        append(stream, old ? fastrak('1') : liberty(1, i));
      }
      append(stream, std::vector<std::byte>(300));
      std::size_t samples = 0;
      for (std::byte byte : stream) samples += poses(decoder, {byte}).size();
      EXPECT_EQ(samples, 6u) << noise;
    }
  }
}

TEST(Polhemus, AByteLostOrChangedCostsItsRecordAlone) {
  for (const bool old : {false, true}) {
    const std::size_t length = (old ? fastrak('1') : liberty(1, 0)).size();
    for (std::size_t at = 0; at < length; ++at)
      for (const bool lose : {false, true}) {
        PolhemusDecoder decoder(old ? 0x0002 : 0xff20, false);
        std::size_t samples = 0;
        for (std::uint32_t i = 0; i < 12; ++i) {
          auto record = old ? fastrak('1') : liberty(1, i);
          if (i == 3 && lose) record.erase(record.begin() + static_cast<std::ptrdiff_t>(at));
          if (i == 3 && !lose) record[at] ^= std::byte{0xff};
          for (const Sample& s : decoded(decoder, from_device(TransferKind::serial, record)).samples) {
            EXPECT_TRUE(is_sound(s));
            ++samples;
          }
        }
        // A length that was changed makes up to 256 bytes look like one answer.
        EXPECT_GE(samples, old ? 11u : 6u) << at << lose;
        EXPECT_LE(samples, 12u);
      }
  }
}

TEST(Polhemus, WhatIsNoNumberIsNoPose) {
  PolhemusDecoder decoder(0x0002, false);
  auto record = fastrak('1');
  const auto nan = std::bit_cast<std::uint32_t>(std::numeric_limits<float>::quiet_NaN());
  for (std::size_t i = 0; i < 4; ++i) record[3 + i] = static_cast<std::byte>(nan >> (8 * i));
  EXPECT_TRUE(poses(decoder, record).empty());
  EXPECT_GT(decoder.counts().malformed, 0u);
}

TEST(Polhemus, AnswersOfOtherKindsAreSteppedOver) {
  PolhemusDecoder decoder = patriot();
  auto stream = from_hex("5041 ff 16 20 00 0400 01020304");
  append(stream, liberty(1, 1));
  EXPECT_EQ(poses(decoder, stream).size(), 1u);
  EXPECT_EQ(decoder.counts().unknown, 1u);
}

TEST(Polhemus, UnplugIsAGapForEachStation) {
  PolhemusDecoder decoder = patriot();
  poses(decoder, liberty(1, 100));
  decoded(decoder, from_device(TransferKind::unplugged));
  EXPECT_TRUE(poses(decoder, liberty(1, 1)).at(0).after_gap);
  EXPECT_TRUE(poses(decoder, liberty(2, 1)).at(0).after_gap);
  EXPECT_FALSE(poses(decoder, liberty(1, 2)).at(0).after_gap);
  EXPECT_EQ(decoder.counts().lost, 0u);
}

}  // namespace
}  // namespace fude
