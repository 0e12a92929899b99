// What the pose messages of OpenIGTLink hold, both ways. Metres here, millimetres on the wire.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/openigtlink/message.h"
#include "signal/pose.h"
#include "signal/pose_sample.h"

namespace fude::openigtlink {

using ToolPose = Pose<Tracker, Tool>;

struct NamedPose {
  std::string name;
  ToolPose pose;
};

// POSITION and QTRANS: a place, and a turn where the message holds one.
struct Place {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  std::optional<Eigen::Quaterniond> rotation;
};

struct Status {
  std::uint16_t code = 0;  // 1: all is well
  std::string name;
  std::string text;
};

// None for another length, for what is not finite or farther than a kilometre, and for a matrix or
// quaternion that is no turn (scaled or mirrored by more than 1 %).
std::optional<ToolPose> read_transform(Bytes content);
std::optional<Place> read_position(Bytes content);
std::optional<Status> read_status(Bytes content);

// Tools that are none are left out and counted in `refused`. None for a length that no number of tools has.
struct Tools {
  std::vector<NamedPose> poses;
  std::size_t refused = 0;
};
std::optional<Tools> read_tdata(Bytes content);
std::optional<Tools> read_qtdata(Bytes content);

// Whole messages; `stamp` as in Message.
std::vector<std::byte> write_transform(std::string_view device, std::uint64_t stamp, const ToolPose& pose);
std::vector<std::byte> write_tdata(std::string_view device, std::uint64_t stamp,
                                   std::span<const NamedPose> poses);
std::vector<std::byte> write_position(std::string_view device, std::uint64_t stamp, const ToolPose& pose);
// Without a turn.
std::vector<std::byte> write_position(std::string_view device, std::uint64_t stamp,
                                      const Eigen::Vector3d& position_m);
std::vector<std::byte> write_status(std::string_view device, std::uint64_t stamp, const Status& status);

}  // namespace fude::openigtlink
