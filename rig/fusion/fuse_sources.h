// What a fused pose is made of, by the names that the user gives.
#pragma once

#include <array>
#include <set>
#include <string_view>
#include <utility>

#include "signal/result.h"

namespace fude {

enum class FuseSource { gyro, accel, mag, pose, position, range, contact, opt_pose, opt_position };

inline constexpr std::array<std::pair<std::string_view, FuseSource>, 9> fuse_source_names{{
    {"gyro", FuseSource::gyro},
    {"accel", FuseSource::accel},
    {"mag", FuseSource::mag},
    {"pose", FuseSource::pose},
    {"position", FuseSource::position},
    {"range", FuseSource::range},
    {"contact", FuseSource::contact},
    {"opt_pose", FuseSource::opt_pose},
    {"opt_position", FuseSource::opt_position},
}};

// From "imu,pose": names with a comma between them; imu stands for gyro, accel and mag. Errors: usage.
Result<std::set<FuseSource>> fuse_sources(std::string_view names);

// The truth of an inertial recording, which is used only where it is named.
constexpr bool is_truth(FuseSource source) {
  return source == FuseSource::opt_pose || source == FuseSource::opt_position;
}

// Whether it says where the brush is, not only how it turns.
constexpr bool says_where(FuseSource source) { return source >= FuseSource::pose; }

}  // namespace fude
