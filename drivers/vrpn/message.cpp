#include "drivers/vrpn/message.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace fude::vrpn {
namespace {

constexpr std::string_view magic = "vrpn: ver. 07.";  // what must be equal
constexpr std::string_view whole_cookie = "vrpn: ver. 07.38  0";
constexpr std::size_t alignment = 8;
constexpr std::size_t longest_name = 100;
constexpr std::int32_t least_type = -10;  // the system's own are below zero
constexpr double farthest_m = 1000;

constexpr std::size_t padded(std::size_t length) { return (length + alignment - 1) / alignment * alignment; }

double real(Bytes bytes, std::size_t at) {
  return std::bit_cast<double>(big_endian<std::uint64_t>(bytes, at));
}

void put_real(std::vector<std::byte>& bytes, double value) {
  put_big_endian(bytes, std::bit_cast<std::uint64_t>(value));
}

bool is_header(Bytes bytes) {
  const auto length = big_endian<std::uint32_t>(bytes, 0);
  const auto sender = big_endian<std::int32_t>(bytes, 12);
  const auto type = big_endian<std::int32_t>(bytes, 16);
  return length >= header_length && length <= longest_message - alignment &&
         big_endian<std::uint32_t>(bytes, 8) < 1'000'000 && sender >= -1 && sender < most_names &&
         type >= least_type && type < most_names;
}

}  // namespace

std::vector<std::byte> write_cookie() {
  std::vector<std::byte> bytes;
  for (char c : whole_cookie) bytes.push_back(static_cast<std::byte>(c));
  bytes.resize(cookie_length);
  return bytes;
}

bool is_cookie(Bytes bytes) {
  if (bytes.size() != cookie_length) return false;
  for (std::size_t i = 0; i < magic.size(); ++i)
    if (octet(bytes, i) != static_cast<std::uint8_t>(magic[i])) return false;
  return true;
}

FrameFit fit_message(Bytes bytes) {
  if (octet(bytes, 0) == static_cast<std::uint8_t>(magic[0])) {
    if (bytes.size() < cookie_length) return {FrameFit::Kind::needs_more};
    if (is_cookie(bytes.first(cookie_length))) return {FrameFit::Kind::whole, cookie_length};
  }
  if (bytes[0] != std::byte{0}) return {FrameFit::Kind::none};  // no message is as long
  if (bytes.size() < header_length) return {FrameFit::Kind::needs_more};
  if (!is_header(bytes)) return {FrameFit::Kind::damaged};
  const std::size_t length = padded(big_endian<std::uint32_t>(bytes, 0));
  if (bytes.size() < length) return {FrameFit::Kind::needs_more};
  return {FrameFit::Kind::whole, length};
}

std::optional<Message> read_message(Bytes bytes) {
  if (bytes.size() < header_length || !is_header(bytes)) return std::nullopt;
  const std::size_t length = big_endian<std::uint32_t>(bytes, 0);
  if (bytes.size() != padded(length)) return std::nullopt;
  Message message;
  message.time_us =
      std::uint64_t{big_endian<std::uint32_t>(bytes, 4)} * 1'000'000 + big_endian<std::uint32_t>(bytes, 8);
  message.sender = big_endian<std::int32_t>(bytes, 12);
  message.type = big_endian<std::int32_t>(bytes, 16);
  message.body = bytes.subspan(header_length, length - header_length);
  return message;
}

std::vector<std::byte> write_message(const Message& message) {
  std::vector<std::byte> bytes;
  put_big_endian(bytes, static_cast<std::uint32_t>(header_length + message.body.size()));
  put_big_endian(bytes, static_cast<std::uint32_t>(message.time_us / 1'000'000));
  put_big_endian(bytes, static_cast<std::uint32_t>(message.time_us % 1'000'000));
  put_big_endian(bytes, message.sender);
  put_big_endian(bytes, message.type);
  put_big_endian(bytes, std::uint32_t{0});
  append(bytes, message.body);
  bytes.resize(padded(bytes.size()));
  return bytes;
}

std::optional<std::string> read_description(Bytes body) {
  if (body.size() < 5) return std::nullopt;
  const auto length = big_endian<std::uint32_t>(body, 0);
  if (length < 2 || length > longest_name + 1 || length != body.size() - 4) return std::nullopt;
  std::string name;
  for (std::size_t i = 4; i + 1 < body.size(); ++i) {
    const char c = static_cast<char>(body[i]);
    if (c == 0) return std::nullopt;
    name.push_back(c);
  }
  return body.back() == std::byte{0} ? std::optional(name) : std::nullopt;
}

std::vector<std::byte> write_description(std::int32_t kind, std::int32_t number, std::string_view name) {
  std::vector<std::byte> body;
  put_big_endian(body, static_cast<std::uint32_t>(name.size() + 1));
  for (char c : name) body.push_back(static_cast<std::byte>(c));
  body.push_back(std::byte{0});
  return write_message({.sender = number, .type = kind, .body = body});
}

// Sensor, the same again as padding, place, quaternion x y z w.
std::optional<SensorPose> read_pose(Bytes body) {
  constexpr std::size_t length = 8 + 7 * 8;
  if (body.size() != length) return std::nullopt;
  SensorPose read;
  read.sensor = big_endian<std::int32_t>(body, 0);
  read.pose.translation = {real(body, 8), real(body, 16), real(body, 24)};
  const Eigen::Quaterniond turn(real(body, 56), real(body, 32), real(body, 40), real(body, 48));
  if (!read.pose.translation.allFinite() || read.pose.translation.cwiseAbs().maxCoeff() > farthest_m)
    return std::nullopt;
  if (!turn.coeffs().allFinite() || std::abs(turn.norm() - 1) > 0.01) return std::nullopt;
  read.pose.rotation = turn.normalized();
  return read;
}

std::vector<std::byte> write_pose(const SensorPose& pose) {
  std::vector<std::byte> body;
  put_big_endian(body, pose.sensor);
  put_big_endian(body, pose.sensor);
  for (int i = 0; i < 3; ++i) put_real(body, pose.pose.translation[i]);
  const Eigen::Quaterniond& turn = pose.pose.rotation;
  for (double value : {turn.x(), turn.y(), turn.z(), turn.w()}) put_real(body, value);
  return body;
}

bool is_velocity(Bytes body) { return body.size() == 8 + 8 * 8; }

}  // namespace fude::vrpn
