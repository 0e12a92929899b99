#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <numbers>
#include <sstream>

#include "drivers/joycon/joycon_decoder.h"
#include "drivers/joycon/rail.h"
#include "tests/fakes/recordings.h"
#include "tests/fakes/transfers.h"

namespace fude {
namespace {

constexpr double degrees_per_second = std::numbers::pi / 180;

// Timer, then three times: 4096 counts of gravity along y and a turn of 100, 200, 300 counts about x, y, z.
std::vector<std::byte> full_report(unsigned timer) {
  auto report = from_hex(
      "30 00 91 08 01 40 000000 000000 a0"
      "0000 0010 0000 6400 c800 2c01"
      "0000 0010 0000 6400 c800 2c01"
      "0000 0010 ff7f 6400 c800 2c01");
  report[1] = static_cast<std::byte>(timer);
  return report;
}

Transfer full(unsigned timer, int milliseconds) {
  return from_device(TransferKind::hid_report, full_report(timer), milliseconds);
}

// A reply with `data` behind subcommand `number`.
Transfer reply(unsigned timer, unsigned number, std::string_view data, int milliseconds) {
  auto report = from_hex("21 00 80 000000 000000 000000 a0 80");
  report[1] = static_cast<std::byte>(timer);
  report.push_back(static_cast<std::byte>(number));
  append(report, from_hex(data));
  report.resize(joycon::report_length);
  return from_device(TransferKind::hid_report, report, milliseconds);
}

ImuSample imu(const Decoded& out, std::size_t i) { return std::get<ImuSample>(out.samples.at(i)); }

TEST(Joycon, AFullReportIsThreeSamplesFiveMillisecondsApart) {
  JoyconDecoder decoder;
  const Decoded out = decoded(decoder, full(10, 40));
  ASSERT_EQ(out.samples.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    const ImuSample s = imu(out, i);
    EXPECT_EQ(s.time.host, Timestamp(std::chrono::milliseconds(40)));
    EXPECT_EQ(s.time.stamped_by, StampedBy::arrival);
    EXPECT_EQ(s.time.sequence, i);
    EXPECT_EQ(*s.time.device_tick - *imu(out, 0).time.device_tick, i * 5000);
    EXPECT_NEAR(s.specific_force_mps2.y(), 4096 * 0.000244 * 9.80665, 1e-12);
    EXPECT_NEAR(s.turn_rate_radps.x(), 100 * 0.06103 * degrees_per_second, 1e-12);
    EXPECT_NEAR(s.turn_rate_radps.y(), 200 * 0.06103 * degrees_per_second, 1e-12);
    EXPECT_NEAR(s.turn_rate_radps.z(), 300 * 0.06103 * degrees_per_second, 1e-12);
    EXPECT_EQ(s.buttons, 0x400108u);
    EXPECT_EQ(s.battery, Fraction(1));
    EXPECT_EQ(s.saturated, i == 2);
    EXPECT_TRUE(s.valid);
    EXPECT_FALSE(s.after_gap);
  }
  EXPECT_EQ(decoder.counts(), (ReportCounts{.reports = 1, .samples = 3}));
}

TEST(Joycon, TheTicksFollowTheTimerAcrossItsWrap) {
  JoyconDecoder decoder;
  const auto first = *imu(decoded(decoder, full(254, 0)), 2).time.device_tick;
  const ImuSample after = imu(decoded(decoder, full(1, 15)), 2);
  EXPECT_EQ(*after.time.device_tick, first + 15'000);
  EXPECT_FALSE(after.after_gap);
  EXPECT_EQ(decoder.counts().lost, 0u);
}

TEST(Joycon, ATimerThatJittersIsNoGap) {
  JoyconDecoder decoder;
  unsigned timer = 0;
  for (unsigned step : {3u, 4u, 2u, 3u}) {
    timer += step;
    EXPECT_FALSE(imu(decoded(decoder, full(timer, static_cast<int>(5 * timer))), 0).after_gap);
  }
  EXPECT_EQ(decoder.counts().lost, 0u);
}

TEST(Joycon, MissingReportsAreCountedAndTheSequenceShowsThem) {
  JoyconDecoder decoder;
  decoded(decoder, full(0, 0));
  const ImuSample after = imu(decoded(decoder, full(9, 45)), 0);
  EXPECT_TRUE(after.after_gap);
  EXPECT_EQ(after.time.sequence, 9u);
  EXPECT_EQ(decoder.counts().lost, 2u);
}

TEST(Joycon, ASilenceLongerThanTheTimerIsToldByTheHost) {
  JoyconDecoder decoder;
  const auto first = *imu(decoded(decoder, full(0, 0)), 2).time.device_tick;
  // 800 counts of 5 ms are three turns of 256 and 32 more; the host's stamp is 10 ms late.
  const ImuSample after = imu(decoded(decoder, full(32, 4010)), 2);
  EXPECT_EQ(*after.time.device_tick - first, 4'000'000u);
  EXPECT_TRUE(decoder.counts().lost > 260 && decoder.counts().lost < 270);
}

TEST(Joycon, AReplyTakesThePlaceOfThreeSamples) {
  JoyconDecoder decoder;
  decoded(decoder, full(0, 0));
  decoded(decoder, reply(3, 0x02, "", 15));
  const ImuSample after = imu(decoded(decoder, full(6, 30)), 0);
  EXPECT_EQ(after.time.sequence, 6u);
  EXPECT_TRUE(after.after_gap);
  EXPECT_EQ(decoder.counts().lost, 0u);  // nothing was lost on the way
}

// Subcommand and first argument of an output report.
std::pair<int, int> asked(const Transfer& question) {
  EXPECT_EQ(question.direction, Direction::to_device);
  EXPECT_EQ(question.kind, TransferKind::hid_report);
  EXPECT_EQ(question.payload.size(), joycon::report_length);
  EXPECT_EQ(question.payload.at(0), std::byte{0x01});
  return {std::to_integer<int>(question.payload.at(10)), std::to_integer<int>(question.payload.at(11))};
}

constexpr const char* factory = "20600000 18 b0ff b9fe e000 0040 0040 0040 0e00 dfff d0ff 3b34 3b34 3b34";

TEST(Joycon, TheDialogueReadsTheCalibrationAndSwitchesTheUnitOn) {
  JoyconDecoder decoder;
  const auto first = decoder.greeting();
  ASSERT_EQ(first.size(), 1u);
  EXPECT_EQ(asked(first[0]), std::pair(0x40, 1));
  auto next = decoded(decoder, reply(0, 0x40, "", 15)).replies;
  ASSERT_EQ(next.size(), 1u);
  EXPECT_EQ(asked(next[0]), std::pair(0x10, 0x20));
  EXPECT_EQ(std::vector<std::byte>(next[0].payload.begin() + 11, next[0].payload.begin() + 16),
            from_hex("20 60 00 00 18"));
  next = decoded(decoder, reply(3, 0x10, factory, 30)).replies;
  ASSERT_EQ(next.size(), 1u);
  EXPECT_EQ(asked(next[0]), std::pair(0x10, 0x26));
  EXPECT_TRUE(decoder.calibrated());
  // The user's part is blank.
  const std::string blank = "26800000 1a" + std::string(52, 'f');
  next = decoded(decoder, reply(6, 0x10, blank, 45)).replies;
  ASSERT_EQ(next.size(), 1u);
  EXPECT_EQ(asked(next[0]), std::pair(0x03, 0x30));
  EXPECT_TRUE(decoded(decoder, reply(9, 0x03, "", 60)).replies.empty());

  const ImuSample s = imu(decoded(decoder, full(12, 75)), 0);
  EXPECT_NEAR(s.specific_force_mps2.y(), 4096 * 4 * 9.80665 / (0x4000 + 0x147), 1e-9);
  EXPECT_NEAR(s.turn_rate_radps.x(), (100 - 14) * 936 * degrees_per_second / (13371 - 14), 1e-9);
  EXPECT_NEAR(s.turn_rate_radps.y(), (200 + 33) * 936 * degrees_per_second / (13371 + 33), 1e-9);
}

// Someone's question for the flash, as it stands in a recording.
Transfer flash_asked() {
  Transfer question =
      from_device(TransferKind::hid_report, joycon::subcommand(0, 0x10, joycon::flash_question(0x6020, 24)));
  question.direction = Direction::to_device;
  return question;
}

TEST(Joycon, AnOverheardAnswerDoesNotChangeTheScale) {
  JoyconDecoder decoder;
  decoded(decoder, reply(0, 0x10, factory, 0));
  EXPECT_FALSE(decoder.calibrated());
  decoded(decoder, flash_asked());
  decoded(decoder, reply(3, 0x10, factory, 0));
  EXPECT_TRUE(decoder.calibrated());
}

TEST(Joycon, TheUsersCalibrationStandsBeforeTheFactorys) {
  JoyconDecoder decoder;
  decoded(decoder, flash_asked());
  decoded(decoder, reply(0, 0x10, factory, 0));
  decoded(decoder,
          reply(3, 0x10, "26800000 1a b2a1 0000 0000 0000 0040 0040 0040 6400 6400 6400 3b34 3b34 3b34", 15));
  const ImuSample s = imu(decoded(decoder, full(6, 30)), 0);
  EXPECT_NEAR(s.specific_force_mps2.y(), 9.80665, 1e-9);
  EXPECT_NEAR(s.turn_rate_radps.x(), 0, 1e-12);
}

TEST(Joycon, ACalibrationThatMakesNoSenseIsNotUsed) {
  JoyconDecoder decoder;
  decoded(decoder, flash_asked());
  decoded(decoder, reply(0, 0x10, "20600000 18" + std::string(48, '0'), 0));
  EXPECT_FALSE(decoder.calibrated());
  decoded(decoder, reply(0, 0x10, "20600000 18" + std::string(48, 'f'), 0));
  EXPECT_FALSE(decoder.calibrated());
}

TEST(Joycon, AQuestionWithoutAnAnswerIsAskedFourTimesMoreAndThenLeft) {
  JoyconDecoder decoder;
  decoder.greeting();
  int again = 0;
  std::vector<int> subcommands;
  for (int ms = 0; ms < 20'000; ms += 15)
    for (const Transfer& question : decoded(decoder, full(static_cast<unsigned>(ms / 5) & 255, ms)).replies) {
      ++again;
      subcommands.push_back(asked(question).first);
    }
  EXPECT_EQ(again, 4 + 5 + 5 + 5);
  EXPECT_EQ(subcommands.at(3), 0x40);
  EXPECT_EQ(subcommands.at(4), 0x10);
}

TEST(Joycon, ShortAndForeignReportsAreCountedAndNoMore) {
  JoyconDecoder decoder;
  auto cut = full_report(0);
  cut.pop_back();
  EXPECT_TRUE(decoded(decoder, from_device(TransferKind::hid_report, cut)).samples.empty());
  EXPECT_TRUE(decoded(decoder, from_device(TransferKind::hid_report)).samples.empty());
  EXPECT_TRUE(decoded(decoder, from_device(TransferKind::hid_report, from_hex("63 00"))).samples.empty());
  decoded(decoder, from_device(TransferKind::hid_report, from_hex("3f 28 ca 08 0080008000800080")));
  EXPECT_EQ(decoder.counts(), (ReportCounts{.reports = 1, .malformed = 2, .unknown = 1}));
}

TEST(Joycon, AUnitThatIsOffSaysNothing) {
  JoyconDecoder decoder;
  auto off = full_report(0);
  std::fill(off.begin() + 13, off.end(), std::byte{0});
  EXPECT_FALSE(imu(decoded(decoder, from_device(TransferKind::hid_report, off)), 0).valid);
}

TEST(Joycon, AbsenceAndSleepForgetTheCalibrationAndMarkTheGap) {
  for (const TransferKind away : {TransferKind::unplugged, TransferKind::suspended}) {
    JoyconDecoder decoder;
    decoded(decoder, flash_asked());
    decoded(decoder, reply(0, 0x10, factory, 0));
    decoded(decoder, full(3, 15));
    decoded(decoder, from_device(away));
    EXPECT_FALSE(decoder.calibrated());
    const ImuSample s = imu(decoded(decoder, full(200, 9000)), 0);
    EXPECT_TRUE(s.after_gap);
    EXPECT_EQ(s.time.sequence, 3u);
    EXPECT_EQ(decoder.counts().lost, 0u);
  }
}

// Made here: the head of a rail packet around a report, with both checksums.
std::vector<std::byte> rail_packet(const std::vector<std::byte>& report) {
  auto packet = from_hex("19 81 03 38 00 92 00 31 00 00");
  packet.push_back(static_cast<std::byte>(joycon::rail_checksum(report)));
  packet.push_back(static_cast<std::byte>(joycon::rail_checksum(Bytes(packet).subspan(4))));
  append(packet, report);
  return packet;
}

TEST(JoyconRail, AByteLostOrTooManyCostsItsPacketAlone) {
  for (const int fault : {-1, 0, 1})
    for (const std::size_t at : {std::size_t{0}, std::size_t{11}, std::size_t{30}}) {
      JoyconDecoder decoder;
      std::size_t samples = 0;
      for (unsigned i = 0; i < 5; ++i) {
        auto packet = rail_packet(full_report(3 * i));
        if (i == 2 && fault < 0) packet.erase(packet.begin() + static_cast<std::ptrdiff_t>(at));
        if (i == 2 && fault > 0)
          packet.insert(packet.begin() + static_cast<std::ptrdiff_t>(at) + 1, std::byte{0x55});
        samples += decoded(decoder, from_device(TransferKind::serial, packet, static_cast<int>(15 * i)))
                       .samples.size();
      }
      EXPECT_EQ(samples, fault == 0 ? 15u : 12u) << fault << " at " << at;
      EXPECT_EQ(decoder.counts().lost, fault == 0 ? 0u : 1u);
    }
}

TEST(JoyconRail, TheEndOfAReadMeansNothing) {
  JoyconDecoder decoder;
  std::vector<std::byte> all = from_hex("00 19 81");
  for (unsigned i = 0; i < 4; ++i) append(all, rail_packet(full_report(3 * i)));
  std::size_t samples = 0;
  for (std::byte byte : all)
    samples += decoded(decoder, from_device(TransferKind::serial, {byte})).samples.size();
  EXPECT_EQ(samples, 12u);
}

// A capture of one that is handled, then lies still; the median length of gravity is known of it.
TEST(JoyconRecording, GravityHasOneLength) {
  const char* file = "joycon/joycon_uart_packets_part1.txt";
  REQUIRE_RECORDING(file);
  std::ifstream in(recordings() / file);
  JoyconDecoder decoder;
  std::vector<double> lengths;
  std::uint64_t lines = 0;
  for (std::string line; std::getline(in, line);) {
    std::vector<std::byte> packet;
    std::istringstream fields(line);
    for (std::string field; fields >> field;)
      packet.push_back(static_cast<std::byte>(std::stoul(field, nullptr, 16)));
    const int ms = static_cast<int>(15 * lines++);
    for (const Sample& sample : decoded(decoder, from_device(TransferKind::serial, packet, ms)).samples)
      lengths.push_back(std::get<ImuSample>(sample).specific_force_mps2.norm() / (0.000244 * 9.80665));
  }
  ASSERT_EQ(lengths.size(), 450u);
  EXPECT_EQ(decoder.counts().reports + decoder.counts().malformed + decoder.counts().unknown, lines);
  std::sort(lengths.begin(), lengths.end());
  EXPECT_NEAR(lengths[lengths.size() / 2], 4118, 4);
  EXPECT_GT(lengths[lengths.size() / 20], 0.98 * 4118);
  EXPECT_LT(lengths[lengths.size() * 19 / 20], 1.02 * 4118);
}

}  // namespace
}  // namespace fude
