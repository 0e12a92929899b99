#include "calibration/fusion/fusion.h"

#include <algorithm>
#include <cmath>

namespace fude {
namespace {

constexpr Duration snapshot_period = std::chrono::milliseconds(5);
constexpr int too_late_to_rejoin = 5, too_late_to_restart = 25;
constexpr Duration smallest_step_back = std::chrono::milliseconds(50);  // less is disorder

// A correction flows in at this speed, faster where there is much of it, but of what may stand between two
// sources no more with one sample than nobody sees.
constexpr double flow_speed_mps = 0.06, flow_time_s = 0.025;
constexpr double between_sources_m = 4e-3, unseen_m = 2e-4;
constexpr double dense_s = 0.01;         // rows further apart are steps anyway
constexpr double longest_flow_m = 0.02;  // more than that is no correction but another place

}  // namespace

Fusion::Fusion(const FusionSettings& settings, Duration kept)
    : settings_(settings), kept_(kept), now_(settings) {}

// The time among the samples of all sources; none: too late. Several samples in a row from long ago: the
// source's clock has begun again. One that is honestly late all the time never steps back.
std::optional<Timestamp> Fusion::on_one_clock(Source& source, Timestamp stamped) {
  const Timestamp before = source.last.value_or(stamped);
  source.last = stamped;
  const auto delay = [&] { return now_.started() ? now_.time() - stamped - source.shift : Duration{}; };
  if (std::chrono::abs(delay() + source.shift) <= kept_) source.shift = {};
  auto& late = source.too_late;
  if (delay() > kept_) {
    if (late.samples++ == 0) {
      late.stepped_back = before - stamped > smallest_step_back;
      late.taken_before = taken_;
    }
    late.delays += delay();
    const bool others_go_on = taken_ > late.taken_before;
    if (others_go_on && late.stepped_back && late.samples >= too_late_to_rejoin) {
      ++lateness_.rejoined;
      source.shift += late.delays / late.samples - source.usual_delay;
    } else if (!others_go_on && late.samples >= too_late_to_restart) {
      restart();
    } else {
      ++lateness_.too_late;
      return std::nullopt;
    }
  }
  late = {};
  ++taken_;
  if (std::chrono::abs(delay()) <= kept_) source.usual_delay += (delay() - source.usual_delay) / 16;
  last_shift_ = source.shift;
  return stamped + source.shift;
}

void Fusion::restart() {
  ++lateness_.restarts;
  events_.clear();
  snapshots_.clear();
  forgotten_ = 0;
  withheld_m_.setZero();
  now_.begin_again();
}

bool Fusion::leaps(Timestamp time) {
  if (!now_.started() || leap_watch_.believes(now_.time(), time)) return false;
  ++lateness_.leaps;
  return true;
}

FixResult Fusion::take(const Event& event, bool& fresh) {
  if (const auto* reading = std::get_if<InertialReading>(&event.what)) {
    fresh = now_.take(*reading, event.time);
    if (const auto attitude = now_.attitude_due()) now_.take(*attitude, event.time);
    return {};
  }
  const auto& stamped = std::get<StampedFix>(event.what);
  return now_.take(stamped.fix, event.time, stamped.assumed_lag_s);
}

FixResult Fusion::insert(Event event, bool& fresh) {
  const auto at = std::upper_bound(events_.begin(), events_.end(), event.time,
                                   [](Timestamp time, const Event& other) { return time < other.time; });
  if (at == events_.end()) {
    if (snapshots_.empty() || event.time - snapshots_.back().filter.time() >= snapshot_period)
      snapshots_.push_back({forgotten_ + events_.size(), now_});
    events_.push_back(std::move(event));
    const FixResult result = take(events_.back(), fresh);
    forget_old();
    return result;
  }
  const std::size_t index = forgotten_ + static_cast<std::size_t>(at - events_.begin());
  while (!snapshots_.empty() && snapshots_.back().events > index) snapshots_.pop_back();
  if (snapshots_.empty()) {
    fresh = false;
    ++lateness_.too_late;
    return {FixOutcome::too_late};
  }
  ++lateness_.late;
  events_.insert(at, std::move(event));
  now_ = snapshots_.back().filter;
  FixResult result;
  for (std::size_t i = snapshots_.back().events; i < forgotten_ + events_.size(); ++i) {
    const Event& again = events_[i - forgotten_];
    if (i > snapshots_.back().events && again.time - snapshots_.back().filter.time() >= snapshot_period)
      snapshots_.push_back({i, now_});
    bool taken = true;
    const FixResult outcome = take(again, taken);
    if (i == index) {
      result = outcome;
      fresh = taken;
    }
  }
  return result;
}

void Fusion::forget_old() {
  const Timestamp oldest = now_.time() - kept_;
  while (snapshots_.size() > 1 && snapshots_[1].filter.time() < oldest) snapshots_.pop_front();
  while (forgotten_ < snapshots_.front().events) {
    events_.pop_front();
    ++forgotten_;
  }
}

// What is still withheld shrinks with time; what has just been corrected joins it.
void Fusion::flow(Timestamp before, const Eigen::Vector3d& correction) {
  const double step_s = seconds(now_.time() - before), size = withheld_m_.norm();
  if (step_s > 0 && size > 0) {
    double shown = step_s * std::max(flow_speed_mps, size / flow_time_s);
    if (step_s <= dense_s) shown = std::min(shown, std::max(unseen_m, size - between_sources_m));
    withheld_m_ *= std::max(0.0, 1 - shown / size);
  }
  withheld_m_ -= correction;
  if (withheld_m_.norm() > longest_flow_m) withheld_m_.setZero();
}

bool Fusion::add(const InertialReading& reading, Timestamp stamped) {
  if (leaps(stamped)) return false;
  const std::optional<Timestamp> placed = on_one_clock(sources_[0], stamped);
  if (!placed) return false;
  const Timestamp time = *placed;
  const bool late = now_.started() && time < now_.time();
  const Timestamp before = now_.time();
  const Eigen::Vector3d old = now_.motion().tracked_point_m();
  bool fresh = true;
  insert({time, reading}, fresh);
  flow(before, late ? Eigen::Vector3d(now_.motion().tracked_point_m() - old) : Eigen::Vector3d::Zero());
  return fresh;
}

FixResult Fusion::add(const Fix& fix, Timestamp stamped) {
  const bool tracked = std::holds_alternative<PoseFix>(fix) || std::holds_alternative<PointFix>(fix);
  const double lag_s = tracked ? now_.motion().lag_s : 0;
  const auto lag = std::chrono::duration_cast<Duration>(std::chrono::duration<double>(lag_s));
  if (leaps(stamped)) return {FixOutcome::too_late};
  const std::optional<Timestamp> placed = on_one_clock(sources_[1 + fix.index()], stamped - lag);
  if (!placed) return {FixOutcome::too_late};
  const Timestamp time = *placed;
  const bool was_lost = now_.state() == FusionState::lost;
  const Timestamp before = now_.time();
  MotionFilter unfixed = now_;
  if (unfixed.started()) unfixed.move_to(std::max(time, before));
  bool fresh = true;
  const FixResult result = insert({time, StampedFix{fix, lag_s}}, fresh);
  if (was_lost) withheld_m_.setZero();
  flow(before, was_lost
                   ? Eigen::Vector3d::Zero()
                   : Eigen::Vector3d(now_.motion().tracked_point_m() - unfixed.motion().tracked_point_m()));
  return result;
}

FusedPose Fusion::pose() const { return shown(now_); }

FusedPose Fusion::predicted(Timestamp at) const {
  MotionFilter ahead = now_;
  ahead.move_to(std::min(at, now_.time() + longest_prediction));
  FusedPose pose = shown(ahead);
  if (pose.state == FusionState::ok) pose.state = FusionState::predicted;
  return pose;
}

FusedPose Fusion::shown(const MotionFilter& filter) const {
  FusedPose pose = pose_of(filter.motion(), filter.rate_radps());
  pose.time = filter.time();
  pose.state = filter.state();
  pose.placed = filter.placed();
  pose.point_m += withheld_m_;
  pose.covariance.topLeftCorner<3, 3>() += withheld_m_ * withheld_m_.transpose();
  return pose;
}

}  // namespace fude
