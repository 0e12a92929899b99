#include "rig/fusion/fuse_session.h"

#include <algorithm>
#include <optional>
#include <span>
#include <utility>
#include <variant>

#include "calibration/fusion/smoother.h"
#include "rig/fusion/fix_of.h"
#include "rig/fusion/fuse_calibration.h"
#include "rig/fusion/fuse_orientation.h"
#include "rig/fusion/fuse_samples.h"
#include "rig/fusion/up_from_gravity.h"

namespace fude {
namespace {

constexpr Duration usual_memory = std::chrono::milliseconds(300);

bool tracked(const UsableSample& sample) {
  const auto* fix = std::get_if<Fix>(&sample.what);
  return fix != nullptr && (std::holds_alternative<PoseFix>(*fix) || std::holds_alternative<PointFix>(*fix));
}

// Up in the world, and where it is from.
std::pair<Eigen::Vector3d, std::string> up_of(const std::vector<UsableSample>& samples, const FuseWish& wish,
                                              const FuseCalibration& calibration, bool earth) {
  if (earth) return {Eigen::Vector3d::UnitZ(), ""};
  const auto turned = [&](const Eigen::Vector3d& up) -> Eigen::Vector3d {
    return calibration.paper_from_tracker ? calibration.paper_from_tracker->rotation * up : up;
  };
  if (wish.up) return {turned(wish.up->normalized()), ""};
  if (const auto up = up_from_gravity(samples)) return {*up, "up is where gravity has it"};
  return {turned(Eigen::Vector3d::UnitZ()), "up is taken for the tracker's z; say otherwise with --up"};
}

// What was fused from one beginning to the next: where all clocks step back, the fusion begins again.
struct Run {
  std::size_t first_row = 0;
  std::vector<FusionInput> inputs;
};

// Without a place there is nothing to smooth towards, so rows that the smoother leaves out stay causal.
void take_smoothed(std::span<FusedRow> rows, std::span<const std::optional<Timestamp>> times,
                   std::vector<FusionInput> inputs, const FusionSettings& settings) {
  std::stable_sort(inputs.begin(), inputs.end(),
                   [](const FusionInput& a, const FusionInput& b) { return a.time < b.time; });
  const std::vector<FusedPose> smoothed = smooth(inputs, settings);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!times[i]) continue;
    const auto pose = std::lower_bound(smoothed.begin(), smoothed.end(), *times[i],
                                       [](const FusedPose& p, Timestamp time) { return p.time < time; });
    if (pose != smoothed.end() && pose->time == *times[i]) rows[i] = row_of(*pose, rows[i].time);
  }
}

FusedSession fuse(const std::vector<UsableSample>& samples, const std::set<FuseSource>& use, bool inertial,
                  const FuseWish& wish, const FuseCalibration& calibration) {
  FusedSession fused;
  // Where north lies in a tracker's frame nobody knows; the truth's frame is earth.
  const bool earth = std::any_of(use.begin(), use.end(), is_truth) && !calibration.paper_from_tracker;
  const auto [up, told] = up_of(samples, wish, calibration, earth);
  if (inertial && !told.empty()) fused.notes.push_back(told);
  const FusionSettings settings =
      fusion_settings({.up = up,
                       .inertial = inertial,
                       .tracker = std::any_of(samples.begin(), samples.end(), tracked),
                       .tracker_in_time = !calibration.delays.empty(),
                       .north_is_y = earth && use.contains(FuseSource::mag)});
  Fusion fusion(settings, usual_memory + calibration.longest_delay());
  std::vector<Run> runs(1);
  std::vector<std::optional<Timestamp>>
      times;  // of the rows, on the clock of all; none: the sample was dropped
  for (const UsableSample& sample : samples) {
    const std::uint64_t restarts = fusion.lateness().restarts;
    const auto* imu = std::get_if<ImuSample>(&sample.what);
    bool taken = false;
    std::variant<InertialReading, Fix> what;
    if (imu != nullptr) {
      const InertialReading reading = reading_of(*imu, use);
      taken = imu->valid && fusion.add(reading, sample.time);
      what = reading;
    } else {
      const Fix& fix = std::get<Fix>(sample.what);
      taken = fusion.add(fix, sample.time).outcome != FixOutcome::too_late;
      what = fix;
    }
    if (fusion.lateness().restarts > restarts) runs.push_back({fused.rows.size(), {}});
    const Timestamp time = sample.time + fusion.last_shift();
    if (taken && wish.smooth) runs.back().inputs.push_back({time, what});
    if (inertial && imu == nullptr) continue;
    fused.rows.push_back(row_of(fusion.pose(), sample.stamped));
    times.push_back(taken ? std::optional(time) : std::nullopt);
  }
  fused.counts = fusion.counts();
  fused.lateness = fusion.lateness();
  if (!wish.smooth) return fused;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const std::size_t first = runs[i].first_row;
    const std::size_t rows = (i + 1 < runs.size() ? runs[i + 1].first_row : fused.rows.size()) - first;
    take_smoothed(std::span(fused.rows).subspan(first, rows), std::span(times).subspan(first, rows),
                  std::move(runs[i].inputs), settings);
  }
  return fused;
}

}  // namespace

Result<FusedSession> fuse_session(const Session& session, const FuseWish& wish) {
  const auto calibration = fuse_calibration(session, wish.calibrations);
  if (!calibration) return tl::unexpected(calibration.error());
  const UsableSamples usable(session, *calibration);
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
  FusedSession fused =
      placed ? fuse(samples, use, gyro, wish, *calibration) : fuse_orientation(samples, use, wish.smooth);
  fused.notes.insert(fused.notes.begin(), calibration->notes.begin(), calibration->notes.end());
  fused.unplaced_pulses = usable.unplaced_pulses();
  fused.unmapped_poses = usable.unmapped_poses();
  return fused;
}

}  // namespace fude
