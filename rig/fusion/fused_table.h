// The fused pose of a session, row by row, its table as text, and its rows as samples of a tracker.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "calibration/fusion/fusion.h"
#include "signal/pose_sample.h"

namespace fude {

// Times as the session has them; a row for each inertial sample, or for each fix where there is none.
struct FusedRow {
  Timestamp time{};
  FusionState state = FusionState::lost;
  std::optional<Eigen::Vector3d> position_m;
  std::optional<Eigen::Quaterniond> world_from_sensor;
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();  // m², then rad²; world
};

struct FusedSession {
  std::vector<FusedRow> rows;
  FusionCounts counts;
  LatenessCounts lateness;
  std::uint64_t unplaced_pulses = 0;  // of ultrasonic emitters whose place is not known, and not used
  std::uint64_t unmapped_poses = 0;   // beyond where a tracker's distortion is mapped
  std::vector<std::string> notes;     // what was applied and what was not, a sentence each
};

FusedRow row_of(const FusedPose& pose, Timestamp stamped);

// t_s,x_m,y_m,z_m,qw,qx,qy,qz,var_0,…,var_5,state; what is not known stays empty.
std::string csv_of(const FusedSession& fused);

// Of the tool `tool`, the `sequence`-th: with covariance, and not valid where the row has no position.
PoseSample sample_of(const FusedRow& row, const std::string& tool, std::uint64_t sequence);

}  // namespace fude
