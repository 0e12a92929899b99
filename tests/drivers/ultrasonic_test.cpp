#include <gtest/gtest.h>

#include "drivers/ultrasonic/cobs.h"
#include "drivers/ultrasonic/ultrasonic_decoder.h"
#include "tests/fakes/transfers.h"

namespace fude {
namespace {

using namespace ultrasonic;

// The examples of Cheshire and Baker, and the ends of a run of 254.
TEST(Cobs, StuffsAsPublished) {
  EXPECT_EQ(stuffed(from_hex("00")), from_hex("01 01"));
  EXPECT_EQ(stuffed(from_hex("00 00")), from_hex("01 01 01"));
  EXPECT_EQ(stuffed(from_hex("11 22 00 33")), from_hex("03 11 22 02 33"));
  EXPECT_EQ(stuffed(from_hex("11 22 33 44")), from_hex("05 11 22 33 44"));
  EXPECT_EQ(stuffed(from_hex("11 00 00 00")), from_hex("02 11 01 01 01"));
  const std::vector<std::byte> run(254, std::byte{7});
  EXPECT_EQ(stuffed(run).size(), 255u);
  EXPECT_EQ(stuffed(run)[0], std::byte{0xff});
}

TEST(Cobs, GivesEveryPacketBack) {
  std::uint32_t state = 1;
  for (std::size_t length = 0; length < 600; ++length) {
    std::vector<std::byte> packet(length);
    for (std::byte& byte : packet) {
      state = state * 1664525 + 1013904223;
      byte = static_cast<std::byte>(length % 3 == 0 ? 1 + state % 255 : (state >> 24) % 4);
    }
    const auto bytes = stuffed(packet);
    EXPECT_EQ(std::count(bytes.begin(), bytes.end(), std::byte{0}), 0);
    EXPECT_EQ(unstuffed(bytes), packet) << length;
  }
}

// firmware-notes/ultrasonic.md gives the same bytes.
constexpr const char* golden_pulse =
    "01 01 0500 40420f00 9808 03 00 002d3101 00c0 ffffffff 0000 80841e00 ffff a033";

Pulse golden() {
  Pulse pulse;
  pulse.sequence = 5;
  pulse.tick_us = 1'000'000;
  pulse.temperature_c = 22;
  pulse.receivers = 3;
  pulse.flight_ns[0] = 20'000'000;
  pulse.flight_ns[2] = 2'000'000;
  pulse.amplitude = {0xc000, 0, 0xffff};
  return pulse;
}

Transfer line(std::uint16_t sequence, int milliseconds) {
  Pulse pulse = golden();
  pulse.sequence = sequence;
  pulse.tick_us = static_cast<std::uint32_t>(1000 * milliseconds);
  return from_device(TransferKind::serial, framed(write_pulse(pulse)), milliseconds);
}

TEST(UltrasonicPackets, AreTheBytesOfTheSpecification) {
  EXPECT_EQ(write_pulse(golden()), from_hex(golden_pulse));
  EXPECT_EQ(write_command(PacketKind::start), from_hex("01 11 2e2c"));
}

TEST(Ultrasonic, APulseSaysWhichEmitterFired) {
  Pulse pulse = golden();
  pulse.emitter = 1;
  EXPECT_EQ(read_pulse(write_pulse(pulse))->emitter, 1);
  UltrasonicDecoder decoder;
  const Decoded out =
      decoded(decoder, from_device(TransferKind::serial, framed(write_pulse(pulse)), 30));
  EXPECT_EQ(std::get<RangeSample>(out.samples.at(0)).emitter, 1);
}

TEST(Ultrasonic, APulseIsASample) {
  UltrasonicDecoder decoder;
  const Decoded out = decoded(decoder, line(5, 30));
  const auto s = std::get<RangeSample>(out.samples.at(0));
  EXPECT_EQ(s.receivers, 3);
  EXPECT_DOUBLE_EQ(*s.flight_s[0], 0.02);
  EXPECT_FALSE(s.flight_s[1]);
  EXPECT_DOUBLE_EQ(*s.flight_s[2], 0.002);
  EXPECT_EQ(s.amplitude[2], 1);
  EXPECT_EQ(s.temperature_c, 22.0);
  EXPECT_EQ(s.time.device_tick, 30'000u);
}

TEST(Ultrasonic, TheBoardIsAskedWhoItIs) {
  UltrasonicDecoder decoder;
  const auto greeting = decoder.greeting();
  ASSERT_EQ(greeting.size(), 1u);
  EXPECT_EQ(greeting[0].payload.front(), std::byte{0});
  Board board;
  board.receivers = 6;
  board.resolution_ns = 125;
  board.rate_hz = 100;
  board.serial = "U1";
  decoded(decoder, from_device(TransferKind::serial, framed(write_board(board))));
  ASSERT_TRUE(decoder.board());
  EXPECT_EQ(decoder.board()->serial, "U1");
  EXPECT_EQ(decoder.counts().reports, 1u);
}

TEST(Ultrasonic, AnyCutOfTheStreamAndGarbageBetweenCostsOnlyWhatItTouched) {
  for (const char* noise : {"", "00", "55 aa", "00 00 ff 00", "01 02 00"}) {
    UltrasonicDecoder decoder;
    std::vector<std::byte> all = from_hex(noise);
    all.push_back(std::byte{0});
    for (std::uint16_t i = 0; i < 5; ++i) append(all, line(i, 10 * i).payload);
    std::size_t samples = 0;
    for (std::byte byte : all)
      samples += decoded(decoder, from_device(TransferKind::serial, {byte})).samples.size();
    EXPECT_EQ(samples, 5u) << noise;
  }
}

TEST(Ultrasonic, ABrokenByteAtEveryPlaceIsALossOfOneAndNoMore) {
  const std::size_t length = line(1, 10).payload.size();
  for (std::size_t at = 0; at < length; ++at)
    for (const unsigned flip : {0x01u, 0x80u, 0xffu}) {
      UltrasonicDecoder decoder;
      std::vector<RangeSample> samples;
      for (std::uint16_t i = 0; i < 4; ++i) {
        Transfer transfer = line(i, 10 * i);
        if (i == 1) transfer.payload[at] ^= static_cast<std::byte>(flip);
        for (const Sample& s : decoded(decoder, transfer).samples)
          samples.push_back(std::get<RangeSample>(s));
      }
      // A broken end joins two packets.
      ASSERT_GE(samples.size(), 2u) << at;
      EXPECT_LE(samples.size(), 3u) << at;
      EXPECT_EQ(samples.back().time.sequence, 3u);
      EXPECT_GT(decoder.counts().lost, 0u);
      EXPECT_GT(decoder.counts().malformed, 0u);
    }
}

TEST(Ultrasonic, AFloodWithoutAnEndIsHeldSmall) {
  UltrasonicDecoder decoder;
  decoded(decoder, from_device(TransferKind::serial, std::vector<std::byte>(1'000'000, std::byte{0x41})));
  decoded(decoder, from_device(TransferKind::serial, from_hex("00")));
  EXPECT_EQ(decoder.counts().malformed, 1u);
  EXPECT_EQ(decoded(decoder, line(0, 0)).samples.size(), 1u);
}

TEST(Ultrasonic, UnplugIsAGap) {
  UltrasonicDecoder decoder;
  decoded(decoder, line(0, 0));
  decoded(decoder, from_device(TransferKind::unplugged));
  EXPECT_TRUE(std::get<RangeSample>(decoded(decoder, line(900, 9000)).samples.at(0)).after_gap);
}

}  // namespace
}  // namespace fude
