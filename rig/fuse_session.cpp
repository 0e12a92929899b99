#include "rig/fuse_session.h"

#include <algorithm>

#include "calibration/fusion/smoother.h"
#include "rig/fix_of.h"
#include "rig/fuse_geometry.h"
#include "rig/fuse_orientation.h"
#include "rig/fuse_samples.h"

namespace fude {
namespace {

FusedRow row_of(const FusedPose& pose, Timestamp time) {
  FusedRow row{.time = time, .state = pose.state, .world_from_sensor = pose.world_from_sensor};
  if (pose.state != FusionState::lost) row.position_m = pose.point_m;
  row.variance = pose.covariance.diagonal();
  return row;
}

FusedSession fuse(const std::vector<UsableSample>& samples, const std::set<FuseSource>& use, bool inertial,
                  const FuseWish& wish) {
  FusedSession fused;
  // Where north lies in a tracker's frame nobody knows; the truth's frame is earth.
  const bool earth = std::any_of(use.begin(), use.end(), is_truth);
  const FusionSettings settings = fusion_settings(wish.up, inertial, earth && use.contains(FuseSource::mag));
  Fusion fusion(settings);
  std::vector<FusionInput> inputs;
  for (const UsableSample& sample : samples) {
    if (const auto* imu = std::get_if<ImuSample>(&sample.what)) {
      const InertialReading reading = reading_of(*imu, use);
      if (imu->valid) {
        fusion.add(reading, sample.time);
        if (wish.smooth) inputs.push_back({sample.time, reading});
      }
    } else {
      fusion.add(std::get<Fix>(sample.what), sample.time);
      if (wish.smooth) inputs.push_back({sample.time, std::get<Fix>(sample.what)});
      if (inertial) continue;
    }
    fused.rows.push_back(row_of(fusion.pose(), sample.time));
  }
  fused.counts = fusion.counts();
  fused.lateness = fusion.lateness();
  if (!wish.smooth) return fused;
  std::stable_sort(inputs.begin(), inputs.end(),
                   [](const FusionInput& a, const FusionInput& b) { return a.time < b.time; });
  const std::vector<FusedPose> smoothed = smooth(inputs, settings);
  std::size_t next = 0;
  for (FusedRow& row : fused.rows) {
    while (next < smoothed.size() && smoothed[next].time < row.time) ++next;
    if (next < smoothed.size() && smoothed[next].time == row.time) row = row_of(smoothed[next], row.time);
  }
  return fused;
}

}  // namespace

Result<FusedSession> fuse_session(const Session& session, const FuseWish& wish) {
  const auto geometry = fuse_geometry(session);
  if (!geometry) return tl::unexpected(geometry.error());
  const UsableSamples usable(session, *geometry);
  std::set<FuseSource> use;
  for (const auto& [name, source] : fuse_source_names) {
    const bool named = wish.use && wish.use->contains(source);
    if (named && !usable.has(source) && source != FuseSource::mag)
      return failure(Fault::usage,
                     "the session holds no " + std::string(name) +
                         " that could be used; see `fude info`, and docs/fusion.md for what each needs");
    if (usable.has(source) && (wish.use ? named : !is_truth(source))) use.insert(source);
  }
  // A pose says the position too.
  if (use.contains(FuseSource::pose)) use.erase(FuseSource::position);
  if (use.contains(FuseSource::opt_pose)) use.erase(FuseSource::opt_position);
  if (use.empty())
    return failure(Fault::not_found, "the session holds no inertial samples, poses or positions to fuse");
  const bool placed = std::any_of(use.begin(), use.end(), says_where);
  const bool gyro = use.contains(FuseSource::gyro), accel = use.contains(FuseSource::accel);
  if (use.contains(FuseSource::mag) && !accel)
    return failure(Fault::usage, "mag needs accel beside it, which says what is level");
  if (placed && gyro != accel)
    return failure(Fault::usage, "with positions, gyro and accel are used together or not at all");
  const std::vector<UsableSample> samples = usable.of(use);
  FusedSession fused = placed ? fuse(samples, use, gyro, wish) : fuse_orientation(samples, use, wish.smooth);
  fused.unplaced_pulses = usable.unplaced_pulses();
  return fused;
}

}  // namespace fude
