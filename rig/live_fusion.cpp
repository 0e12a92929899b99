#include "rig/live_fusion.h"

#include <variant>

#include "rig/fix_of.h"

namespace fude {

bool LiveFusion::tracked_here(std::size_t device, const std::string& part) {
  if (!tool_) tool_.emplace(device, part);
  if (!fusion_) fusion_.emplace(fusion_settings(up_, false, false));
  return *tool_ == std::pair(device, part);
}

std::optional<PoseSample> LiveFusion::add(std::size_t device, const Sample& sample) {
  if (const auto* imu = std::get_if<ImuSample>(&sample)) {
    if (imu_.value_or(device) != device || !imu->valid) return std::nullopt;
    // With the unit the fusion is another one; it begins at its first sample.
    if (!imu_) fusion_.emplace(fusion_settings(up_, true, false));
    imu_ = device;
    fusion_->add(InertialReading{imu->turn_rate_radps, imu->specific_force_mps2, std::nullopt},
                 imu->time.host);
    return pose_at(imu->time);
  }
  const auto fix = [&](const auto& seen, const std::string& part) -> std::optional<PoseSample> {
    if (!seen.valid || !tracked_here(device, part)) return std::nullopt;
    fusion_->add(fix_of(seen), seen.time.host);
    return imu_ ? std::nullopt : pose_at(seen.time);
  };
  if (const auto* pose = std::get_if<PoseSample>(&sample)) return fix(*pose, pose->tool);
  if (const auto* position = std::get_if<PositionSample>(&sample)) return fix(*position, position->marker);
  return std::nullopt;
}

std::optional<PoseSample> LiveFusion::pose_at(const SampleTime& time) {
  const FusedPose fused = fusion_->pose();
  PoseSample pose;
  pose.time = time;
  pose.time.host = fused.time;
  pose.time.sequence = given_++;
  pose.tool = "fused";
  pose.valid = fused.placed && fused.state != FusionState::lost;
  pose.origin = !pose.valid                      ? PoseOrigin::none
                : fused.state == FusionState::ok ? PoseOrigin::measured
                                                 : PoseOrigin::predicted;
  pose.tracker_from_tool = {fused.world_from_sensor, fused.point_m};
  Eigen::Matrix<double, 6, 6>& covariance = pose.covariance.emplace();
  covariance.topLeftCorner<3, 3>() = fused.covariance.bottomRightCorner<3, 3>();
  covariance.bottomRightCorner<3, 3>() = fused.covariance.topLeftCorner<3, 3>();
  covariance.topRightCorner<3, 3>() = fused.covariance.bottomLeftCorner<3, 3>();
  covariance.bottomLeftCorner<3, 3>() = fused.covariance.topRightCorner<3, 3>();
  return pose;
}

}  // namespace fude
