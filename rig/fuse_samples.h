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
#include "rig/fuse_geometry.h"
#include "rig/fuse_sources.h"

namespace fude {

struct UsableSample {
  Timestamp time{};
  std::variant<ImuSample, Fix> what;
};

// What is used of an inertial sample.
InertialReading reading_of(const ImuSample& imu, const std::set<FuseSource>& use);

// The first inertial unit, the first tool of the first tracker, and the first of the truth.
class UsableSamples {
 public:
  UsableSamples(const Session& session, const FuseGeometry& geometry);

  bool has(FuseSource source) const { return found_.contains(source); }
  std::uint64_t unplaced_pulses() const { return unplaced_pulses_; }

  // In their order in the session.
  std::vector<UsableSample> of(const std::set<FuseSource>& use) const;

 private:
  void keep(FuseSource source, Timestamp time, const Fix& fix);
  void take(DeviceNumber device, const ImuSample& sample);
  void take(DeviceNumber device, const PoseSample& sample);
  void take(DeviceNumber device, const PositionSample& sample);
  void take(DeviceNumber device, const RangeSample& sample);
  template <class Other>
  void take(DeviceNumber, const Other&) {}
  bool mine(DeviceNumber device, const std::string& part);

  const FuseGeometry& geometry_;
  std::map<DeviceNumber, bool> truth_;
  std::array<std::optional<std::pair<DeviceNumber, std::string>>, 2> tool_;
  std::optional<DeviceNumber> imu_;
  std::set<FuseSource> found_;
  std::uint64_t unplaced_pulses_ = 0;
  std::vector<std::pair<std::optional<FuseSource>, UsableSample>> samples_;  // none: inertial
};

}  // namespace fude
