// The fused pose of a rig as its samples come: the first tool of the first tracker, helped by the first
// inertial unit.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>

#include "calibration/fusion/fusion.h"
#include "signal/pose_sample.h"
#include "signal/sample.h"

namespace fude {

class LiveFusion {
 public:
  // `up`: in the tracker's frame. `ahead`: poses are of so much later, at most Fusion::longest_prediction;
  // for a display.
  explicit LiveFusion(const Eigen::Vector3d& up, Duration ahead = {}) : up_(up), ahead_(ahead) {}

  // The pose at this sample: of an inertial one, or of the tracker while no inertial unit speaks; none for
  // samples of other devices. Not valid while the fusion is lost; `predicted` where only the inertial unit
  // has carried it for a while, and where it is of a time ahead. It is of the tracker's tool, named "fused",
  // with its covariance. A unit, or a tool of the same name, that is silent for a second may come back as
  // another device.
  std::optional<PoseSample> add(std::size_t device, const Sample& sample);

 private:
  std::optional<PoseSample> pose_at(const SampleTime& time);

  struct Heard {
    std::size_t device = 0;
    std::string part;
    Timestamp last{};
  };
  // Whether a sample of that source counts; one that is not valid says that its device is still there.
  static bool hears(std::optional<Heard>& known, std::size_t device, const std::string& part, Timestamp time,
                    bool valid);

  Eigen::Vector3d up_;
  Duration ahead_;
  std::optional<Fusion> fusion_;
  std::optional<Heard> imu_, tool_;
  std::uint64_t given_ = 0;
};

}  // namespace fude
