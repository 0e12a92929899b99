#include "rig/fusion/live_fusion.h"

#include <variant>

#include "rig/fusion/fix_of.h"
#include "rig/fusion/fused_table.h"

namespace fude {
namespace {

constexpr Duration longest_silence = std::chrono::seconds(1);

}  // namespace

bool LiveFusion::hears(std::optional<Heard>& known, std::size_t device, const std::string& part,
                       Timestamp time, bool valid) {
  if (!known && valid) known = Heard{device, part, time};
  if (!known || known->part != part) return false;
  if (known->device != device && valid && time - known->last > longest_silence) known->device = device;
  if (known->device != device) return false;
  known->last = time;
  return valid;
}

std::optional<PoseSample> LiveFusion::add(std::size_t device, const Sample& sample) {
  if (const auto* imu = std::get_if<ImuSample>(&sample)) {
    const bool first = !imu_;
    if (!hears(imu_, device, "", imu->time.host, imu->valid)) return std::nullopt;
    // With the unit the fusion is another one; it begins at its first sample.
    if (first) fusion_.emplace(fusion_settings({.up = up_, .inertial = true, .tracker = true}));
    fusion_->add(InertialReading{imu->turn_rate_radps, imu->specific_force_mps2, std::nullopt},
                 imu->time.host);
    return pose_at(imu->time);
  }
  const auto fix = [&](const auto& seen, const std::string& part) -> std::optional<PoseSample> {
    if (!hears(tool_, device, part, seen.time.host, seen.valid)) return std::nullopt;
    if (!fusion_) fusion_.emplace(fusion_settings({.up = up_, .tracker = true}));
    fusion_->add(fix_of(seen), seen.time.host);
    const bool carried = imu_ && seen.time.host - imu_->last <= longest_silence;
    return carried ? std::nullopt : pose_at(seen.time);
  };
  if (const auto* pose = std::get_if<PoseSample>(&sample)) return fix(*pose, pose->tool);
  if (const auto* position = std::get_if<PositionSample>(&sample)) return fix(*position, position->marker);
  return std::nullopt;
}

std::optional<PoseSample> LiveFusion::pose_at(const SampleTime& time) {
  const FusedPose now = fusion_->pose();
  const FusedPose fused = ahead_ > Duration::zero() ? fusion_->predicted(now.time + ahead_) : now;
  PoseSample pose = sample_of(row_of(fused, fused.time), "fused", given_++);
  pose.time.stamped_by = time.stamped_by;
  return pose;
}

}  // namespace fude
