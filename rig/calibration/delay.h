// The time between two streams, from a session in which both see the brush (calibration/delay/delay.h).
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "rig/calibration/calibrator.h"
#include "rig/calibration/known_calibrations.h"
#include "signal/result.h"

namespace fude {

struct DelayWish {
  std::string a, b;                      // streams, as StreamWish names them; offset_s is added to b's times
  std::optional<Eigen::Vector3d> tip_m;  // instead of a pivot that is known
};

// Of "A,B", or of two names on their own where a name has a comma in it. Errors: usage.
Result<DelayWish> delay_wish(const std::vector<std::string>& streams);

// Takes the tip of the pivot and the surface that are known for a tracker's tool, where they are.
std::unique_ptr<Calibrator> delay_calibrator(DelayWish wish, KnownCalibrations known);

}  // namespace fude
