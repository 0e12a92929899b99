#include <gtest/gtest.h>
#include <igtlPositionMessage.h>
#include <igtlQuaternionTrackingDataMessage.h>
#include <igtlStatusMessage.h>
#include <igtlTrackingDataMessage.h>
#include <igtlTransformMessage.h>

#include <bit>
#include <cmath>
#include <limits>

#include "drivers/openigtlink/content.h"
#include "drivers/openigtlink/openigtlink_decoder.h"
#include "tests/fakes/transfers.h"

// The protocol's own library is what these messages are checked against, both ways.
namespace fude {
namespace {

using openigtlink::NamedPose;
using openigtlink::ToolPose;

constexpr std::uint64_t stamp = (std::uint64_t{1'700'000'000} << 32) | 0x80000000;  // and a half

ToolPose pose() {
  return {Eigen::Quaterniond(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, -2).normalized())),
          Eigen::Vector3d(0.1, -0.2, 1.5)};
}

std::vector<std::byte> bytes_of(igtl::MessageBase& message) {
  message.Pack();
  const auto* at = reinterpret_cast<const std::byte*>(message.GetPackPointer());
  return {at, at + message.GetPackSize()};
}

// The same message with a header of version 2, whose own size may be more than twelve bytes, and one entry
// of metadata. The library packs version 1 alone.
std::vector<std::byte> extended(const std::vector<std::byte>& message, std::uint16_t size,
                                std::string_view metadata) {
  constexpr std::uint16_t index_length = 2 + 8;
  std::vector<std::byte> body;
  put_big_endian(body, size);
  put_big_endian(body, index_length);
  put_big_endian(body, static_cast<std::uint32_t>(metadata.size()));
  put_big_endian(body, std::uint32_t{7});
  body.resize(size);
  body.insert(body.end(), message.begin() + openigtlink::header_length, message.end());
  put_big_endian(body, std::uint16_t{1});
  put_big_endian(body, static_cast<std::uint16_t>(metadata.size() - 2));
  put_big_endian(body, std::uint16_t{3});
  put_big_endian(body, std::uint32_t{2});
  for (char c : metadata) body.push_back(static_cast<std::byte>(c));
  const auto read = openigtlink::read_message(message);
  auto packed = openigtlink::write_message(read->type, read->device, read->stamp, body);
  packed[1] = std::byte{2};
  return packed;
}

void fill(igtl::Matrix4x4& matrix, const ToolPose& p) {
  igtl::IdentityMatrix(matrix);
  const Eigen::Matrix3d turn = p.rotation.toRotationMatrix();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) matrix[row][column] = static_cast<float>(turn(row, column));
    matrix[row][3] = static_cast<float>(1000 * p.translation[row]);
  }
}

template <class Message>
typename Message::Pointer unpacked(const std::vector<std::byte>& bytes) {
  auto header = igtl::MessageHeader::New();
  header->InitPack();
  std::memcpy(header->GetPackPointer(), bytes.data(), static_cast<std::size_t>(header->GetPackSize()));
  header->Unpack();
  auto message = Message::New();
  message->SetMessageHeader(header);
  message->AllocatePack();
  std::memcpy(message->GetPackBodyPointer(), bytes.data() + openigtlink::header_length,
              bytes.size() - openigtlink::header_length);
  EXPECT_TRUE(message->Unpack(1) & igtl::MessageHeader::UNPACK_BODY);  // with its checksum
  return message;
}

std::vector<PoseSample> poses(OpenIgtLinkDecoder& decoder, std::vector<std::byte> bytes) {
  std::vector<PoseSample> all;
  for (const Sample& s : decoded(decoder, from_device(TransferKind::message, std::move(bytes), 3)).samples)
    all.push_back(std::get<PoseSample>(s));
  return all;
}

void expect_same(const ToolPose& a, const ToolPose& b) {
  EXPECT_LT((a.translation - b.translation).norm(), 1e-6);
  EXPECT_LT(a.rotation.angularDistance(b.rotation), 1e-6);
}

