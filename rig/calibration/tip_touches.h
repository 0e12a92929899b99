// Places touched with a calibrated tip, in their order.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "calibration/landmarks.h"
#include "calibration/touches.h"
#include "rig/calibration/known_calibrations.h"
#include "rig/calibration/tool_poses.h"

namespace fude {

struct TipWish {
  ToolWish tool;
  std::optional<Eigen::Vector3d> tip_m;  // instead of a pivot that is known
};

class TipTouches {
 public:
  // In the name of the procedure that asks for them.
  TipTouches(std::string procedure, TipWish wish, KnownCalibrations known)
      : procedure_(std::move(procedure)),
        tip_m_(wish.tip_m),
        known_(std::move(known)),
        poses_(std::move(wish.tool)) {}

  void begin(DeviceNumber device, const DeviceDescription& description) { poses_.begin(device, description); }

  // Errors: as ToolPoses::hear and tip_of.
  Result<void> hear(DeviceNumber device, const Sample& sample) { return add(poses_.hear(device, sample)); }
  // At the end. Errors: as ToolPoses::rest.
  Result<void> end() { return add(poses_.rest()); }

  // How many of the list were touched so far, looked at now and then.
  Progress towards(const std::vector<Landmark>& listed);

  struct Touch {
    Eigen::Vector3d point_m = Eigen::Vector3d::Zero();  // of the tip, in Tracker or the reference
    Pose<Tracker, Tool> tracker_from_tool;              // with which the tip is there
  };
  // Each pose, where there are just `count`; else where the tip rested.
  std::vector<Touch> touches(std::size_t count) const;

  const ToolPoses& poses() const { return poses_; }
  // Once a pose of the tool was heard.
  const std::optional<Eigen::Vector3d>& tip_m() const { return tip_m_; }

 private:
  Result<void> add(const Result<std::vector<PoseSample>>& poses);

  std::string procedure_;
  std::optional<Eigen::Vector3d> tip_m_;
  KnownCalibrations known_;
  ToolPoses poses_;
  std::vector<TipPoint> way_;
  std::vector<Eigen::Quaterniond> turned_;  // as many
  std::size_t looked_ = 0, rested_ = 0;
};

}  // namespace fude
