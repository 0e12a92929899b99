// After the fact: the best estimate of a recording from all of its samples, those after each moment too. For
// the archive, beside the causal one; nothing live waits for it.
#pragma once

#include <variant>
#include <vector>

#include "calibration/fusion/fusion.h"

namespace fude {

struct FusionInput {
  Timestamp time{};
  std::variant<InertialReading, Fix> what;
};

// One pose for each inertial sample that could be used, or where there are none for each fix. `inputs` in the
// order of their time. Rauch, Tung and Striebel's smoother over the error state, in pieces of 20 s that
// overlap, so that memory stays bounded.
std::vector<FusedPose> smooth(const std::vector<FusionInput>& inputs, const FusionSettings& settings);

struct OrientationInput {
  Timestamp time{};
  InertialReading reading;
};

// Orientation alone: the inclination is the middle between the filter run forwards and run backwards in time,
// the heading that of the forward run.
std::vector<Eigen::Quaterniond> smooth_orientation(const std::vector<OrientationInput>& inputs,
                                                   const OrientationSettings& settings);

}  // namespace fude
