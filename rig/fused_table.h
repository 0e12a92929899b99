// The fused pose of a session, row by row, and its table as text.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "calibration/fusion/fusion.h"

namespace fude {

// Times as the session has them; a row for each inertial sample, or for each fix where there is none.
struct FusedRow {
  Timestamp time{};
  FusionState state = FusionState::lost;
  std::optional<Eigen::Vector3d> position_m;
  std::optional<Eigen::Quaterniond> world_from_sensor;
  Eigen::Matrix<double, 6, 1> variance = Eigen::Matrix<double, 6, 1>::Zero();  // m², rad²
};

struct FusedSession {
  std::vector<FusedRow> rows;
  FusionCounts counts;
  LatenessCounts lateness;
  std::uint64_t unplaced_pulses = 0;  // of ultrasonic emitters whose place is not known, and not used
};

// t_s,x_m,y_m,z_m,qw,qx,qy,qz,var_0,…,var_5,state; what is not known stays empty.
std::string csv_of(const FusedSession& fused);

}  // namespace fude
