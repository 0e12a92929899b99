#include "calibration/turned_path.h"

#include <algorithm>

#include "calibration/fusion/motion_state.h"

namespace fude {
namespace {

Duration usual_step(std::span<const ImuSample> readings) {
  std::vector<Duration> steps;
  for (std::size_t i = 1; i < readings.size(); ++i)
    steps.push_back(readings[i].time.host - readings[i - 1].time.host);
  if (steps.empty()) return Duration::zero();
  const auto middle = steps.begin() + std::ptrdiff_t(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

bool sound(const ImuSample& reading) { return reading.valid && reading.turn_rate_radps.allFinite(); }

}  // namespace

TurnedPath::TurnedPath(std::span<const ImuSample> readings, const Eigen::Vector3d& bias_radps) {
  const Duration longest = 5 * usual_step(readings);
  int run = 0;
  bool parted = true;
  for (const ImuSample& reading : readings) {
    if (!sound(reading)) {
      parted = true;
      continue;
    }
    const Timestamp time = reading.time.host;
    if (!points_.empty() && time <= points_.back().time) continue;
    const Eigen::Vector3d rate = reading.turn_rate_radps - bias_radps;
    if (parted || reading.after_gap || time - points_.back().time > longest) {
      points_.push_back({time, rate, Eigen::Quaterniond::Identity(), Eigen::Matrix3d::Zero(), ++run});
      parted = false;
      continue;
    }
    const Point& last = points_.back();
    const double step_s = seconds(time - last.time);
    const Eigen::Vector3d turn = 0.5 * step_s * (last.rate_radps + rate);
    turned_rad_ += turn.norm();
    lasted_s_ += step_s;
    const Eigen::Quaterniond middle = last.rotation * rotation_of(turn / 2);
    points_.push_back({time, rate, (last.rotation * rotation_of(turn)).normalized(),
                       last.sum + step_s * middle.toRotationMatrix(), run});
  }
}

std::optional<TurnedPath::Point> TurnedPath::at(Timestamp time) const {
  const auto after = std::lower_bound(points_.begin(), points_.end(), time,
                                      [](const Point& p, Timestamp t) { return p.time < t; });
  if (after == points_.end()) return std::nullopt;
  if (after->time == time) return *after;
  if (after == points_.begin() || (after - 1)->run != after->run) return std::nullopt;
  const Point& before = *(after - 1);
  const double part_s = seconds(time - before.time);
  const double share = part_s / seconds(after->time - before.time);
  Point point = before;
  point.time = time;
  point.rate_radps += share * (after->rate_radps - before.rate_radps);
  point.rotation = before.rotation * rotation_of(0.5 * part_s * (before.rate_radps + point.rate_radps));
  point.sum += part_s * before.rotation.toRotationMatrix();
  return point;
}

std::optional<MeasuredTurn> TurnedPath::between(Timestamp from, Timestamp to) const {
  const auto a = at(from), b = at(to);
  if (!a || !b || a->run != b->run) return std::nullopt;
  return MeasuredTurn{a->rotation.conjugate() * b->rotation,
                      b->rotation.conjugate().toRotationMatrix() * (b->sum - a->sum), a->rate_radps,
                      b->rate_radps};
}

}  // namespace fude
