#include <algorithm>
#include <cmath>

#include "calibration/delay/delay_estimate.h"
#include "calibration/delay/touch_pairs.h"

namespace fude {
namespace {

constexpr double least_met = 0.5;      // share of the touches of the one that has fewer
constexpr double clearly_fewer = 0.8;  // met by another pairing
constexpr std::size_t window_pairs = 16;

std::vector<Touch> of_kinds(const Witness& witness, bool lifts) {
  std::vector<Touch> kept;
  for (const Touch& touch : witness.touches)
    if (touch.down || lifts) kept.push_back(touch);
  return kept;
}

std::vector<DelayMoment> course_of(const PairFit& fit, const std::vector<Touch>& b, double variance) {
  std::vector<DelayMoment> course;
  for (std::size_t first = 0; first + window_pairs <= fit.pairs.size(); first += window_pairs / 2) {
    double t_s = 0, off_s = 0;
    for (std::size_t i = first; i < first + window_pairs; ++i) {
      t_s += b[fit.pairs[i].of_b].t_s / double(window_pairs);
      off_s += fit.pairs[i].off_s / double(window_pairs);
    }
    course.push_back({t_s, fit.line.at(t_s) + off_s,
                      student_975(double(window_pairs)) * std::sqrt(variance / double(window_pairs))});
  }
  return course;
}

}  // namespace

DelayFinding delay_by_pairs(const Witness& a, const Witness& b, const DelaySearch& search) {
  const bool lifts = a.lifts && b.lifts;
  const auto of_a = of_kinds(a, lifts), of_b = of_kinds(b, lifts);
  const std::size_t fewer = std::min(of_a.size(), of_b.size());
  if (fewer < fewest_pairs)
    return tl::unexpected("only " + std::to_string(fewer) + " touches were felt by " +
                          (of_a.size() < of_b.size() ? a.name : b.name) + ": make " +
                          std::to_string(fewest_pairs - fewer) + " strokes more at least, better 40");
  const auto candidates = search_pairs(of_a, of_b, search.range_s);
  const std::size_t few_b = std::min<std::size_t>(fewer, of_b.size() / (of_b.size() / 120 + 1));
  if (candidates.empty() || double(candidates.front().met) < least_met * double(few_b))
    return tl::unexpected("the touches of " + a.name + " and " + b.name +
                          " do not come at the same times: they do not feel the same brush");
  if (candidates.size() > 1 && double(candidates[1].met) > clearly_fewer * double(candidates[0].met))
    return tl::unexpected(
        "the strokes come so evenly that offsets of " + in_words(candidates[0].line.offset_s, 3) + " s and " +
        in_words(candidates[1].line.offset_s, 3) + " s fit alike: vary the time between strokes");
  auto fit = fit_pairs(of_a, of_b, candidates.front().line, search.drifts);
  if (!fit)
    return tl::unexpected("too few touches of " + a.name + " and " + b.name + " agree with one offset");
  DelayEstimate estimate;
  estimate.drift = fit->line.drift;
  estimate.drift_ci95 = student_975(fit->freedom) * fit->drift_sd;
  const double half_s = (of_b.back().t_s - of_b.front().t_s) / 2;
  if (!significant(fit->line.drift, fit->drift_sd, half_s, student_975(fit->freedom) * fit->offset_sd_s)) {
    DelayLine start = fit->line;
    start.drift = 0;
    fit = fit_pairs(of_a, of_b, start, false);
    if (!fit) return tl::unexpected("too few touches of " + a.name + " and " + b.name + " agree");
  }
  estimate.method = "touches that " + a.name + " and " + b.name + " both feel";
  estimate.line = fit->line;
  estimate.offset_ci95_s = student_975(fit->freedom) * fit->offset_sd_s;
  double squares = 0, other_squares = 0;
  double sums[2] = {0, 0}, counts[2] = {0, 0};
  for (std::size_t i = 0; i < fit->pairs.size(); ++i) {
    const double off_s = fit->pairs[i].off_s;
    estimate.residuals_s.push_back(std::abs(off_s));
    squares += off_s * off_s;
    sums[i % 2] += off_s;
    ++counts[i % 2];
  }
  const double means[2] = {sums[0] / counts[0], sums[1] / counts[1]};
  for (std::size_t i = 0; i < fit->pairs.size(); ++i)
    other_squares += std::pow(fit->pairs[i].off_s - means[1 - i % 2], 2);
  estimate.held_out_rms_s = std::sqrt(other_squares / double(fit->pairs.size()));
  estimate.halves_apart_s = std::abs(means[0] - means[1]);
  estimate.course = course_of(*fit, of_b, squares / fit->freedom);
  estimate.details = {{"touches_of_a", double(of_a.size())},
                      {"touches_of_b", double(of_b.size())},
                      {"pairs", double(fit->pairs.size())}};
  return estimate;
}

}  // namespace fude
