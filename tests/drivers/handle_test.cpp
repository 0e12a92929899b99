#include <gtest/gtest.h>

#include <numbers>

#include "drivers/crc16.h"
#include "drivers/handle/handle_decoder.h"
#include "tests/fakes/transfers.h"

namespace fude {
namespace {

TEST(Crc16, IsTheOneOfTheCatalogue) {
  std::vector<std::byte> digits;
  for (char c = '1'; c <= '9'; ++c) digits.push_back(static_cast<std::byte>(c));
  EXPECT_EQ(crc16(digits), 0x29b1);
}

// firmware-notes/brush-handle.md gives the same bytes to whoever builds one.
constexpr const char* golden_motion =
    "01 01 0200 a0860100 e803 18fc 0000 0000 0000 0020 6400 38ff 0a00 c409 05 01 50 00 0ef2";
constexpr const char* golden_scale =
    "02 01 d007 803e e803 e803 01 00 02 01 48303037000000000000000000000000 7111";

handle::Motion golden() {
  handle::Motion motion;
  motion.sequence = 2;
  motion.tick_us = 100'000;
  motion.turn_rate = {1000, -1000, 0};
  motion.specific_force = {0, 0, 8192};
  motion.magnetic_field = {100, -200, 10};
  motion.temperature_c = 25;
  motion.buttons = 5;
  motion.magnetic_field_is_new = true;
  motion.battery = 0.8;
  return motion;
}

handle::Scale scale() {
  handle::Scale s;
  s.turn_rate_degps = 2000;
  s.specific_force_mg = 16000;
  s.magnetic_field_ut = 1000;
  s.rate_hz = 1000;
  s.firmware_major = 1;
  s.buttons = 2;
  s.has_magnetometer = true;
  s.serial = "H007";
  return s;
}

Transfer motion(std::uint16_t sequence, std::uint32_t tick_us, int milliseconds) {
  handle::Motion m = golden();
  m.sequence = sequence;
  m.tick_us = tick_us;
  return from_device(TransferKind::hid_report, handle::write_motion(m), milliseconds);
}

Transfer told_scale() { return from_device(TransferKind::hid_feature, from_hex(golden_scale)); }

ImuSample imu(const Decoded& out) { return std::get<ImuSample>(out.samples.at(0)); }

TEST(HandleReports, AreTheBytesOfTheSpecification) {
  EXPECT_EQ(handle::write_motion(golden()), from_hex(golden_motion));
  EXPECT_EQ(handle::write_scale(scale()), from_hex(golden_scale));
  EXPECT_EQ(handle::write_motion(golden()).size(), handle::motion_length);
  EXPECT_EQ(handle::write_scale(scale()).size(), handle::scale_length);
  const auto read = handle::read_scale(from_hex(golden_scale));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->serial, "H007");
  EXPECT_EQ(read->rate_hz, 1000);
}

TEST(Handle, AReportIsASampleInItsUnits) {
  HandleDecoder decoder;
  const auto question = decoder.greeting();
  ASSERT_EQ(question.size(), 1u);
  EXPECT_EQ(question[0].kind, TransferKind::hid_ask);
  EXPECT_EQ(question[0].payload, from_hex("02"));
  decoded(decoder, told_scale());
  const ImuSample s =
      imu(decoded(decoder, from_device(TransferKind::hid_report, from_hex(golden_motion), 7)));
  constexpr double rate = 2000.0 / 32768 * std::numbers::pi / 180;
  EXPECT_TRUE(s.turn_rate_radps.isApprox(Eigen::Vector3d(1000 * rate, -1000 * rate, 0)));
  EXPECT_TRUE(s.specific_force_mps2.isApprox(Eigen::Vector3d(0, 0, 4 * 9.80665)));
  EXPECT_TRUE(s.magnetic_field_ut->isApprox(Eigen::Vector3d(100, -200, 10) * (1000.0 / 32768)));
  EXPECT_EQ(s.temperature_c, 25.0);
  EXPECT_EQ(s.battery, Fraction(0.8));
  EXPECT_EQ(s.buttons, 5u);
  EXPECT_EQ(s.time.device_tick, 100'000u);
  EXPECT_EQ(s.time.host, Timestamp(std::chrono::milliseconds(7)));
  EXPECT_TRUE(s.valid && !s.saturated && !s.after_gap);
}

TEST(Handle, WithoutItsScaleACountMeansNothingAndItIsAskedAgain) {
  HandleDecoder decoder;
  decoder.greeting();
  int asked = 0;
  for (int i = 0; i < 450; ++i) {
    const Decoded out =
        decoded(decoder, motion(static_cast<std::uint16_t>(i), static_cast<std::uint32_t>(1000 * i), i));
    EXPECT_TRUE(out.samples.empty());
    asked += static_cast<int>(out.replies.size());
  }
  EXPECT_EQ(asked, 2);
  decoded(decoder, told_scale());
  const ImuSample s = imu(decoded(decoder, motion(450, 450'000, 450)));
  EXPECT_TRUE(s.after_gap);
  EXPECT_EQ(s.time.sequence, 450u);
}

TEST(Handle, LossesShowInTheSequenceAcrossTheWrap) {
  HandleDecoder decoder;
  decoded(decoder, told_scale());
  const auto first = imu(decoded(decoder, motion(0xfffe, 0xfffffff0, 0)));
  const auto next = imu(decoded(decoder, motion(0xffff, 984, 1)));
  const auto later = imu(decoded(decoder, motion(3, 4984, 5)));
  EXPECT_EQ(next.time.sequence, first.time.sequence + 1);
  EXPECT_EQ(*next.time.device_tick - *first.time.device_tick, 1000u);
  EXPECT_FALSE(next.after_gap);
  EXPECT_EQ(later.time.sequence, next.time.sequence + 4);
  EXPECT_TRUE(later.after_gap);
  EXPECT_EQ(decoder.counts().lost, 3u);
}

TEST(Handle, ARestartIsAGapAndItsClockBeginsAnew) {
  HandleDecoder decoder;
  decoded(decoder, told_scale());
  decoded(decoder, motion(5000, 60'000'000, 0));
  const auto s = imu(decoded(decoder, motion(0, 500, 900)));
  EXPECT_TRUE(s.after_gap);
  EXPECT_EQ(s.time.device_tick, 500u);
  EXPECT_EQ(s.time.sequence, 2u);
  EXPECT_EQ(decoder.counts().lost, 1u);
}

TEST(Handle, ASilenceOfAnHourAndAHalfKeepsTheTick) {
  HandleDecoder decoder;
  decoded(decoder, told_scale());
  decoded(decoder, motion(0, 0, 0));
  constexpr std::uint64_t passed_us = 5'400'000'000;
  const auto s = imu(decoded(decoder, motion(100, static_cast<std::uint32_t>(passed_us), 5'400'000)));
  EXPECT_EQ(s.time.device_tick, passed_us);
}

TEST(Handle, EveryFlippedBitIsSeen) {
  HandleDecoder decoder;
  decoded(decoder, told_scale());
  const auto whole = from_hex(golden_motion);
  for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
    auto report = whole;
    report[bit / 8] ^= static_cast<std::byte>(1u << (bit % 8));
    EXPECT_TRUE(decoded(decoder, from_device(TransferKind::hid_report, report)).samples.empty()) << bit;
  }
  for (std::size_t length = 0; length < whole.size(); ++length)
    EXPECT_TRUE(
        decoded(decoder, from_device(TransferKind::hid_report,
                                     {whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length)}))
            .samples.empty());
  EXPECT_EQ(decoder.counts().malformed, 9 * whole.size());
}

TEST(Handle, AReportThatComesTwiceIsOneSample) {
  HandleDecoder decoder;
  decoded(decoder, told_scale());
  EXPECT_EQ(decoded(decoder, motion(7, 7000, 7)).samples.size(), 1u);
  EXPECT_EQ(decoded(decoder, motion(7, 7000, 8)).samples.size(), 0u);
  EXPECT_EQ(decoder.counts().malformed, 1u);
}

TEST(Handle, ASensorThatFailedAndAnAxisAtItsEnd) {
  HandleDecoder decoder;
  decoded(decoder, told_scale());
  handle::Motion m = golden();
  m.measured = false;
  m.turn_rate[1] = INT16_MIN;
  m.magnetic_field_is_new = false;
  m.temperature_c.reset();
  m.battery.reset();
  const auto s = imu(decoded(decoder, from_device(TransferKind::hid_report, handle::write_motion(m))));
  EXPECT_FALSE(s.valid);
  EXPECT_TRUE(s.saturated);
  EXPECT_FALSE(s.magnetic_field_ut || s.temperature_c || s.battery);
}

TEST(Handle, UnplugForgetsTheScale) {
  HandleDecoder decoder;
  decoded(decoder, told_scale());
  decoded(decoder, motion(9, 9000, 9));
  decoded(decoder, from_device(TransferKind::unplugged));
  EXPECT_FALSE(decoder.scale());
  decoded(decoder, told_scale());
  const auto s = imu(decoded(decoder, motion(0, 10, 900)));
  EXPECT_TRUE(s.after_gap);
  EXPECT_EQ(decoder.counts().lost, 0u);  // how many, nobody knows
}

}  // namespace
}  // namespace fude
