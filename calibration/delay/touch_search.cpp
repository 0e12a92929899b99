#include "calibration/delay/touch_search.h"

#include <algorithm>
#include <cmath>

namespace fude {
namespace {

constexpr double grid_s = 5e-3;   // of the integral of height
constexpr double beside_s = 0.1;  // of a touch, over which heights are averaged
constexpr double lag_step_s = 1e-2;
constexpr double apart_s = 0.05;
constexpr double fastest_drift = 120e-6;
constexpr double tolerable_smear_s = 0.02;  // at the session's ends
constexpr std::size_t most_touches = 120;
constexpr std::size_t most_candidates = 6;
constexpr double least_share_of_best = 0.5;

// Means of the height between any two moments, by its integral.
class MeanHeight {
 public:
  explicit MeanHeight(const Series& path) : begin_s_(path.t_s.front()) {
    const auto cells = std::size_t(path.span_s() / grid_s);
    // A lift by a metre is no more of a lift than one by what is usual.
    std::vector<double> heights;
    for (std::size_t i = 0; i < path.size(); i += path.size() / 500 + 1)
      heights.push_back(path.values[i].z());
    std::sort(heights.begin(), heights.end());
    const double low = heights[heights.size() / 20], high = heights[heights.size() - 1 - heights.size() / 20];
    integral_.reserve(cells + 1);
    integral_.push_back(0);
    std::size_t i = 0;
    for (std::size_t cell = 0; cell < cells; ++cell) {
      const double t = begin_s_ + (double(cell) + 0.5) * grid_s;
      while (i + 2 < path.size() && path.t_s[i + 1] < t) ++i;
      const double share = (t - path.t_s[i]) / (path.t_s[i + 1] - path.t_s[i]);
      const double z = path.values[i].z() + share * (path.values[i + 1].z() - path.values[i].z());
      integral_.push_back(integral_.back() + std::clamp(z, low, high));
    }
  }

  // How much lower it is after than before; none near the ends.
  bool fall(double t_s, double& fall) const {
    const double at = (t_s - begin_s_) / grid_s;
    constexpr double wide = beside_s / grid_s;
    if (!(at >= wide && at + wide + 1 < double(integral_.size()))) return false;
    const auto i = std::size_t(at + 0.5);
    constexpr auto cells = std::size_t(wide);
    fall = (2 * integral_[i] - integral_[i - cells] - integral_[i + cells]) / wide;
    return true;
  }

 private:
  double begin_s_;
  std::vector<double> integral_;
};

TouchCandidate judged(std::span<const Touch> touches, const MeanHeight& height, const DelayLine& line) {
  TouchCandidate candidate{line};
  double sum = 0, agreeing = 0;
  for (const Touch& touch : touches) {
    double fall = 0;
    if (!height.fall(touch.middle_s() - line.at(touch.t_s), fall)) continue;
    if (!touch.down) fall = -fall;
    ++candidate.seen;
    sum += fall;
    agreeing += fall > 0;
  }
  const double seen = std::max(1.0, double(candidate.seen));
  candidate.contrast = sum / seen;
  candidate.agreeing = agreeing / seen;
  return candidate;
}

}  // namespace

std::vector<TouchCandidate> search_touches(std::span<const Touch> touches, const Series& path, double range_s,
                                           bool either_side) {
  std::vector<TouchCandidate> found;
  if (touches.empty() || path.size() < 2) return found;
  const MeanHeight height(path);
  std::vector<Touch> some;
  for (std::size_t i = 0; i < touches.size(); i += touches.size() / most_touches + 1)
    some.push_back(touches[i]);
  const double half_s = (touches.back().t_s - touches.front().t_s) / 2;
  const double reference_s = touches.front().t_s + half_s;
  const int drifts = int(std::floor(fastest_drift * half_s / tolerable_smear_s));
  const int lags = int(range_s / lag_step_s);
  std::vector<TouchCandidate> of_lag;
  for (int lag = -lags; lag <= lags; ++lag) {
    TouchCandidate high, low;
    for (int d = -drifts; d <= drifts; ++d) {
      const double drift = drifts > 0 ? fastest_drift * d / drifts : 0;
      const TouchCandidate c = judged(some, height, {lag * lag_step_s, drift, reference_s});
      if (2 * c.seen < some.size()) continue;
      if (c.contrast > high.contrast) high = c;
      if (c.contrast < low.contrast) low = c;
    }
    if (high.contrast > 0) of_lag.push_back(high);
    if (either_side && low.contrast < 0)
      of_lag.push_back({low.line, -1, -low.contrast, 1 - low.agreeing, low.seen});
  }
  // Touches that agree count before a few that agree very well.
  const auto merit = [](const TouchCandidate& c) { return c.agreeing * c.agreeing * c.contrast; };
  std::sort(of_lag.begin(), of_lag.end(), [&](const auto& a, const auto& b) { return merit(a) > merit(b); });
  for (const TouchCandidate& candidate : of_lag) {
    if (found.size() == most_candidates) break;
    if (!found.empty() && merit(candidate) < least_share_of_best * merit(found.front())) break;
    const bool near = std::any_of(found.begin(), found.end(), [&](const TouchCandidate& other) {
      return std::abs(other.line.offset_s - candidate.line.offset_s) < apart_s;
    });
    if (!near) found.push_back(candidate);
  }
  return found;
}

}  // namespace fude
