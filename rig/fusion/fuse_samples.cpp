#include "rig/fusion/fuse_samples.h"

#include <algorithm>

#include "drivers/ultrasonic/multilateration.h"
#include "rig/calibration/session_inputs.h"
#include "rig/fusion/fix_of.h"
#include "rig/fusion/keep_fused.h"

namespace fude {
namespace {

// A tracker that stands for the truth of an inertial recording.
bool is_truth(const DeviceDescription& device) {
  return device.kind == DeviceKind::tracker && device.id == "text:imu-csv";
}

// From the tracker's frame into the world.
PoseFix moved(PoseFix pose, const FuseCalibration& calibration) {
  if (!calibration.paper_from_tracker) return pose;
  const Eigen::Quaterniond& q = calibration.paper_from_tracker->rotation;
  pose.point_m = calibration.in_world(pose.point_m);
  pose.world_from_sensor = q * pose.world_from_sensor;
  Eigen::Matrix<double, 6, 6> turn = Eigen::Matrix<double, 6, 6>::Zero();
  turn.topLeftCorner<3, 3>() = turn.bottomRightCorner<3, 3>() = q.toRotationMatrix();
  pose.covariance = turn * pose.covariance * turn.transpose();
  return pose;
}

}  // namespace

InertialReading reading_of(const ImuSample& imu, const std::set<FuseSource>& use) {
  InertialReading reading{imu.turn_rate_radps, imu.specific_force_mps2, imu.magnetic_field_ut};
  if (!use.contains(FuseSource::gyro)) reading.turn_rate_radps.setZero();
  if (!use.contains(FuseSource::mag)) reading.magnetic_field_ut.reset();
  return reading;
}

UsableSamples::UsableSamples(const Session& session, const FuseCalibration& calibration)
    : calibration_(calibration) {
  std::set<DeviceNumber> fused;
  for (const RecordedDevice& device : session.devices) {
    truth_[device.number] = is_truth(device.description);
    if (device.description.id == fused_device_id) fused.insert(device.number);
  }
  const auto take_input = [&](DeviceNumber device, const Sample& sample, const Transfer*) -> Result<void> {
    if (!fused.contains(device)) std::visit([&](const auto& s) { take(device, s); }, sample);
    return {};
  };
  static_cast<void>(for_each_input(session, take_input));  // take_input has no errors
}

std::vector<UsableSample> UsableSamples::of(const std::set<FuseSource>& use) const {
  std::vector<UsableSample> chosen;
  const bool inertial = use.contains(FuseSource::gyro) || use.contains(FuseSource::accel);
  for (const auto& [source, sample] : samples_)
    if (source ? use.contains(*source) : inertial) chosen.push_back(sample);
  return chosen;
}

void UsableSamples::keep(FuseSource source, const Times& times, const Fix& fix) {
  found_.insert(source);
  samples_.push_back({source, {times.time, times.stamped, fix}});
}

UsableSamples::Times UsableSamples::times_of(DeviceNumber device, const std::string& part,
                                             const SampleTime& time) const {
  return {time.host + calibration_.delay_of(device, part, time.host), time.host};
}

void UsableSamples::take(DeviceNumber device, const PenSample& sample) {
  if (!calibration_.geometry.tip_m || !sample.in_contact) return;
  keep(FuseSource::contact, times_of(device, "", sample.time),
       ContactFix{.tip_offset_m = *calibration_.geometry.tip_m, .sheet = calibration_.sheet});
}

void UsableSamples::take(DeviceNumber device, const ImuSample& sample) {
  if (imu_ && *imu_ != device) return;
  imu_ = device;
  found_.insert(FuseSource::gyro);
  found_.insert(FuseSource::accel);
  if (sample.magnetic_field_ut) found_.insert(FuseSource::mag);
  const Times times = times_of(device, "", sample.time);
  samples_.push_back({std::nullopt, {times.time, times.stamped, put_right(calibration_, sample)}});
}

void UsableSamples::take(DeviceNumber device, const PoseSample& sample) {
  if (!sample.valid || !mine(device, sample.tool)) return;
  const bool truth = truth_[device];
  PoseFix pose = fix_of(sample);
  if (!truth) straighten(pose);
  pose = moved(pose, calibration_);
  const Times times = times_of(device, sample.tool, sample.time);
  keep(truth ? FuseSource::opt_pose : FuseSource::pose, times, pose);
  keep(truth ? FuseSource::opt_position : FuseSource::position, times, point_of(pose));
}

void UsableSamples::take(DeviceNumber device, const PositionSample& sample) {
  if (!sample.valid || !mine(device, sample.marker)) return;
  PoseFix place;
  const PointFix point = fix_of(sample);
  place.point_m = point.point_m;
  place.covariance.topLeftCorner<3, 3>() = point.covariance_m2;
  if (!truth_[device]) straighten(place);
  keep(truth_[device] ? FuseSource::opt_position : FuseSource::position,
       times_of(device, sample.marker, sample.time), point_of(moved(place, calibration_)));
}

void UsableSamples::take(DeviceNumber device, const RangeSample& sample) {
  const FuseGeometry& geometry = calibration_.geometry;
  if (geometry.emitters_m.empty() || geometry.receivers_m.empty()) return;
  if (sample.emitter >= geometry.emitters_m.size()) {
    ++unplaced_pulses_;
    return;
  }
  const double speed = ultrasonic::speed_of_sound_mps(sample.temperature_c.value_or(20));
  for (std::size_t i = 0; i < std::min(geometry.receivers_m.size(), sample.flight_s.size()); ++i)
    if (sample.flight_s[i])
      keep(FuseSource::range, times_of(device, "", sample.time),
           RangeFix{.receiver_m = calibration_.in_world(geometry.receivers_m[i]),
                    .emitter_offset_m = geometry.emitters_m[sample.emitter],
                    .distance_m = speed * *sample.flight_s[i]});
}

void UsableSamples::straighten(PoseFix& pose) {
  if (!calibration_.distortion) return;
  const CorrectedPose straight = corrected(*calibration_.distortion, {pose.world_from_sensor, pose.point_m});
  pose.world_from_sensor = straight.tracker_from_tool.rotation;
  pose.point_m = straight.tracker_from_tool.translation;
  unmapped_poses_ += !straight.mapped;
}

// One tool of one tracker is the brush, and one of the truth.
bool UsableSamples::mine(DeviceNumber device, const std::string& part) {
  auto& tool = tool_[truth_[device]];
  if (!tool) tool.emplace(device, part);
  return *tool == std::pair(device, part);
}

}  // namespace fude
