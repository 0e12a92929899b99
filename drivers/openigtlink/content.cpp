#include "drivers/openigtlink/content.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace fude::openigtlink {
namespace {

constexpr std::size_t matrix_length = 48;
constexpr std::size_t tool_head_length = 22;  // name, kind, reserved
constexpr std::size_t name_length = 20;
constexpr std::uint8_t tracker_kind = 1;
constexpr double farthest_m = 1000;
constexpr double tolerance = 0.01;

double real(Bytes bytes, std::size_t at) {
  return std::bit_cast<float>(big_endian<std::uint32_t>(bytes, at));
}

Eigen::Vector3d three(Bytes bytes, std::size_t at) {
  return {real(bytes, at), real(bytes, at + 4), real(bytes, at + 8)};
}

void put_real(std::vector<std::byte>& bytes, double value) {
  put_big_endian(bytes, std::bit_cast<std::uint32_t>(static_cast<float>(value)));
}

bool is_place(const Eigen::Vector3d& position_m) {
  return position_m.allFinite() && position_m.cwiseAbs().maxCoeff() <= farthest_m;
}

// x y z w.
std::optional<Eigen::Quaterniond> read_quaternion(Bytes bytes, std::size_t at) {
  const Eigen::Quaterniond q(real(bytes, at + 12), real(bytes, at), real(bytes, at + 4), real(bytes, at + 8));
  if (!q.coeffs().allFinite() || std::abs(q.norm() - 1) > tolerance) return std::nullopt;
  return q.normalized();
}

std::string name_at(Bytes bytes, std::size_t at) {
  std::string name;
  for (std::size_t i = at; i < at + name_length && bytes[i] != std::byte{0}; ++i)
    name.push_back(static_cast<char>(bytes[i]));
  return name;
}

template <class Read>
std::optional<Tools> read_tools(Bytes content, std::size_t pose_length, Read&& read) {
  const std::size_t each = tool_head_length + pose_length;
  if (content.size() % each != 0) return std::nullopt;
  Tools tools;
  for (std::size_t at = 0; at < content.size(); at += each) {
    if (const auto pose = read(content.subspan(at + tool_head_length, pose_length)))
      tools.poses.push_back({name_at(content, at), *pose});
    else
      ++tools.refused;
  }
  return tools;
}

void put_matrix(std::vector<std::byte>& bytes, const ToolPose& pose) {
  const Eigen::Matrix3d turn = pose.rotation.toRotationMatrix();
  for (int column = 0; column < 3; ++column)
    for (int row = 0; row < 3; ++row) put_real(bytes, turn(row, column));
  for (int row = 0; row < 3; ++row) put_real(bytes, pose.translation[row] * 1000);
}

}  // namespace

std::optional<ToolPose> read_transform(Bytes content) {
  if (content.size() != matrix_length) return std::nullopt;
  Eigen::Matrix3d turn;
  for (int column = 0; column < 3; ++column)
    turn.col(column) = three(content, static_cast<std::size_t>(12 * column));
  const Eigen::Vector3d position_m = three(content, 36) / 1000;
  if (!turn.allFinite() || !is_place(position_m)) return std::nullopt;
  if (((turn.transpose() * turn) - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() > 2 * tolerance ||
      turn.determinant() < 0)
    return std::nullopt;
  return ToolPose{Eigen::Quaterniond(turn).normalized(), position_m};
}

std::optional<Place> read_position(Bytes content) {
  constexpr std::size_t place_alone = 12;
  constexpr std::size_t without_w = 24;
  constexpr std::size_t whole = 28;
  if (content.size() != place_alone && content.size() != without_w && content.size() != whole)
    return std::nullopt;
  Place place;
  place.position_m = three(content, 0) / 1000;
  if (!is_place(place.position_m)) return std::nullopt;
  if (content.size() == whole) {
    place.rotation = read_quaternion(content, 12);
    if (!place.rotation) return std::nullopt;
  } else if (content.size() == without_w) {
    const Eigen::Vector3d axis = three(content, 12);
    if (!axis.allFinite() || axis.squaredNorm() > 1 + 2 * tolerance) return std::nullopt;
    const double w = std::sqrt(std::max(0.0, 1 - axis.squaredNorm()));
    place.rotation = Eigen::Quaterniond(w, axis.x(), axis.y(), axis.z()).normalized();
  }
  return place;
}

std::optional<Tools> read_tdata(Bytes content) { return read_tools(content, matrix_length, read_transform); }

std::optional<Tools> read_qtdata(Bytes content) {
  return read_tools(content, 28, [](Bytes bytes) -> std::optional<ToolPose> {
    const auto place = read_position(bytes);
    if (!place) return std::nullopt;
    return ToolPose{*place->rotation, place->position_m};
  });
}

std::optional<Status> read_status(Bytes content) {
  constexpr std::size_t head = 30;
  if (content.size() < head) return std::nullopt;
  Status status;
  status.code = big_endian<std::uint16_t>(content, 0);
  status.name = name_at(content, 10);
  for (std::size_t i = head; i < content.size() && content[i] != std::byte{0}; ++i)
    status.text.push_back(static_cast<char>(content[i]));
  return status;
}

std::vector<std::byte> write_transform(std::string_view device, std::uint64_t stamp, const ToolPose& pose) {
  std::vector<std::byte> content;
  put_matrix(content, pose);
  return write_message("TRANSFORM", device, stamp, content);
}

std::vector<std::byte> write_tdata(std::string_view device, std::uint64_t stamp,
                                   std::span<const NamedPose> poses) {
  std::vector<std::byte> content;
  for (const NamedPose& tool : poses) {
    for (std::size_t i = 0; i < name_length; ++i)
      content.push_back(i < tool.name.size() ? static_cast<std::byte>(tool.name[i]) : std::byte{0});
    append(content, octets({tracker_kind, 0}));
    put_matrix(content, tool.pose);
  }
  return write_message("TDATA", device, stamp, content);
}

std::vector<std::byte> write_position(std::string_view device, std::uint64_t stamp, const ToolPose& pose) {
  std::vector<std::byte> content;
  for (int i = 0; i < 3; ++i) put_real(content, pose.translation[i] * 1000);
  for (double value : {pose.rotation.x(), pose.rotation.y(), pose.rotation.z(), pose.rotation.w()})
    put_real(content, value);
  return write_message("POSITION", device, stamp, content);
}

std::vector<std::byte> write_position(std::string_view device, std::uint64_t stamp,
                                      const Eigen::Vector3d& position_m) {
  std::vector<std::byte> content;
  for (int i = 0; i < 3; ++i) put_real(content, position_m[i] * 1000);
  return write_message("POSITION", device, stamp, content);
}

std::vector<std::byte> write_status(std::string_view device, std::uint64_t stamp, const Status& status) {
  std::vector<std::byte> content;
  put_big_endian(content, status.code);
  put_big_endian(content, std::int64_t{0});
  for (std::size_t i = 0; i < name_length; ++i)
    content.push_back(i < status.name.size() ? static_cast<std::byte>(status.name[i]) : std::byte{0});
  for (char c : status.text) content.push_back(static_cast<std::byte>(c));
  content.push_back(std::byte{0});
  return write_message("STATUS", device, stamp, content);
}

}  // namespace fude::openigtlink
