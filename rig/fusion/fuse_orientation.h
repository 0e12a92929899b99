// How a sensor turned, where nothing says where it was.
#pragma once

#include <set>
#include <vector>

#include "rig/fusion/fuse_samples.h"
#include "rig/fusion/fused_table.h"

namespace fude {

// A row for each of the `samples`, all inertial. With a gyroscope alone turned from where it stood at first.
// `smooth`: from what came after each moment too.
FusedSession fuse_orientation(const std::vector<UsableSample>& samples, const std::set<FuseSource>& use,
                              bool smooth);

}  // namespace fude
