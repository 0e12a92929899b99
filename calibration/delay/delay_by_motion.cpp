#include <algorithm>
#include <cmath>

#include "calibration/delay/delay_estimate.h"
#include "calibration/delay/motion_fit.h"

namespace fude {
namespace {

constexpr double least_explained = 0.5;
constexpr double fair_explained = 0.8;
constexpr double as_good = 0.95;  // share of the best one's, of another offset
constexpr std::size_t window_blocks = 5;

struct Sight {
  MotionSeen seen;
  const Series *a, *b;
  std::string what;
};

// The best explained of the motions that both see.
std::optional<std::pair<Sight, std::vector<MotionCandidate>>> best_sight(const std::vector<Sight>& sights,
                                                                         double range_s) {
  std::optional<std::pair<Sight, std::vector<MotionCandidate>>> best;
  for (const Sight& sight : sights) {
    auto candidates = search_motion(*sight.a, *sight.b, sight.seen, range_s);
    if (candidates.empty()) continue;
    if (!best || candidates.front().explained > best->second.front().explained)
      best = {sight, std::move(candidates)};
  }
  return best;
}

// What is left over, as time: over how fast the motion usually changes.
std::vector<double> block_residuals(const MotionFit& fit) {
  double information = 0;
  for (const MotionBlock& block : fit.blocks) information += block.information / double(fit.blocks.size());
  std::vector<double> residuals;
  for (const MotionBlock& block : fit.blocks) residuals.push_back(std::sqrt(block.squares / information));
  return residuals;
}

// Of the blocks in which something moved, whether the map explains it.
std::vector<InTime> agreement(const MotionFit& fit) {
  constexpr double least_motion = 0.05;  // of the usual
  double motion = 0;
  for (const MotionBlock& block : fit.blocks) motion += block.motion / double(fit.blocks.size());
  std::vector<InTime> blocks;
  for (const MotionBlock& block : fit.blocks)
    if (block.motion > least_motion * motion)
      blocks.push_back({block.t_s, block.squares < least_explained * block.motion});
  return blocks;
}

std::vector<DelayMoment> course_of(const MotionFit& fit) {
  std::vector<DelayMoment> course;
  for (std::size_t first = 0; first + window_blocks <= fit.blocks.size(); first += (window_blocks + 1) / 2) {
    double pull = 0, information = 0, scores = 0, t_s = 0;
    for (std::size_t i = first; i < first + window_blocks; ++i) {
      pull += fit.blocks[i].pull;
      information += fit.blocks[i].information;
      scores += fit.blocks[i].pull * fit.blocks[i].pull;
      t_s += fit.blocks[i].t_s / double(window_blocks);
    }
    if (information > 0)
      course.push_back({t_s, fit.line.at(t_s) + pull / information,
                        student_975(double(window_blocks)) * std::sqrt(scores) / information});
  }
  return course;
}

// Offsets of odd and even blocks on their own.
void hold_out(DelayEstimate& estimate, const MotionFit& fit) {
  double pull[2] = {0, 0}, information[2] = {0, 0}, squares = 0;
  for (std::size_t i = 0; i < fit.blocks.size(); ++i) {
    pull[i % 2] += fit.blocks[i].pull;
    information[i % 2] += fit.blocks[i].information;
  }
  if (!(information[0] > 0 && information[1] > 0)) return;
  const double offset[2] = {pull[0] / information[0], pull[1] / information[1]};
  double whole = 0;
  for (std::size_t i = 0; i < fit.blocks.size(); ++i) {
    const MotionBlock& block = fit.blocks[i];
    const double moved = offset[1 - i % 2];
    squares += block.squares - 2 * moved * block.pull + moved * moved * block.information;
    whole += block.information;
  }
  estimate.held_out_rms_s = std::sqrt(squares / whole);
  estimate.halves_apart_s = std::abs(offset[0] - offset[1]);
}

// "between 10 and 20": where the first and the last third see the same motion at offsets that no drift
// explains.
std::optional<std::string> parted(const Sight& sight, double range_s) {
  const Series& a = *sight.a;
  std::vector<MotionCandidate> of_part[2];
  const std::size_t third = a.size() / 3;
  for (const std::size_t late : {0U, 1U}) {
    Series part;
    for (std::size_t i = 0; i < third; ++i) {
      const std::size_t at = i + (late ? a.size() - third : 0);
      part.add(a.t_s[at], a.values[at]);
    }
    of_part[late] = search_motion(part, *sight.b, sight.seen, range_s);
    if (of_part[late].empty() || of_part[late].front().explained < least_explained) return std::nullopt;
  }
  constexpr double surely_s = 0.03;
  const double apart_s = of_part[1].front().line.offset_s - of_part[0].front().line.offset_s;
  if (std::abs(apart_s) < surely_s) return std::nullopt;
  return "between " + in_words(a.t_s[third], 0) + " and " + in_words(a.t_s[a.size() - third], 0);
}

std::string strangers(const Witness& a, const Witness& b, double explained) {
  return a.name + " and " + b.name + " do not see the same motion: at best " + in_words(100 * explained, 0) +
         " % of it agrees";
}

}  // namespace

DelayFinding delay_by_motion(const Witness& a, const Witness& b, const DelaySearch& search) {
  std::vector<Sight> sights;
  if (!a.turn_rate.empty() && !b.turn_rate.empty())
    sights.push_back({MotionSeen::rates, &a.turn_rate, &b.turn_rate, "turning"});
  if (!a.path.empty() && !b.path.empty()) sights.push_back({MotionSeen::paths, &a.path, &b.path, "moving"});
  const auto best = best_sight(sights, search.range_s);
  if (!best)
    return tl::unexpected("nothing moves where both were recorded, or " + a.name + " and " + b.name +
                          " overlap by less than 5 s: move the brush for a minute in front of both");
  const auto& [sight, candidates] = *best;
  const double explained = candidates.front().explained;
  if (explained < least_explained) {
    if (const auto between = parted(sight, search.range_s))
      return tl::unexpected(restart_in_words(a.name + " or " + b.name, *between));
    return tl::unexpected(strangers(a, b, explained));
  }
  const auto other = std::find_if(candidates.begin() + 1, candidates.end(), [&](const MotionCandidate& c) {
    return c.explained > as_good * explained;
  });
  if (other != candidates.end())
    return tl::unexpected("the motion is so even that offsets of " +
                          in_words(candidates.front().line.offset_s) + " s and " +
                          in_words(other->line.offset_s) + " s fit alike: vary your speed");
  auto fit = fit_motion(*sight.a, *sight.b, sight.seen, candidates.front().line, search.drifts);
  if (!fit)
    return tl::unexpected("too little motion that " + a.name + " and " + b.name +
                          " both saw: move the brush for a minute in front of both");
  DelayEstimate estimate;
  estimate.drift = fit->line.drift;
  estimate.drift_ci95 = student_975(fit->freedom) * fit->drift_sd;
  const double half_s = (fit->blocks.back().t_s - fit->blocks.front().t_s) / 2;
  if (!significant(fit->line.drift, fit->drift_sd, half_s, student_975(fit->freedom) * fit->offset_sd_s)) {
    DelayLine start = fit->line;
    start.drift = 0;
    if (const auto even = fit_motion(*sight.a, *sight.b, sight.seen, start, false)) fit = even;
  }
  if (const auto at = break_in_time(agreement(*fit)))
    return tl::unexpected(restart_in_words(a.name + " or " + b.name, "at " + in_words(*at)));
  if (fit->explained < least_explained) return tl::unexpected(strangers(a, b, fit->explained));
  estimate.method = sight.what + " as " + a.name + " and " + b.name + " both see it";
  estimate.line = fit->line;
  estimate.offset_ci95_s = student_975(fit->freedom) * fit->offset_sd_s;
  estimate.residuals_s = block_residuals(*fit);
  hold_out(estimate, *fit);
  estimate.course = course_of(*fit);
  estimate.details = {{"explained", fit->explained}, {"moments", double(fit->moments)}};
  if (fit->explained < fair_explained)
    estimate.warnings.push_back("only " + in_words(100 * fit->explained, 0) + " % of the motion that " +
                                a.name + " saw is that of " + b.name);
  return estimate;
}

}  // namespace fude
