#include "signal/pose_history.h"

#include <algorithm>

#include "signal/elementary.h"

namespace fude {
namespace {

Pose<Tracker, Tool> between(const PoseSample& a, const PoseSample& b, Timestamp time) {
  const double share = seconds(time - a.time.host) / seconds(b.time.host - a.time.host);
  const Pose<Tracker, Tool>& from = a.tracker_from_tool;
  const Pose<Tracker, Tool>& to = b.tracker_from_tool;
  return {slerp(from.rotation, to.rotation, share),
          from.translation + share * (to.translation - from.translation)};
}

}  // namespace

Eigen::Quaterniond slerp(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b, double share) {
  const Eigen::Quaterniond turn = a.conjugate() * b;
  const double side = turn.w() < 0 ? -1 : 1;  // q and −q are one rotation: the shorter way
  const double sine = elementary::square_root(turn.vec().squaredNorm());
  if (!(sine > 1e-12)) return a;
  const double half_angle = elementary::arctangent(sine, side * turn.w());
  const elementary::SineCosine part = elementary::sine_cosine(share * half_angle);
  const Eigen::Vector3d axis = (side / sine) * turn.vec();
  Eigen::Quaterniond step;
  step.w() = part.cosine;
  step.vec() = part.sine * axis;
  return a * step;
}

bool PoseHistory::add(const PoseSample& sample) {
  if (!samples_.empty() && sample.time.host <= samples_.back().time.host) return false;
  samples_.push_back(sample);
  if (samples_.size() > limits_.samples) samples_.pop_front();
  return true;
}

bool PoseHistory::joined(const PoseSample& a, const PoseSample& b) const {
  return a.valid && b.valid && !b.after_gap && b.time.host - a.time.host <= limits_.longest_span;
}

PoseAnswer PoseHistory::at(Timestamp time) const {
  const auto after = std::lower_bound(samples_.begin(), samples_.end(), time,
                                      [](const PoseSample& s, Timestamp t) { return s.time.host < t; });
  if (after != samples_.end()) {
    if (after->time.host == time)
      return after->valid ? PoseAnswer{PoseOrigin::measured, after->tracker_from_tool} : PoseAnswer{};
    if (after == samples_.begin() || !joined(*(after - 1), *after)) return {};
    return {PoseOrigin::interpolated, between(*(after - 1), *after, time)};
  }
  if (samples_.size() < 2 || time - samples_.back().time.host > limits_.longest_prediction) return {};
  const PoseSample& last = samples_.back();
  const PoseSample& before = samples_[samples_.size() - 2];
  if (!joined(before, last)) return {};
  return {PoseOrigin::predicted, between(before, last, time)};
}

}  // namespace fude
