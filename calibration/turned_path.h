// A gyroscope's turn rates added up: how far it turned from any time to any other.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <span>
#include <vector>

#include "signal/imu_sample.h"

namespace fude {

struct MeasuredTurn {
  Eigen::Quaterniond rotation;  // of the sensor's axes at the end, in those at the start
  Eigen::Matrix3d by_bias;      // what a change of the offset subtracts from it, in its end's axes
  Eigen::Vector3d rate_before, rate_after;  // at the start and the end, rad/s, offset taken off
};

class TurnedPath {
 public:
  // Readings in the order of time; those that are not valid, or no numbers, part it as a gap does, as does a
  // silence of five times the usual step. Rates change evenly in between.
  TurnedPath(std::span<const ImuSample> readings, const Eigen::Vector3d& bias_radps);

  // None where a gap lies between, or it ended before.
  std::optional<MeasuredTurn> between(Timestamp from, Timestamp to) const;

  // All that it turned, to and fro, and in how much time.
  double turned_rad() const { return turned_rad_; }
  double lasted_s() const { return lasted_s_; }

 private:
  struct Point {
    Timestamp time;
    Eigen::Vector3d rate_radps;
    Eigen::Quaterniond rotation;
    Eigen::Matrix3d sum;  // of the rotations so far, times the time
    int run = 0;
  };
  std::optional<Point> at(Timestamp time) const;

  std::vector<Point> points_;
  double turned_rad_ = 0, lasted_s_ = 0;
};

}  // namespace fude
