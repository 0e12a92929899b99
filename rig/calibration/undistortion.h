// Poses of a tracker whose distortion was mapped (calibration/distortion_field.h), put right before a
// calibration hears them.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "calibration/distortion_field.h"
#include "calibration/report.h"
#include "capture/session.h"
#include "rig/calibration/calibrator.h"
#include "rig/calibration/known_calibrations.h"
#include "signal/device.h"
#include "signal/pose_sample.h"
#include "signal/result.h"

namespace fude {

class Undistortion {
 public:
  // By the distortions among what is known, each for its own tracker.
  explicit Undistortion(KnownCalibrations known) : known_(std::move(known)) {}

  void begin(DeviceNumber device, const DeviceDescription& description);

  // As it is, where nothing is mapped of that tracker, and where it was not seen.
  PoseSample straight(DeviceNumber device, PoseSample sample);

  // Errors: malformed, where a person named a distortion that is of none of the trackers that were heard.
  Result<void> used() const;

  // The detail `poses_undistorted`, and a warning of those beyond where it is mapped; nothing where nothing
  // was put right.
  void describe(CalibrationReport& report) const;

 private:
  const DistortionField* field_of(DeviceNumber device, const std::string& tool);

  KnownCalibrations known_;
  std::map<DeviceNumber, DeviceDescription> devices_;
  std::map<std::pair<DeviceNumber, std::string>, std::optional<DistortionField>> fields_;
  std::optional<Error> of_another_;
  std::size_t straightened_ = 0, unmapped_ = 0;
};

// The poses of a session that is heard beside another, in their order and put right. Errors: of `hear`.
Result<void> for_each_straight_pose(const Session& session, const KnownCalibrations& known,
                                    const std::function<Result<void>(DeviceNumber, const PoseSample&)>& hear);

// Hears what `calibrator` does, with the poses put right. Its finish() also has the errors of used().
std::unique_ptr<Calibrator> undistorted(std::unique_ptr<Calibrator> calibrator, KnownCalibrations known);

}  // namespace fude