TEST(OpenIgtLink, ReadsWhatTheLibraryPacks) {
  for (const bool new_header : {false, true}) {
    const auto sent = [new_header](igtl::MessageBase& message) {
      return new_header ? extended(bytes_of(message), 12, "TransformStatusOK") : bytes_of(message);
    };
    igtl::Matrix4x4 matrix;
    fill(matrix, pose());
    auto transform = igtl::TransformMessage::New();
    transform->SetDeviceName("StylusToTracker");
    transform->SetTimeStamp(1'700'000'000, 0x80000000);
    transform->SetMatrix(matrix);
    OpenIgtLinkDecoder decoder;
    const auto one = poses(decoder, sent(*transform));
    ASSERT_EQ(one.size(), 1u) << new_header;
    EXPECT_EQ(one[0].tool, "StylusToTracker");
    EXPECT_EQ(one[0].time.device_tick, 1'700'000'000'500'000u);
    expect_same(one[0].tracker_from_tool, pose());

    auto tracking = igtl::TrackingDataMessage::New();
    tracking->SetDeviceName("Tracker");
    for (const char* name : {"Probe", "Reference"}) {
      auto element = igtl::TrackingDataElement::New();
      element->SetName(name);
      element->SetType(igtl::TrackingDataElement::TYPE_6D);
      element->SetMatrix(matrix);
      tracking->AddTrackingDataElement(element);
    }
    const auto two = poses(decoder, sent(*tracking));
    ASSERT_EQ(two.size(), 2u);
    EXPECT_EQ(two[0].tool, "Probe");
    EXPECT_EQ(two[1].tool, "Reference");
    EXPECT_EQ(two[0].time.sequence, two[1].time.sequence);
    expect_same(two[1].tracker_from_tool, pose());

    auto position = igtl::PositionMessage::New();
    position->SetDeviceName("Tip");
    position->SetPosition(100, -200, 1500);
    const auto q = pose().rotation;
    position->SetQuaternion(float(q.x()), float(q.y()), float(q.z()), float(q.w()));
    const auto three = poses(decoder, sent(*position));
    ASSERT_EQ(three.size(), 1u);
    expect_same(three[0].tracker_from_tool, pose());

    auto quaternions = igtl::QuaternionTrackingDataMessage::New();
    auto element = igtl::QuaternionTrackingDataElement::New();
    element->SetName("Pen");
    element->SetPosition(100, -200, 1500);
    element->SetQuaternion(float(q.x()), float(q.y()), float(q.z()), float(q.w()));
    quaternions->AddQuaternionTrackingDataElement(element);
    const auto four = poses(decoder, sent(*quaternions));
    ASSERT_EQ(four.size(), 1u);
    expect_same(four[0].tracker_from_tool, pose());

    auto status = igtl::StatusMessage::New();
    status->SetCode(igtl::StatusMessage::STATUS_OK);
    status->SetStatusString("well");
    EXPECT_TRUE(poses(decoder, sent(*status)).empty());
    EXPECT_EQ(decoder.counts(), (ReportCounts{.reports = 5, .samples = 5}));
  }
}

TEST(OpenIgtLink, TheLibraryReadsWhatIsWritten) {
  igtl::Matrix4x4 expected;
  fill(expected, pose());
  igtl::Matrix4x4 matrix;
  auto transform = unpacked<igtl::TransformMessage>(openigtlink::write_transform("Brush", stamp, pose()));
  transform->GetMatrix(matrix);
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column) EXPECT_NEAR(matrix[row][column], expected[row][column], 1e-4);
  EXPECT_EQ(std::string(transform->GetDeviceName()), "Brush");
  unsigned seconds = 0;
  unsigned fraction = 0;
  transform->GetTimeStamp(&seconds, &fraction);
  EXPECT_EQ(seconds, 1'700'000'000u);
  EXPECT_EQ(fraction, 0x80000000u);

  const NamedPose tools[] = {{"Brush", pose()}, {"Paper", ToolPose{}}};
  auto tracking = unpacked<igtl::TrackingDataMessage>(openigtlink::write_tdata("fude", stamp, tools));
  ASSERT_EQ(tracking->GetNumberOfTrackingDataElements(), 2);
  igtl::TrackingDataElement::Pointer element;
  tracking->GetTrackingDataElement(0, element);
  EXPECT_EQ(std::string(element->GetName()), "Brush");
  element->GetMatrix(matrix);
  EXPECT_NEAR(matrix[2][3], 1500, 1e-3);

  float x = 0;
  float y = 0;
  float z = 0;
  auto position = unpacked<igtl::PositionMessage>(openigtlink::write_position("Brush", stamp, pose()));
  position->GetPosition(&x, &y, &z);
  EXPECT_NEAR(y, -200, 1e-3);

  auto status =
      unpacked<igtl::StatusMessage>(openigtlink::write_status("fude", stamp, {1, "OK", "painting"}));
  EXPECT_EQ(status->GetCode(), 1);
  EXPECT_STREQ(status->GetStatusString(), "painting");
}

TEST(OpenIgtLink, StampsKeepTheirMicrosecond) {
  for (std::uint64_t us : {std::uint64_t{1}, std::uint64_t{999'999}, std::uint64_t{1'700'000'000'123'457}})
    EXPECT_EQ(openigtlink::stamp_us(openigtlink::stamp_of_us(us)), us);
}

TEST(OpenIgtLink, EveryFlippedByteIsSeen) {
  const auto whole = openigtlink::write_transform("Brush", stamp, pose());
  for (std::size_t at = 0; at < whole.size(); ++at) {
    if (at >= 2 && at < 42) continue;  // the checksum leaves type, name and stamp out
    auto bytes = whole;
    bytes[at] ^= std::byte{0xff};
    OpenIgtLinkDecoder decoder;
    EXPECT_TRUE(poses(decoder, bytes).empty()) << at;
    EXPECT_EQ(decoder.counts().malformed, 1u) << at;
  }
  for (std::size_t length = 0; length < whole.size(); ++length) {
    OpenIgtLinkDecoder decoder;
    EXPECT_TRUE(poses(decoder, {whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length)}).empty());
  }
}

// A content with `real` in place of one of its floats, with a checksum that holds.
std::vector<std::byte> with(std::string_view type, std::vector<std::byte> content, std::size_t at,
                            float real) {
  const auto bits = std::bit_cast<std::uint32_t>(real);
  for (std::size_t i = 0; i < 4; ++i) content[at + i] = static_cast<std::byte>(bits >> (24 - 8 * i));
  return openigtlink::write_message(type, "peer", stamp, content);
}

TEST(OpenIgtLink, NoNumberAndNoTurnIsNoPose) {
  const auto whole = openigtlink::write_transform("Brush", stamp, pose());
  const std::vector<std::byte> content(whole.begin() + openigtlink::header_length, whole.end());
  OpenIgtLinkDecoder decoder;
  std::uint64_t refused = 0;
  for (std::size_t at = 0; at < content.size(); at += 4)
    for (float real :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 1e30f}) {
      EXPECT_TRUE(poses(decoder, with("TRANSFORM", content, at, real)).empty());
      EXPECT_EQ(decoder.counts().malformed, ++refused);
    }
  // A mirror and a scale.
  EXPECT_TRUE(poses(decoder, with("TRANSFORM", content, 0, 3)).empty());
}

