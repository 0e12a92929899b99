// Which way is up in the world of a tracker, by the inertial unit on its tool.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "rig/fusion/fuse_samples.h"

namespace fude {

// Unit length: the mean, over all samples, of the specific force turned into the world by the pose seen last
// (at most 50 ms ago), in which a hand's accelerations cancel. None where fewer than 100 readings have a pose
// beside them, or where the turned forces do not agree on one direction, as when the unit's axes are not the
// tool's.
std::optional<Eigen::Vector3d> up_from_gravity(const std::vector<UsableSample>& samples);

}  // namespace fude
