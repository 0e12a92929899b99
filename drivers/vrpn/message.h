// VRPN messages as they stand on the wire (firmware-notes/vrpn.md), both ways. Big-endian.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/frame_stream.h"
#include "signal/pose.h"
#include "signal/pose_sample.h"

namespace fude::vrpn {

inline constexpr std::size_t cookie_length = 24;
inline constexpr std::size_t header_length = 24;
inline constexpr std::size_t longest_message = 65536;
inline constexpr std::int32_t most_names = 2000;  // senders, and types, that a connection may describe

// What the system says of itself.
inline constexpr std::int32_t sender_description = -1;
inline constexpr std::int32_t type_description = -2;

inline constexpr std::string_view pose_type = "vrpn_Tracker Pos_Quat";
inline constexpr std::string_view velocity_type = "vrpn_Tracker Velocity";

struct Message {
  std::uint64_t time_us = 0;  // since 1970, by the peer's clock
  std::int32_t sender = 0;    // of a description: the number that is described
  std::int32_t type = 0;
  Bytes body;  // without padding
};

// Each end says this first. The last digits of the version do not matter.
std::vector<std::byte> write_cookie();
bool is_cookie(Bytes bytes);

// For a stream: the cookie, or a message with its padding. Without a checksum a place is taken for the
// beginning of a message when its length, microseconds, sender and type can be.
FrameFit fit_message(Bytes bytes);

// Of one whole frame of fit_message that is no cookie.
std::optional<Message> read_message(Bytes bytes);

std::vector<std::byte> write_message(const Message& message);

// The name in a description; none for a length that is not the body's, or that no name has (1 to 100).
std::optional<std::string> read_description(Bytes body);
std::vector<std::byte> write_description(std::int32_t kind, std::int32_t number, std::string_view name);

struct SensorPose {
  std::int32_t sensor = 0;
  Pose<Tracker, Tool> pose;
};

// None for another length, numbers that are not finite or farther than a kilometre, or no unit quaternion.
std::optional<SensorPose> read_pose(Bytes body);
std::vector<std::byte> write_pose(const SensorPose& pose);

// Whether the body is a velocity; fude keeps none.
bool is_velocity(Bytes body);

}  // namespace fude::vrpn