TEST(OpenIgtLink, OneBadToolOfSeveralIsLeftOut) {
  const NamedPose tools[] = {{"a", pose()}, {"b", pose()}};
  const auto whole = openigtlink::write_tdata("fude", stamp, tools);
  const std::vector<std::byte> content(whole.begin() + openigtlink::header_length, whole.end());
  OpenIgtLinkDecoder decoder;
  const auto left = poses(decoder, with("TDATA", content, 22, std::numeric_limits<float>::quiet_NaN()));
  ASSERT_EQ(left.size(), 1u);
  EXPECT_EQ(left[0].tool, "b");
  EXPECT_EQ(decoder.counts().malformed, 1u);
}

TEST(OpenIgtLink, ExtendedHeadersThatLieAreRefused) {
  const auto whole = extended(openigtlink::write_transform("Brush", stamp, pose()), 14, "StatusOK");
  OpenIgtLinkDecoder sound;
  EXPECT_EQ(poses(sound, whole).size(), 1u);
  const std::vector<std::byte> body(whole.begin() + openigtlink::header_length, whole.end());
  for (std::size_t field : {0u, 2u, 4u, 6u})
    for (unsigned value : {0x01u, 0x7fu, 0xffu}) {
      auto hostile = body;
      hostile[field] = static_cast<std::byte>(value);
      hostile[field + 1] = static_cast<std::byte>(value);
      auto message = openigtlink::write_message("TRANSFORM", "peer", stamp, hostile);
      message[1] = std::byte{2};
      OpenIgtLinkDecoder decoder;
      EXPECT_TRUE(poses(decoder, message).empty()) << field << " " << value;
    }
}

TEST(OpenIgtLink, InAStreamDamageCostsItsMessageAndForeignOnesAreSteppedOver) {
  const auto good = openigtlink::write_transform("Brush", stamp, pose());
  const auto foreign = openigtlink::write_message("IMAGE", "camera", stamp, std::vector<std::byte>(200'000));
  auto damaged = good;
  damaged[80] ^= std::byte{1};
  auto lying = good;
  lying[48] = std::byte{0x10};  // 4 kilobytes more than there are
  std::vector<std::byte> all;
  for (const auto& part : {good, damaged, good, foreign, good, lying, good}) append(all, part);
  append(all, from_hex("00 01 02 00 02"));
  append(all, good);
  append(all, std::vector<std::byte>(openigtlink::longest_message));
  FrameStream stream;
  std::size_t whole = 0;
  FrameStream::Fed fed;
  for (std::size_t at = 0; at < all.size(); at += 1000) {
    const auto some = Bytes(all).subspan(at, std::min<std::size_t>(1000, all.size() - at));
    const auto now =
        stream.feed(some, openigtlink::longest_message, openigtlink::fit_message,
                    [&](Bytes message) { whole += openigtlink::read_message(message).has_value(); });
    fed.damaged += now.damaged;
    fed.foreign += now.foreign;
  }
  EXPECT_EQ(whole, 5u);
  EXPECT_EQ(fed.damaged, 2u);
  EXPECT_EQ(fed.foreign, 1u);
}

}  // namespace
}  // namespace fude
