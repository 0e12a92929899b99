#include "calibration/delay/touch_pairs.h"

#include <algorithm>
#include <cmath>

#include "calibration/report.h"

namespace fude {
namespace {

constexpr double lag_step_s = 5e-3;
constexpr double meeting_s = 0.01;
constexpr double apart_s = 0.03;
constexpr double fastest_drift = 120e-6;
constexpr double tolerable_smear_s = 5e-3;
constexpr std::size_t most_touches = 120;
constexpr std::size_t most_candidates = 4;
constexpr double gate = 4;
constexpr double median_of_one = 0.6745;

// The touch of A, of the same kind, nearest to t; none further than `within_s`.
std::optional<std::size_t> nearest(std::span<const Touch> a, double t_s, bool down, double within_s) {
  auto at = std::lower_bound(a.begin(), a.end(), t_s - within_s,
                             [](const Touch& touch, double t) { return touch.middle_s() < t; });
  std::optional<std::size_t> best;
  for (; at != a.end() && at->middle_s() <= t_s + within_s; ++at) {
    const auto i = std::size_t(at - a.begin());
    if (at->down == down && (!best || std::abs(at->middle_s() - t_s) < std::abs(a[*best].middle_s() - t_s)))
      best = i;
  }
  return best;
}

std::vector<TouchPair> meetings(std::span<const Touch> a, std::span<const Touch> b, const DelayLine& line,
                                double within_s) {
  std::vector<TouchPair> pairs;
  for (std::size_t i = 0; i < b.size(); ++i) {
    const double t_s = b[i].middle_s() + line.at(b[i].t_s);
    if (const auto j = nearest(a, t_s, b[i].down, within_s)) pairs.push_back({*j, i, a[*j].middle_s() - t_s});
  }
  return pairs;
}

}  // namespace

std::vector<PairCandidate> search_pairs(std::span<const Touch> a, std::span<const Touch> b, double range_s) {
  std::vector<PairCandidate> found, all;
  if (a.empty() || b.empty()) return found;
  const double half_s = (b.back().t_s - b.front().t_s) / 2;
  const double reference_s = b.front().t_s + half_s;
  const int drifts = int(fastest_drift * half_s / tolerable_smear_s);
  const int lags = int(range_s / lag_step_s);
  std::vector<Touch> some;
  for (std::size_t i = 0; i < b.size(); i += b.size() / most_touches + 1) some.push_back(b[i]);
  for (int lag = -lags; lag <= lags; ++lag) {
    PairCandidate best;
    for (int d = -drifts; d <= drifts; ++d) {
      const DelayLine line{lag * lag_step_s, drifts > 0 ? fastest_drift * d / drifts : 0, reference_s};
      const std::size_t met = meetings(a, some, line, meeting_s).size();
      if (met > best.met) best = {line, met};
    }
    if (best.met > 0) all.push_back(best);
  }
  std::stable_sort(all.begin(), all.end(), [](const auto& x, const auto& y) { return x.met > y.met; });
  for (const PairCandidate& candidate : all) {
    if (found.size() == most_candidates) break;
    const bool near = std::any_of(found.begin(), found.end(), [&](const PairCandidate& other) {
      return std::abs(other.line.offset_s - candidate.line.offset_s) < apart_s;
    });
    if (!near) found.push_back(candidate);
  }
  return found;
}

std::optional<PairFit> fit_pairs(std::span<const Touch> a, std::span<const Touch> b, const DelayLine& start,
                                 bool drifts) {
  if (a.empty() || b.empty()) return std::nullopt;
  PairFit fit;
  fit.line = start;
  fit.line.reference_s = (b.front().t_s + b.back().t_s) / 2;
  fit.line.offset_s = start.at(fit.line.reference_s);
  double within_s = 3 * meeting_s;
  constexpr int rounds = 8;
  for (int round = 0; round < rounds; ++round) {
    fit.pairs = meetings(a, b, fit.line, within_s);
    if (fit.pairs.size() < fewest_pairs) return std::nullopt;
    std::vector<double> off, sizes;
    for (const TouchPair& pair : fit.pairs) off.push_back(pair.off_s);
    const double middle = quantile(off, 0.5);
    for (const double o : off) sizes.push_back(std::abs(o - middle));
    const double most_s = std::max(gate * quantile(sizes, 0.5) / median_of_one, 1e-6);
    std::erase_if(fit.pairs, [&](const TouchPair& pair) { return std::abs(pair.off_s - middle) > most_s; });
    if (fit.pairs.size() < fewest_pairs) return std::nullopt;
    double n = 0, t = 0, tt = 0, d = 0, td = 0;
    for (const TouchPair& pair : fit.pairs) {
      const double later_s = b[pair.of_b].t_s - fit.line.reference_s;
      ++n, t += later_s, tt += later_s * later_s, d += pair.off_s, td += later_s * pair.off_s;
    }
    const double spread = tt - t * t / n;
    const double slope = drifts && spread > 0 ? (td - t * d / n) / spread : 0;
    const double offset = d / n - slope * t / n;
    fit.line.offset_s += offset;
    fit.line.drift += slope;
    double squares = 0;
    for (TouchPair& pair : fit.pairs) {
      pair.off_s -= offset + slope * (b[pair.of_b].t_s - fit.line.reference_s);
      squares += pair.off_s * pair.off_s;
    }
    fit.freedom = n - (drifts ? 2 : 1);
    const double variance = squares / fit.freedom;
    fit.offset_sd_s = std::sqrt(variance * (1 / n + (drifts && spread > 0 ? t * t / (n * n) / spread : 0)));
    fit.drift_sd = drifts && spread > 0 ? std::sqrt(variance / spread) : 0;
    within_s = meeting_s;
  }
  return fit;
}

}  // namespace fude
