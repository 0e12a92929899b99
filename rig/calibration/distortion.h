// How iron bends what a magnetic tracker says, from a session in which a second tracker saw the same motion,
// or the points of a known grid were touched (calibration/distortion.h).
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "rig/calibration/calibrator.h"
#include "rig/calibration/known_calibrations.h"

namespace fude {

struct DistortionWish {
  std::string tool;                           // of the magnetic tracker; empty: the only one beside `other`
  std::string other;                          // of the tracker that no iron disturbs; or
  std::optional<std::filesystem::path> grid;  // the list of points that were touched in its order
  std::optional<Eigen::Vector3d> tip_m;       // that touched them, instead of a pivot that is known
};

// Errors: usage where there is neither another tool nor a grid, or both; those of reading the list. hear()
// also has the errors of tip_of.
Result<std::unique_ptr<Calibrator>> distortion_calibrator(DistortionWish wish, KnownCalibrations known);

}  // namespace fude
