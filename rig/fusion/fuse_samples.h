// The samples of a session that a fusion can use, each under the source that it belongs to.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "calibration/fusion/fix.h"
#include "calibration/fusion/orientation_filter.h"
#include "capture/session.h"
#include "rig/fusion/fuse_calibration.h"
#include "rig/fusion/fuse_sources.h"

namespace fude {

struct UsableSample {
  Timestamp time{};     // with its stream's delay
  Timestamp stamped{};  // as the session has it
  std::variant<ImuSample, Fix> what;
};

// What is used of an inertial sample that was put right.
InertialReading reading_of(const ImuSample& imu, const std::set<FuseSource>& use);

// The first inertial unit, the first tool of the first tracker, and the first of the truth; in the world: the
// paper where one is calibrated, else the tracker's frame. What an earlier fusion said is no source.
class UsableSamples {
 public:
  UsableSamples(const Session& session, const FuseCalibration& calibration);

  bool has(FuseSource source) const { return found_.contains(source); }
  // Of a tracker whose distortion is mapped elsewhere only.
  std::uint64_t unmapped_poses() const { return unmapped_poses_; }
  std::uint64_t unplaced_pulses() const { return unplaced_pulses_; }

  // In their order in the session.
  std::vector<UsableSample> of(const std::set<FuseSource>& use) const;

 private:
  struct Times {
    Timestamp time{}, stamped{};
  };
  void keep(FuseSource source, const Times& times, const Fix& fix);
  void take(DeviceNumber device, const PenSample& sample);
  void take(DeviceNumber device, const ImuSample& sample);
  void take(DeviceNumber device, const PoseSample& sample);
  void take(DeviceNumber device, const PositionSample& sample);
  void take(DeviceNumber device, const RangeSample& sample);
  template <class Other>
  void take(DeviceNumber, const Other&) {}
  Times times_of(DeviceNumber device, const std::string& part, const SampleTime& time) const;
  void straighten(PoseFix& pose);  // of a tracker whose distortion is mapped
  bool mine(DeviceNumber device, const std::string& part);

  const FuseCalibration& calibration_;
  std::map<DeviceNumber, bool> truth_;
  std::array<std::optional<std::pair<DeviceNumber, std::string>>, 2> tool_;
  std::optional<DeviceNumber> imu_;
  std::set<FuseSource> found_;
  std::uint64_t unplaced_pulses_ = 0, unmapped_poses_ = 0;
  std::vector<std::pair<std::optional<FuseSource>, UsableSample>> samples_;  // none: inertial
};

}  // namespace fude
