#include "calibration/motion_pairs.h"

#include <cmath>

#include "calibration/fusion/motion_state.h"
#include "signal/pose_history.h"

namespace fude {
namespace {

constexpr std::size_t most_pairs = 3000;

Duration duration(double s) { return std::chrono::duration_cast<Duration>(std::chrono::duration<double>(s)); }

PoseHistory history_of(std::span<const PoseSample> samples) {
  PoseHistory history({.samples = samples.size() + 1});
  for (const PoseSample& sample : samples) history.add(sample);
  return history;
}

// What two histories saw at the same moments, the other's clock read `lag_s` late.
std::vector<MotionPair> pairs_of(std::span<const PoseSample> seen, std::span<const PoseSample> other,
                                 double lag_s) {
  constexpr Duration half = std::chrono::milliseconds(20);
  const PoseHistory of_seen = history_of(seen), of_other = history_of(other);
  const bool seen_is_sparse = seen.size() <= other.size();
  const std::span<const PoseSample> sparse = seen_is_sparse ? seen : other;
  const std::size_t stride = sparse.size() / most_pairs + 1;
  const Duration lag = duration(lag_s);
  std::vector<MotionPair> pairs;
  for (std::size_t i = 0; i < sparse.size(); i += stride) {
    const Timestamp time = seen_is_sparse ? sparse[i].time.host : sparse[i].time.host - lag;
    const PoseAnswer a = of_seen.at(time), b = of_other.at(time + lag);
    const PoseAnswer before = of_other.at(time + lag - half), after = of_other.at(time + lag + half);
    if (a.origin == PoseOrigin::none || b.origin == PoseOrigin::none || before.origin == PoseOrigin::none ||
        after.origin == PoseOrigin::none)
      continue;
    const double span_s = seconds(2 * half);
    const auto& [q0, t0] = before.tracker_from_tool;
    const auto& [q1, t1] = after.tracker_from_tool;
    pairs.push_back({time,
                     a.tracker_from_tool,
                     {b.tracker_from_tool.rotation, b.tracker_from_tool.translation},
                     turn_of(q0.conjugate() * q1) / span_s,
                     (t1 - t0) / span_s});
  }
  return pairs;
}

}  // namespace

PairedMotion pair_motion(std::span<const PoseSample> seen, std::span<const PoseSample> other) {
  PairedMotion f;
  // The lag is found step by step: each fit sees only the motion of a few milliseconds as straight.
  for (int round = 0; round < 12; ++round) {
    f.pairs = pairs_of(seen, other, f.lag_s);
    if (f.pairs.size() < fewest_motion_pairs) return f;
    f.robust = robust_hand_eye(f.pairs);
    const double step = f.robust.fit.lag_s;
    if (std::abs(step) < 2e-4 || std::abs(f.lag_s + step) > longest_motion_lag_s) break;
    f.lag_s += step;
  }
  f.lag_s += f.robust.fit.lag_s;
  return f;
}

}  // namespace fude
