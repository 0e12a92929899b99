#include "rig/fuse_samples.h"

#include <algorithm>

#include "drivers/ultrasonic/multilateration.h"
#include "rig/fix_of.h"

namespace fude {
namespace {

// A tracker that stands for the truth of an inertial recording.
bool is_truth(const DeviceDescription& device) {
  return device.kind == DeviceKind::tracker && device.id == "text:imu-csv";
}

}  // namespace

InertialReading reading_of(const ImuSample& imu, const std::set<FuseSource>& use) {
  InertialReading reading{imu.turn_rate_radps, imu.specific_force_mps2, imu.magnetic_field_ut};
  if (!use.contains(FuseSource::gyro)) reading.turn_rate_radps.setZero();
  if (!use.contains(FuseSource::mag)) reading.magnetic_field_ut.reset();
  return reading;
}

UsableSamples::UsableSamples(const Session& session, const FuseGeometry& geometry) : geometry_(geometry) {
  for (const RecordedDevice& device : session.devices) truth_[device.number] = is_truth(device.description);
  for (const RecordedSample& sample : session.samples)
    std::visit([&](const auto& s) { take(sample.device, s); }, sample.sample);
  for (const RecordedPen& pen : session.pens)
    if (pen.sample.in_contact && geometry.tip_m)
      keep(FuseSource::contact, pen.sample.time.host, ContactFix{.tip_offset_m = *geometry.tip_m});
}

std::vector<UsableSample> UsableSamples::of(const std::set<FuseSource>& use) const {
  std::vector<UsableSample> chosen;
  const bool inertial = use.contains(FuseSource::gyro) || use.contains(FuseSource::accel);
  for (const auto& [source, sample] : samples_)
    if (source ? use.contains(*source) : inertial) chosen.push_back(sample);
  return chosen;
}

void UsableSamples::keep(FuseSource source, Timestamp time, const Fix& fix) {
  found_.insert(source);
  samples_.push_back({source, {time, fix}});
}

void UsableSamples::take(DeviceNumber device, const ImuSample& sample) {
  if (imu_ && *imu_ != device) return;
  imu_ = device;
  found_.insert(FuseSource::gyro);
  found_.insert(FuseSource::accel);
  if (sample.magnetic_field_ut) found_.insert(FuseSource::mag);
  samples_.push_back({std::nullopt, {sample.time.host, sample}});
}

void UsableSamples::take(DeviceNumber device, const PoseSample& sample) {
  if (!sample.valid || !mine(device, sample.tool)) return;
  const PoseFix pose = fix_of(sample);
  const bool truth = truth_[device];
  keep(truth ? FuseSource::opt_pose : FuseSource::pose, sample.time.host, pose);
  keep(truth ? FuseSource::opt_position : FuseSource::position, sample.time.host, point_of(pose));
}

void UsableSamples::take(DeviceNumber device, const PositionSample& sample) {
  if (!sample.valid || !mine(device, sample.marker)) return;
  keep(truth_[device] ? FuseSource::opt_position : FuseSource::position, sample.time.host, fix_of(sample));
}

void UsableSamples::take(DeviceNumber, const RangeSample& sample) {
  if (geometry_.emitters_m.empty() || geometry_.receivers_m.empty()) return;
  if (sample.emitter >= geometry_.emitters_m.size()) {
    ++unplaced_pulses_;
    return;
  }
  const double speed = ultrasonic::speed_of_sound_mps(sample.temperature_c.value_or(20));
  for (std::size_t i = 0; i < std::min(geometry_.receivers_m.size(), sample.flight_s.size()); ++i)
    if (sample.flight_s[i])
      keep(FuseSource::range, sample.time.host,
           RangeFix{.receiver_m = geometry_.receivers_m[i],
                    .emitter_offset_m = geometry_.emitters_m[sample.emitter],
                    .distance_m = speed * *sample.flight_s[i]});
}

// One tool of one tracker is the brush, and one of the truth.
bool UsableSamples::mine(DeviceNumber device, const std::string& part) {
  auto& tool = tool_[truth_[device]];
  if (!tool) tool.emplace(device, part);
  return *tool == std::pair(device, part);
}

}  // namespace fude
