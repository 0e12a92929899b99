#include "rig/performed_path.h"

#include <algorithm>
#include <cmath>

#include "signal/elementary.h"

namespace fude {
namespace {

// Pressing takes the hand time as going does: full pressure is as far as this.
constexpr double mm_per_pressure = 12;
constexpr double least_way_mm = 1e-3;

double distance(const PerformedKnot& a, const PerformedKnot& b) {
  const double dx = b.x_mm - a.x_mm;
  const double dy = b.y_mm - a.y_mm;
  const double dp = mm_per_pressure * (b.pressure - a.pressure);
  return std::max(least_way_mm, elementary::square_root(dx * dx + dy * dy + dp * dp));
}

// Cubic Hermite between two values with slopes over a unit interval.
double hermite(double a, double b, double slope_a, double slope_b, double s) {
  const double d = b - a;
  return a + s * (slope_a + s * ((3 * d - 2 * slope_a - slope_b) + s * (slope_a + slope_b - 2 * d)));
}

}  // namespace

double least_jerk(double s) { return s * s * s * (10 + s * (6 * s - 15)); }

PerformedPath::PerformedPath(std::vector<PerformedKnot> knots) : knots_(std::move(knots)) {
  way_.push_back(0);
  for (std::size_t i = 1; i < knots_.size(); ++i)
    way_.push_back(way_.back() + distance(knots_[i - 1], knots_[i]));

  // Monotone slopes (Fritsch and Carlson 1980): pressure never overshoots what was written.
  slope_.assign(knots_.size(), 0);
  for (std::size_t i = 1; i + 1 < knots_.size(); ++i) {
    const double before = (knots_[i].pressure - knots_[i - 1].pressure) / (way_[i] - way_[i - 1]);
    const double after = (knots_[i + 1].pressure - knots_[i].pressure) / (way_[i + 1] - way_[i]);
    if (before * after > 0) slope_[i] = 2 * before * after / (before + after);
  }

  beats_.push_back({0, 0});
  for (std::size_t i = 1; i < knots_.size(); ++i)
    if (knots_[i].beat_s) beats_.push_back({i, seconds_ += *knots_[i].beat_s});
}

PerformedKnot PerformedPath::on_curve(double way) const {
  const auto after = std::upper_bound(way_.begin() + 1, way_.end() - 1, way);
  const auto i = static_cast<std::size_t>(after - way_.begin());
  const double length = way_[i] - way_[i - 1];
  const double s = (way - way_[i - 1]) / length;
  const PerformedKnot& a = knots_[i - 1];
  const PerformedKnot& b = knots_[i];
  // Catmull-Rom over the way: at a knot the curve heads as its neighbours lie; at a beat it may turn.
  const auto heading = [&](std::size_t k, double PerformedKnot::*axis) {
    if (k == 0 || k + 1 == knots_.size() || knots_[k].beat_s) return (b.*axis - a.*axis) / length;
    return (knots_[k + 1].*axis - knots_[k - 1].*axis) / (way_[k + 1] - way_[k - 1]);
  };
  PerformedKnot p;
  for (double PerformedKnot::*axis : {&PerformedKnot::x_mm, &PerformedKnot::y_mm})
    p.*axis = hermite(a.*axis, b.*axis, length * heading(i - 1, axis), length * heading(i, axis), s);
  p.pressure = hermite(a.pressure, b.pressure, length * slope_[i - 1], length * slope_[i], s);
  return p;
}

PerformedKnot PerformedPath::at(double t_s) const {
  const double t = std::clamp(t_s, 0.0, seconds_);
  std::size_t i = 1;
  while (i + 1 < beats_.size() && beats_[i].time_s < t) ++i;
  const Beat& from = beats_[i - 1];
  const Beat& to = beats_[i];
  const double share = (t - from.time_s) / (to.time_s - from.time_s);
  return on_curve(way_[from.knot] + least_jerk(share) * (way_[to.knot] - way_[from.knot]));
}

}  // namespace fude
