// The fused pose of a rig as its samples come: the first tool of the first tracker, helped by the first
// inertial unit.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>

#include "calibration/fusion/fusion.h"
#include "signal/pose_sample.h"
#include "signal/sample.h"

namespace fude {

class LiveFusion {
 public:
  // `up`: in the tracker's frame.
  explicit LiveFusion(const Eigen::Vector3d& up) : up_(up) {}

  // The pose at this sample: of an inertial one, or of the tracker where there is no inertial unit; none for
  // samples of other devices. Not valid while the fusion is lost; `predicted` where only the inertial unit
  // has carried it for a while. It is of the tracker's tool, named "fused", with its covariance.
  std::optional<PoseSample> add(std::size_t device, const Sample& sample);

 private:
  std::optional<PoseSample> pose_at(const SampleTime& time);
  bool tracked_here(std::size_t device, const std::string& part);

  Eigen::Vector3d up_;
  std::optional<Fusion> fusion_;
  std::optional<std::size_t> imu_;
  std::optional<std::pair<std::size_t, std::string>> tool_;
  std::uint64_t given_ = 0;
};

}  // namespace fude
