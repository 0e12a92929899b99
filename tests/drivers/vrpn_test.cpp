#include <gtest/gtest.h>

#include <bit>
#include <limits>

#include "drivers/vrpn/vrpn_decoder.h"
#include "tests/fakes/transfers.h"

namespace fude {
namespace {

using vrpn::Message;

constexpr std::int32_t tracker = 3;
constexpr std::int32_t pose_number = 5;

vrpn::SensorPose pose(std::int32_t sensor = 0) {
  return {sensor, {Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5), Eigen::Vector3d(1, -2, 0.25)}};
}

std::vector<std::byte> pose_message(std::int32_t sensor = 0) {
  return vrpn::write_message(
      {.time_us = 7'000'123, .sender = tracker, .type = pose_number, .body = vrpn::write_pose(pose(sensor))});
}

std::vector<PoseSample> poses(VrpnDecoder& decoder, std::vector<std::byte> bytes) {
  std::vector<PoseSample> all;
  for (const Sample& s : decoded(decoder, from_device(TransferKind::message, std::move(bytes))).samples)
    all.push_back(std::get<PoseSample>(s));
  return all;
}

void introduce(VrpnDecoder& decoder) {
  poses(decoder, vrpn::write_cookie());
  poses(decoder, vrpn::write_description(vrpn::sender_description, tracker, "Brush"));
  poses(decoder, vrpn::write_description(vrpn::type_description, pose_number, vrpn::pose_type));
}

// Written by hand from the layout in firmware-notes/vrpn.md.
TEST(VrpnMessages, GoldenBytes) {
  EXPECT_EQ(vrpn::write_cookie(), from_hex("7672706e 3a207665 722e2030 372e3338 20203000 00000000"));
  EXPECT_EQ(vrpn::write_description(vrpn::sender_description, 3, "Brush"),
            from_hex("00000022 00000000 00000000 00000003 ffffffff 00000000"
                     "00000006 42727573 6800 000000000000"));
  EXPECT_EQ(pose_message(2), from_hex("00000058 00000007 0000007b 00000003 00000005 00000000"
                                      "00000002 00000002 3ff0000000000000 c000000000000000 3fd0000000000000"
                                      "3fe0000000000000 bfe0000000000000 3fe0000000000000 3fe0000000000000"));
}

TEST(Vrpn, APoseOfADescribedTracker) {
  VrpnDecoder decoder;
  const auto greeting = decoder.greeting();
  ASSERT_EQ(greeting.size(), 1u);
  EXPECT_EQ(greeting[0].payload, vrpn::write_cookie());
  introduce(decoder);
  const auto all = poses(decoder, pose_message());
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].tool, "Brush");
  EXPECT_EQ(all[0].time.device_tick, 7'000'123u);
  EXPECT_EQ(all[0].tracker_from_tool.translation, Eigen::Vector3d(1, -2, 0.25));
  EXPECT_TRUE(all[0].tracker_from_tool.rotation.isApprox(Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5)));
  EXPECT_EQ(poses(decoder, pose_message(2)).at(0).tool, "Brush/2");
  EXPECT_EQ(decoder.counts(), (ReportCounts{.reports = 5, .samples = 2}));
}

TEST(Vrpn, WhatWasNotDescribedIsUnknown) {
  VrpnDecoder decoder;
  EXPECT_TRUE(poses(decoder, pose_message()).empty());
  EXPECT_EQ(decoder.counts().unknown, 1u);
  introduce(decoder);
  for (const TransferKind away : {TransferKind::unplugged, TransferKind::suspended}) {
    decoded(decoder, from_device(away));
    EXPECT_TRUE(poses(decoder, pose_message()).empty());  // numbers belong to a connection
    introduce(decoder);
    EXPECT_TRUE(poses(decoder, pose_message()).at(0).after_gap);
  }
}

TEST(Vrpn, AVelocityIsReadOverAndAShortOneIsNone) {
  VrpnDecoder decoder;
  introduce(decoder);
  poses(decoder, vrpn::write_description(vrpn::type_description, 6, vrpn::velocity_type));
  const std::vector<std::byte> velocity(72);
  poses(decoder, vrpn::write_message({.sender = tracker, .type = 6, .body = velocity}));
  EXPECT_EQ(decoder.counts().malformed, 0u);
  poses(decoder, vrpn::write_message({.sender = tracker, .type = 6, .body = Bytes(velocity).first(64)}));
  EXPECT_EQ(decoder.counts().malformed, 1u);
}

TEST(Vrpn, NumbersThatAreNoneAreNoPose) {
  VrpnDecoder decoder;
  introduce(decoder);
  std::uint64_t refused = 0;
  for (std::size_t field = 0; field < 7; ++field)
    for (double value :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e200}) {
      auto bytes = pose_message();
      const auto bits = std::bit_cast<std::uint64_t>(value);
      for (std::size_t i = 0; i < 8; ++i)
        bytes[32 + 8 * field + i] = static_cast<std::byte>(bits >> (56 - 8 * i));
      EXPECT_TRUE(poses(decoder, bytes).empty());
      EXPECT_EQ(decoder.counts().malformed, ++refused);
    }
}

TEST(Vrpn, DescriptionsThatLieAreRefused) {
  VrpnDecoder decoder;
  for (const char* body : {"", "00000006", "00000007 42727573 6800", "ffffffff 42727573 6800",
                           "00000006 42727573 6868", "00000001 00", "00000006 42007573 6800"}) {
    const auto bytes = from_hex(body);
    poses(decoder, vrpn::write_message({.sender = 1, .type = vrpn::sender_description, .body = bytes}));
  }
  EXPECT_EQ(decoder.counts().malformed, 7u);
  const std::vector<std::byte> endless(5000, std::byte{'a'});
  std::vector<std::byte> body;
  put_big_endian(body, std::uint32_t{5000});
  append(body, endless);
  poses(decoder, vrpn::write_message({.sender = 1, .type = vrpn::sender_description, .body = body}));
  EXPECT_EQ(decoder.counts().malformed, 8u);
}

TEST(Vrpn, TheStreamIsFoundAgainAfterGarbage) {
  const auto good = pose_message();
  std::vector<std::byte> all = vrpn::write_cookie();
  append(all, good);
  append(all, from_hex("ff0102030405"));
  append(all, good);
  append(all, from_hex("00000058 00000007 7fffffff 00000003 00000005"));  // no such microsecond
  append(all, good);
  FrameStream stream;
  std::size_t frames = 0;
  std::size_t messages = 0;
  for (std::byte byte : all)
    stream.feed(std::vector<std::byte>{byte}, vrpn::longest_message, vrpn::fit_message, [&](Bytes frame) {
      ++frames;
      messages += vrpn::read_message(frame).has_value() && !vrpn::is_cookie(frame);
    });
  EXPECT_EQ(frames, 4u);
  EXPECT_EQ(messages, 3u);
}

TEST(Vrpn, ACookieOfAnotherProtocolIsNone) {
  auto other = vrpn::write_cookie();
  other[11] = std::byte{'9'};
  EXPECT_FALSE(vrpn::is_cookie(other));
  auto newer = vrpn::write_cookie();
  newer[15] = std::byte{'9'};
  EXPECT_TRUE(vrpn::is_cookie(newer));
}

}  // namespace
}  // namespace fude
