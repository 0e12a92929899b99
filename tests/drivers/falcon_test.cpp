#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "drivers/falcon/falcon_decoder.h"
#include "drivers/falcon/ftdi.h"
#include "drivers/falcon/kinematics.h"
#include "tests/fakes/falcon_arm.h"
#include "tests/fakes/sound_sample.h"
#include "tests/fakes/transfers.h"

namespace fude {
namespace {

using namespace falcon;
using Eigen::Vector3d;

// Places within a ball of 9 cm about the middle; the cube's corners are beyond the legs.
std::vector<Vector3d> workspace(int steps) {
  std::vector<Vector3d> places;
  for (int x = 0; x < steps; ++x)
    for (int y = 0; y < steps; ++y)
      for (int z = 0; z < steps; ++z) {
        const Vector3d from_middle = (Vector3d(x, y, z) / (steps - 1) - Vector3d::Constant(0.5)) * 0.09;
        if (from_middle.norm() <= 0.045) places.push_back(workspace_middle() + from_middle);
      }
  return places;
}

TEST(FalconKinematics, PositionAndAnglesAreEachOthersInverse) {
  for (const Vector3d& place : workspace(7)) {
    const auto angles = leg_angles(place);
    ASSERT_TRUE(angles) << place.transpose();
    const auto back = grip_position(*angles, workspace_middle());
    ASSERT_TRUE(back) << place.transpose();
    EXPECT_LT((*back - place).norm(), 1e-9);
  }
}

// Each leg closes: the far end of its chain of thigh and shin, built from the angles, is where the grip is.
TEST(FalconKinematics, TheLegsClose) {
  const auto angles = leg_angles(workspace_middle());
  ASSERT_TRUE(angles);
  // In the middle all legs are the same by the arm's threefold symmetry.
  EXPECT_NEAR((*angles)[0], (*angles)[1], 1e-9);
  EXPECT_NEAR((*angles)[1], (*angles)[2], 1e-9);
  const double knee_u = 0.040 + 0.060 * std::cos((*angles)[0]);  // from the base's middle, along the leg
  const double knee_w = 0.060 * std::sin((*angles)[0]);
  const double across = -0.02309 + 0.025;  // what the shin has to lean sideways
  const double grip_u = 0.01443;           // where the shin meets the grip
  const double shin = std::hypot(knee_u - grip_u, 0.125 - knee_w);
  EXPECT_NEAR(shin, 2 * 0.01125 + std::sqrt(0.1025 * 0.1025 - across * across), 1e-9);
}

TEST(FalconKinematics, TheJacobianIsTheChangeOfTheAngles) {
  constexpr double step = 1e-6;
  for (const Vector3d& place : workspace(4)) {
    const auto jacobian = angle_jacobian(place);
    ASSERT_TRUE(jacobian);
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3d change = (*leg_angles(place + step * Vector3d::Unit(axis)) -
                               *leg_angles(place - step * Vector3d::Unit(axis))) /
                              (2 * step);
      EXPECT_LT((change - jacobian->col(axis)).norm(), 1e-5 * jacobian->norm()) << place.transpose();
    }
  }
}

TEST(FalconKinematics, TorquesDoTheWorkOfTheForce) {
  for (const Vector3d& place : workspace(4))
    for (const Vector3d& force : {Vector3d(3, 0, 0), Vector3d(0, -5, 0), Vector3d(1, 2, -4)}) {
      const auto torques = leg_torques(place, force);
      ASSERT_TRUE(torques);
      EXPECT_LT((*grip_force(place, *torques) - force).norm(), 1e-9);
      const Vector3d velocity(0.1, -0.2, 0.05);
      EXPECT_NEAR(torques->dot(*angle_jacobian(place) * velocity), force.dot(velocity), 1e-9);
    }
}

TEST(FalconKinematics, OutOfReachIsNone) {
  EXPECT_FALSE(leg_angles({0, 0, 0.5}));
  EXPECT_FALSE(leg_angles({0.3, 0, 0.1}));
  EXPECT_FALSE(leg_angles({std::nan(""), 0, 0.1}));
  EXPECT_FALSE(grip_position({std::nan(""), 0, 0}, workspace_middle()));
  EXPECT_FALSE(grip_position({1e9, 0, 0}, workspace_middle()));
  EXPECT_FALSE(leg_torques({0, 0, 0.5}, {1, 0, 0}));
}

TEST(FalconKinematics, EveryEncoderGivesAPlaceThatFitsOrNone) {
  int places = 0;
  for (int a = -3000; a <= 3000; a += 500)
    for (int b = -3000; b <= 3000; b += 500)
      for (int c = -3000; c <= 3000; c += 500) {
        const Vector3d angles(leg_angle(static_cast<std::int16_t>(a)),
                              leg_angle(static_cast<std::int16_t>(b)),
                              leg_angle(static_cast<std::int16_t>(c)));
        const auto place = grip_position(angles, workspace_middle());
        if (!place) continue;
        ++places;
        EXPECT_LT((*leg_angles(*place) - angles).norm(), 1e-5);
      }
  EXPECT_GT(places, 100);
}

TEST(FalconMessages, GoldenCharacters) {
  const auto text = [](const std::vector<std::byte>& bytes) {
    std::string s;
    for (std::byte b : bytes) s.push_back(static_cast<char>(b));
    return s;
  };
  EXPECT_EQ(text(write_to_arm({.motors = {0, 1, -1}, .light = green, .homing = true})), "<AAAABAAAPPPPDA>");
  EXPECT_EQ(text(write_from_arm({.encoders = {0x1234, 0, -2}, .homed = 7, .buttons = 5})),
            std::string("<EDCBAAAAOPPP") + char('A' + 0x75) + "A>");
  const ToArm sent{.motors = {-4096, 4095, 17}, .light = red, .homing = false};
  EXPECT_EQ(read_to_arm(write_to_arm(sent)), sent);
}

// As the chip gives it: two bytes of status before it.
Transfer from_arm(const FromArm& message, int milliseconds) {
  auto bytes = octets({0x01, 0x60});
  append(bytes, write_from_arm(message));
  return from_device(TransferKind::usb_bulk, bytes, milliseconds);
}

Transfer silence(int milliseconds) {
  return from_device(TransferKind::usb_bulk, octets({0x01, 0x60}), milliseconds);
}

TEST(Falcon, AMessageIsASample) {
  FalconDecoder decoder;
  const auto out = decoded(decoder, from_arm({.encoders = {100, -200, 300}, .homed = 7, .buttons = 2}, 4));
  ASSERT_EQ(out.samples.size(), 1u);
  const auto s = std::get<HapticSample>(out.samples[0]);
  EXPECT_TRUE(s.homed);
  EXPECT_EQ(s.buttons, 2u);
  EXPECT_EQ(s.encoder_counts, (std::array<std::int32_t, 3>{100, -200, 300}));
  EXPECT_EQ(s.time.host, Timestamp(std::chrono::milliseconds(4)));
  const Vector3d angles(leg_angle(100), leg_angle(-200), leg_angle(300));
  EXPECT_LT((*leg_angles(s.position_m + workspace_middle()) - angles).norm(), 1e-9);
  EXPECT_EQ(decoder.state(), FalconDecoder::State::running);
  ASSERT_EQ(out.replies.size(), 1u);  // asks for the next
  EXPECT_EQ(read_to_arm(out.replies[0].payload)->motors, (std::array<std::int16_t, 3>{}));
}

TEST(Falcon, UntilEveryLegKnowsItsZeroItIsNotHomed) {
  FalconDecoder decoder;
  for (const int legs : {0, 1, 3, 6}) {
    const auto homed = static_cast<std::uint8_t>(legs);
    const auto out = decoded(decoder, from_arm({.homed = homed}, 0));
    EXPECT_FALSE(std::get<HapticSample>(out.samples.at(0)).homed);
    EXPECT_EQ(read_to_arm(out.replies.at(0).payload)->light, red);
    EXPECT_TRUE(read_to_arm(out.replies.at(0).payload)->homing);
  }
}

TEST(Falcon, MessagesAreFoundAcrossPacketsAndGarbage) {
  std::vector<std::byte> stream = from_hex("3c41 3c3c");
  for (int i = 0; i < 8; ++i)
    append(stream, write_from_arm({.encoders = {static_cast<std::int16_t>(i), 0, 0}, .homed = 7}));
  std::vector<std::byte> packets;
  for (std::size_t at = 0; at < stream.size(); at += 62) {
    append(packets, octets({0x01, 0x60}));
    append(packets, Bytes(stream).subspan(at, std::min<std::size_t>(62, stream.size() - at)));
  }
  FalconDecoder decoder;
  EXPECT_EQ(decoded(decoder, from_device(TransferKind::usb_bulk, packets)).samples.size(), 8u);
}

TEST(Falcon, VelocityIsTheChangeOfPlace) {
  FalconDecoder decoder;
  HapticSample last;
  for (int i = 0; i < 20; ++i) {
    const auto counts = static_cast<std::int16_t>(10 * i);
    last = std::get<HapticSample>(
        decoded(decoder, from_arm({.encoders = {counts, counts, counts}, .homed = 7}, i)).samples.at(0));
  }
  const auto place = [](double counts) {
    const double angle = leg_angle(static_cast<std::int16_t>(counts));
    return *grip_position({angle, angle, angle}, workspace_middle());
  };
  EXPECT_LT((last.velocity_mps - (place(190) - place(90)) / 0.010).norm(), 1e-6);
  EXPECT_GT(last.velocity_mps.norm(), 0.1);
}

TEST(Falcon, TheForceOfASampleIsThatOfTheLastMessage) {
  FalconDecoder decoder({}, false);
  decoded(decoder, from_arm({.homed = 7}, 0));
  const double angle = leg_angle(0);
  const Vector3d place = *grip_position({angle, angle, angle}, workspace_middle());
  Transfer sent = bulk(write_to_arm(force_message(place, {1, 2, -3}, green)));
  decoded(decoder, sent);
  const auto s = std::get<HapticSample>(decoded(decoder, from_arm({.homed = 7}, 1)).samples.at(0));
  EXPECT_LT((s.force_n - Vector3d(1, 2, -3)).norm(), 0.02);  // a motor count is about 3 mN
}

TEST(Falcon, AMotorsLimitShortensTheForceAndKeepsItsDirection) {
  const Vector3d place = workspace_middle();
  const ToArm message = force_message(place, {0, 0, 1000}, green);
  for (std::int16_t counts : message.motors) EXPECT_LE(std::abs(counts), 4096);
  const Vector3d torques = Vector3d(message.motors[0], message.motors[1], message.motors[2]) / -10000.0;
  const Vector3d force = *grip_force(place, torques);
  EXPECT_LT(std::hypot(force.x(), force.y()), 0.01 * force.z());
  EXPECT_EQ(force_message(place, {std::nan(""), 0, 0}, green).motors, (std::array<std::int16_t, 3>{}));
  EXPECT_EQ(force_message({0, 0, 9}, {1, 0, 0}, green).motors, (std::array<std::int16_t, 3>{}));
}

std::vector<std::byte> image() {
  std::vector<std::byte> bytes(5000);
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::byte>(i * 7 + i / 256);
  return bytes;
}

// Runs the dialogue, each answer cut into pieces, silence between.
void power_up(FalconDecoder& decoder, PowerOn& arm, int milliseconds_at_most) {
  std::vector<Transfer> sent = decoder.greeting();
  for (int ms = 0; ms < milliseconds_at_most && decoder.state() != FalconDecoder::State::failed; ms += 16) {
    std::vector<std::byte> answer;
    for (const Transfer& transfer : sent) append(answer, arm.hear(transfer));
    sent.clear();
    for (std::size_t at = 0; at < answer.size() || at == 0; at += 50) {
      auto packet = octets({0x01, 0x60});
      append(packet, Bytes(answer).subspan(at, std::min<std::size_t>(50, answer.size() - at)));
      for (Transfer& reply : decoded(decoder, from_device(TransferKind::usb_bulk, packet, ms)).replies)
        sent.push_back(std::move(reply));
    }
    if (decoder.state() == FalconDecoder::State::running && decoder.counts().samples > 3) return;
  }
}

TEST(FalconFirmware, AnArmWithoutFirmwareIsGivenTheUsers) {
  FalconDecoder decoder(image());
  PowerOn arm(image());
  power_up(decoder, arm, 20'000);
  EXPECT_TRUE(arm.loaded());
  EXPECT_EQ(decoder.state(), FalconDecoder::State::running);
  EXPECT_GT(decoder.counts().samples, 3u);
}

TEST(FalconFirmware, ABlockThatComesBackWrongBeginsItAgain) {
  FalconDecoder decoder(image());
  PowerOn arm(image());
  arm.spoil(20);
  power_up(decoder, arm, 20'000);
  EXPECT_TRUE(arm.loaded());
  EXPECT_EQ(decoder.state(), FalconDecoder::State::running);
}

TEST(FalconFirmware, ADeadArmIsGivenUpAfterTenTries) {
  FalconDecoder decoder(image());
  decoder.greeting();
  for (int ms = 0; ms < 30'000; ms += 16) decoded(decoder, silence(ms));
  EXPECT_EQ(decoder.state(), FalconDecoder::State::failed);
}

TEST(FalconFirmware, WithoutAnImageItIsSaid) {
  FalconDecoder decoder;
  decoder.greeting();
  for (int ms = 0; ms < 1000; ms += 16) decoded(decoder, silence(ms));
  EXPECT_EQ(decoder.state(), FalconDecoder::State::no_firmware);
}

TEST(FalconFirmware, TheChipsRequestsAreThoseOfItsKind) {
  EXPECT_EQ(baud_divisor(0x4138).payload, from_hex("40 03 3841 0000 0000"));
  EXPECT_EQ(dtr(true).payload, from_hex("40 01 0101 0000 0000"));
  EXPECT_EQ(dtr(false).payload, from_hex("40 01 0001 0000 0000"));
  EXPECT_EQ(latency_ms(16).payload, from_hex("40 09 1000 0000 0000"));
  EXPECT_EQ(without_status(from_hex("0160")).size(), 0u);
  EXPECT_EQ(without_status(std::vector<std::byte>(130)).size(), 124u);
}

TEST(Falcon, UnplugForgetsAndMarksTheGap) {
  FalconDecoder decoder;
  decoded(decoder, from_arm({.homed = 7}, 0));
  decoded(decoder, from_device(TransferKind::unplugged));
  EXPECT_EQ(decoder.state(), FalconDecoder::State::unknown);
  EXPECT_TRUE(std::get<HapticSample>(decoded(decoder, from_arm({.homed = 7}, 900)).samples.at(0)).after_gap);
}

}  // namespace
}  // namespace fude
