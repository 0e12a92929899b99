// The calibrations that a fusion applies: those that a session carries and those that were named for it.
#pragma once

#include <Eigen/Geometry>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "calibration/distortion_field.h"
#include "calibration/imu.h"
#include "calibration/surface.h"
#include "capture/session.h"
#include "rig/fusion/fuse_geometry.h"
#include "signal/result.h"

namespace fude {

// Added to a stream's times: offset_s at reference_s, and `drift` seconds more in each second after it.
struct StreamDelay {
  double offset_s = 0;
  double drift = 0;
  double reference_s = 0;
};

struct FuseCalibration {
  FuseGeometry geometry;
  std::optional<ImuCalibration> imu;
  std::optional<Eigen::Quaterniond> tool_from_sensor;  // the inertial unit's axes onto the tool's
  std::map<std::pair<DeviceNumber, std::string>, StreamDelay> delays;  // by device and tool
  std::optional<DistortionField> distortion;                           // of a magnetic tracker
  std::optional<Pose<Paper, Tracker>> paper_from_tracker;              // metres on both sides
  std::shared_ptr<const SmoothField> sheet;                            // over the paper's plane, mm

  // From the tracker's frame into the world, which is the paper where one is calibrated.
  Eigen::Vector3d in_world(const Eigen::Vector3d& tracker_m) const {
    return paper_from_tracker ? *paper_from_tracker * tracker_m : tracker_m;
  }

  // What was applied and what was not, a sentence each.
  std::vector<std::string> notes;

  Duration delay_of(DeviceNumber device, const std::string& part, Timestamp time) const;
  Duration longest_delay() const;
};

// Where two say the same, the later one counts; `named` come after the session's own. One that was made with
// a device that this session does not have (another serial), of another tool or with a reference is left out,
// and the drift of a delay counts in its own session alone; all are noted. Errors: malformed, where a text is
// no calibration or was never accepted.
Result<FuseCalibration> fuse_calibration(const Session& session,
                                         const std::vector<RecordedCalibration>& named);

// The unit's readings put right, in the tool's axes where these are known.
ImuSample put_right(const FuseCalibration& calibration, const ImuSample& sample);

}  // namespace fude
