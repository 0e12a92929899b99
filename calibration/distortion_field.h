// How iron and currents near a magnetic tracker bend what it says, as a smooth field through the mapped
// volume, and poses put right by it.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "calibration/report.h"
#include "calibration/smooth_field.h"
#include "signal/pose.h"
#include "signal/pose_sample.h"

namespace fude {

struct DistortionField {
  SmoothField shift_m;                  // to be added to a measured place; Tracker
  std::optional<SmoothField> turn_rad;  // to be put before a measured rotation, about Tracker's axes
  double reach_m = 0;                   // as far from a mapped place the field holds
};

struct CorrectedPose {
  Pose<Tracker, Tool> tracker_from_tool;
  bool mapped = true;  // false: farther than reach_m from every mapped place, where the field is a guess
};

// Beyond its reach the field is taken from where its reach ends, so that nothing runs away.
CorrectedPose corrected(const DistortionField& field, const Pose<Tracker, Tool>& measured);

Fields to_fields(const DistortionField& field);
std::optional<DistortionField> distortion_from(const Fields& fields);

}  // namespace fude
