// The fused pose of a recorded session as a table: the session's samples handed to calibration/fusion.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "calibration/fusion/fusion.h"
#include "capture/session.h"
#include "signal/result.h"

namespace fude {

enum class FuseSource { gyro, accel, mag, pose, position, range, contact, opt_pose, opt_position };

// From "imu,pose": names with a comma between them; imu stands for gyro, accel and mag. Errors: usage.
Result<std::set<FuseSource>> fuse_sources(std::string_view names);

struct FuseWish {
  std::optional<std::set<FuseSource>> use;  // none: all that the session has, but not its optical truth
  bool smooth = false;                      // from the samples after each moment too
  Eigen::Vector3d up{0, 0, 1};              // in the frame of the tracker
};

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
};

// Earth (east, north, up) is the world where orientation alone is asked for or the truth's positions are
// used, else the tracker's frame. Ranges need receivers_m and emitter_m, contacts tip_m in a calibration that
// the session carries. Errors: usage where a source that was named is not there; not_found where nothing is.
Result<FusedSession> fuse_session(const Session& session, const FuseWish& wish);

// t_s,x_m,y_m,z_m,qw,qx,qy,qz,var_0,…,var_5,state; what is not known stays empty.
std::string csv_of(const FusedSession& fused);

}  // namespace fude
