// What a calibration hears of a session: the poses of a tool, as they are or as seen from another
// tool; the readings of an inertial unit.
#pragma once

#include <string>
#include <vector>

#include "capture/session.h"
#include "signal/imu_sample.h"
#include "signal/pose_sample.h"
#include "signal/result.h"

namespace fude {

// In the order of arrival. Without a name: of the only tool, or of the only one beside `reference`.
// With `reference`: in that tool's frame, which then stands for the tracker's; where the reference was not
// seen at that time or near it on both sides, the pose is not valid.
// Errors: not_found, naming the tools that are there.
Result<std::vector<PoseSample>> tool_poses(const Session& session, const std::string& tool,
                                           const std::string& reference);

// Of the stream of that name, or, without one, of the only inertial unit. Errors: not_found.
Result<std::vector<ImuSample>> imu_samples(const Session& session, const std::string& unit);

}  // namespace fude
