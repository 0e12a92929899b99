// What a session's calibrations say of where things sit on the brush and in the room, as far as fusion needs
// it.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "capture/session.h"
#include "signal/result.h"

namespace fude {

struct FuseGeometry {
  std::optional<Eigen::Vector3d> tip_m;      // in the sensor's frame
  std::vector<Eigen::Vector3d> emitters_m;   // of the ultrasonic emitters by their number, likewise
  std::vector<Eigen::Vector3d> receivers_m;  // in the world
};

// From the keys tip_m ([x, y, z]), emitter_m (such, or an array of such) and receivers_m (an array of such).
// A later one goes before. Errors: malformed.
Result<FuseGeometry> fuse_geometry(const std::vector<RecordedCalibration>& calibrations);

}  // namespace fude
