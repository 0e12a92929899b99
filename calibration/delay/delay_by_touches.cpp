#include <algorithm>
#include <cmath>

#include "calibration/delay/delay_estimate.h"
#include "calibration/delay/touch_fit.h"
#include "calibration/delay/touch_search.h"
#include "calibration/plane_fit.h"

namespace fude {
namespace {

constexpr std::size_t fewest_strokes = 10;
constexpr std::size_t enough_strokes = 40;
constexpr double least_agreeing = 0.8;  // share of touches at which the path goes down
constexpr double least_used = 0.7;
constexpr double least_speed_spread = 0.1;
constexpr double clearly_better = 2.5;  // of residuals, than another pairing
constexpr double as_good = 0.9;         // of the fall at the touches, with another pairing …
constexpr double well_apart_s = 0.15;   // … that far from the best
constexpr double same_s = 0.02;
constexpr std::size_t window_touches = 24;
constexpr double mm_per_m = 1e3;

// The path in three frames whose third axis may stand on the surface: on the plane near which it mostly is,
// then along and across that plane, should the brush have gone to and fro in one upright plane.
std::vector<Series> levelled(const Series& path) {
  constexpr std::size_t judges = 120;
  std::vector<Eigen::Vector3d> some;
  for (std::size_t i = 0; i < path.size(); i += path.size() / judges + 1) some.push_back(path.values[i]);
  const PlaneFit plane = robust_plane(some, 1e-4).plane;
  const Eigen::Vector3d axes[] = {plane.normal, plane.along, plane.normal.cross(plane.along)};
  std::vector<Series> all;
  for (int up = 0; up < 3; ++up) {
    Eigen::Matrix3d turn;
    turn << axes[(up + 1) % 3].transpose(), axes[(up + 2) % 3].transpose(), axes[up].transpose();
    all.push_back(path);
    for (Eigen::Vector3d& point : all.back().values) point = turn * (point - plane.centre);
  }
  return all;
}

struct Found {
  Series path;
  std::vector<TouchCandidate> candidates;
};

Found found_on(const Witness& touching, const Witness& moving, double range_s) {
  if (moving.levelled) return {moving.path, search_touches(touching.touches, moving.path, range_s, false)};
  Found best;
  for (Series& path : levelled(moving.path)) {
    auto candidates = search_touches(touching.touches, path, range_s, true);
    const bool better =
        !candidates.empty() &&
        (best.candidates.empty() || candidates.front().agreeing > best.candidates.front().agreeing);
    if (better) best = {std::move(path), std::move(candidates)};
    if (!best.candidates.empty() && best.candidates.front().agreeing >= least_agreeing) break;
  }
  return best;
}

void turn_over(Series& path) {
  for (Eigen::Vector3d& point : path.values) point = {point.x(), -point.y(), -point.z()};
}

struct Fitted {
  TouchFit fit;
  double side;
  double rms_s;
};

// All touches are at one speed: where the brush rests they are.
bool rests(const Fitted& fitted) { return fitted.fit.speed_spread < least_speed_spread; }

// Each candidate's fit, best first; those that came to the same offset once.
std::vector<Fitted> fits_of(const std::vector<TouchCandidate>& candidates, const Witness& touching,
                            const Series& path, const TouchModel& model) {
  std::vector<Fitted> fits;
  for (const TouchCandidate& candidate : candidates) {
    const auto fit = fit_touches(touching.touches, path, candidate.line, model);
    if (!fit || !(fit->speed > 0)) continue;
    const bool known = std::any_of(fits.begin(), fits.end(), [&](const Fitted& other) {
      return std::abs(other.fit.line.offset_s - fit->line.offset_s) < same_s;
    });
    if (!known) fits.push_back({*fit, candidate.side, root_mean_square(residual_times(*fit))});
  }
  // What leaves many touches out has small residuals for nothing, and so has what lies where the brush rests.
  const auto merit = [](const Fitted& f) { return f.rms_s / double(f.fit.used() * f.fit.used()); };
  std::sort(fits.begin(), fits.end(), [&](const auto& x, const auto& y) {
    return rests(x) != rests(y) ? rests(y) : merit(x) < merit(y);
  });
  return fits;
}

std::vector<Touch> half_of(const std::vector<Touch>& touches, std::size_t odd) {
  std::vector<Touch> half;
  std::size_t stroke = 0;
  for (const Touch& touch : touches) {
    stroke += touch.down;
    if (stroke % 2 == odd) half.push_back(touch);
  }
  return half;
}

void hold_out(DelayEstimate& estimate, const Witness& touching, const Series& path, const TouchFit& whole,
              const TouchModel& model) {
  std::vector<double> off;
  double offsets[2];
  const double rms_s = root_mean_square(residual_times(whole));
  for (const std::size_t odd : {0U, 1U}) {
    const auto fit = fit_touches(half_of(touching.touches, odd), path, whole.line, model);
    if (!fit) return;
    offsets[odd] = fit->line.at(whole.line.reference_s);
    for (const TouchResidual& r : residuals_against(*fit, half_of(touching.touches, 1 - odd), path, rms_s))
      if (r.agrees) off.push_back(r.height_off / fit->speed);
  }
  estimate.held_out_rms_s = root_mean_square(off);
  estimate.halves_apart_s = std::abs(offsets[0] - offsets[1]);
}

// Windows of some touches, half of each in the next; heights as the whole session has them.
std::vector<DelayMoment> course_of(const TouchFit& fit, const std::vector<Touch>& touches) {
  std::vector<const TouchResidual*> used;
  double squares = 0;
  for (const TouchResidual& r : fit.residuals) {
    if (!r.agrees) continue;
    used.push_back(&r);
    squares += r.weight * r.height_off * r.height_off;
  }
  const double scale2 = squares / fit.freedom;
  std::vector<DelayMoment> course;
  for (std::size_t first = 0; first + window_touches <= used.size(); first += window_touches / 2) {
    double pull = 0, information = 0, t_s = 0;
    for (std::size_t i = first; i < first + window_touches; ++i) {
      pull += used[i]->weight * used[i]->rate * used[i]->height_off;
      information += used[i]->weight * used[i]->rate * used[i]->rate;
      t_s += touches[used[i]->touch].t_s / double(window_touches);
    }
    course.push_back({t_s, fit.line.at(t_s) + pull / information,
                      student_975(double(window_touches)) * std::sqrt(scale2 / information)});
  }
  return course;
}

std::string too_few(const Witness& touching, std::size_t strokes) {
  return "only " + std::to_string(strokes) + " strokes of " + touching.name + ": make " +
         std::to_string(fewest_strokes - strokes) + " more at least, better " +
         std::to_string(enough_strokes - strokes);
}

std::string strangers(const Witness& touching, const Witness& moving) {
  return moving.name + " does not come down where " + touching.name +
         " is touched: they do not see the same brush, or are further apart in time than the search";
}

// Another offset at which the touches fit as well.
std::optional<double> other_pairing(const std::vector<TouchCandidate>& candidates,
                                    const std::vector<Fitted>& fits) {
  const TouchCandidate& best = candidates.front();
  for (const TouchCandidate& c : candidates)
    if (std::abs(c.line.offset_s - best.line.offset_s) > well_apart_s &&
        c.agreeing * c.contrast > as_good * best.agreeing * best.contrast)
      return c.line.offset_s;
  if (fits.size() > 1 && !rests(fits[0]) && !rests(fits[1]) &&
      fits[1].rms_s < clearly_better * fits[0].rms_s && 5 * fits[1].fit.used() > 4 * fits[0].fit.used())
    return fits[1].fit.line.offset_s;
  return std::nullopt;
}

// Where the first and the last third of the touches have offsets that no drift explains.
std::optional<double> parted_at(const Witness& touching, const Series& path, const DelaySearch& search) {
  const std::vector<Touch>& touches = touching.touches;
  const std::size_t third = touches.size() / 3;
  std::optional<TouchFit> first, last;
  for (const bool late : {false, true}) {
    const std::span<const Touch> part(touches.data() + (late ? touches.size() - third : 0), third);
    const auto candidates = search_touches(part, path, search.range_s, !touching.levelled);
    if (candidates.empty() || candidates.front().agreeing < least_agreeing) return std::nullopt;
    (late ? last : first) = fit_touches(part, path, candidates.front().line, {});
  }
  constexpr double surely_s = 0.01;
  if (!first || !last || std::abs(first->line.offset_s - last->line.offset_s) < surely_s) return std::nullopt;
  std::vector<InTime> all;
  const double rms_s = root_mean_square(residual_times(*first));
  for (const TouchResidual& r : residuals_against(*first, touches, path, rms_s))
    all.push_back({touches[r.touch].t_s, r.agrees});
  return break_in_time(all);
}

// Why too few touches agree with the fit; empty where enough do.
std::string disagreement(const TouchFit& fit, const Witness& touching, const Witness& moving) {
  const std::size_t touches = touching.touches.size();
  if (double(fit.used()) >= least_used * double(touches)) return "";
  std::vector<InTime> all;
  for (const TouchResidual& r : fit.residuals) all.push_back({touching.touches[r.touch].t_s, r.agrees});
  if (const auto at = break_in_time(all))
    return restart_in_words(touching.name + " or " + moving.name, "at " + in_words(*at));
  return "only " + std::to_string(fit.used()) + " of " + std::to_string(touches) + " touches of " +
         touching.name + " agree with one offset to " + moving.name +
         ": is the surface flat, and does the tracker see the tip?";
}

}  // namespace

DelayFinding delay_by_touches(const Witness& touching, const Witness& moving, const DelaySearch& search) {
  const auto strokes = std::size_t(std::count_if(touching.touches.begin(), touching.touches.end(),
                                                 [](const Touch& touch) { return touch.down; }));
  if (strokes < fewest_strokes) return tl::unexpected(too_few(touching, strokes));
  auto [path, candidates] = found_on(touching, moving, search.range_s);
  if (candidates.empty())
    return tl::unexpected(moving.name + " was hardly ever seen when " + touching.name +
                          " was touched: the two do not overlap");
  TouchModel model{moving.levelled, search.drifts};
  const auto fits = fits_of(candidates, touching, path, model);
  if (candidates.front().agreeing < least_agreeing || fits.empty() || other_pairing(candidates, fits))
    if (const auto at = parted_at(touching, path, search))
      return tl::unexpected(restart_in_words(touching.name + " or " + moving.name, "at " + in_words(*at)));
  if (candidates.front().agreeing < least_agreeing) return tl::unexpected(strangers(touching, moving));
  if (const auto other = other_pairing(candidates, fits))
    return tl::unexpected("the strokes come so evenly that offsets of " +
                          in_words(candidates.front().line.offset_s) + " s and " + in_words(*other) +
                          " s fit alike: vary the time between strokes");
  if (fits.empty()) return tl::unexpected(strangers(touching, moving));
  const Fitted& best = fits.front();
  if (auto why = disagreement(best.fit, touching, moving); !why.empty()) return tl::unexpected(why);
  if (best.side < 0) turn_over(path);

  TouchFit fit = best.fit;
  DelayEstimate estimate;
  estimate.drift = fit.line.drift;
  estimate.drift_ci95 = student_975(fit.freedom) * fit.drift_sd;
  estimate.offset_ci95_s = student_975(fit.freedom) * fit.offset_sd_s;
  const double half_s = (touching.touches.back().t_s - touching.touches.front().t_s) / 2;
  model.drifts = search.drifts && significant(fit.line.drift, fit.drift_sd, half_s, estimate.offset_ci95_s);
  DelayLine start = fit.line;
  if (!model.drifts) start.drift = 0;
  const auto last = fit_touches(touching.touches, path, start, model);
  if (!last) return tl::unexpected(strangers(touching, moving));
  fit = *last;

  const double speed_mm = mm_per_m * fit.speed;
  if (fit.speed_spread < least_speed_spread)
    return tl::unexpected("all touches came down at one speed, " + in_words(speed_mm, 0) +
                          " mm/s: the height at which a touch is felt cannot be told from the delay; vary "
                          "your speed of touching down");
  estimate.method = "touches of " + touching.name + " on the way of " + moving.name;
  estimate.line = fit.line;
  estimate.offset_ci95_s = student_975(fit.freedom) * fit.offset_sd_s;
  estimate.residuals_s = residual_times(fit);
  hold_out(estimate, touching, path, fit, model);
  estimate.course = course_of(fit, touching.touches);
  const bool lifts = touching.lifts;
  estimate.details = {{"strokes", double(strokes)},
                      {"touches_left_out", double(touching.touches.size() - fit.used())},
                      {"touch_speed_mmps", speed_mm},
                      {"touch_speed_spread", fit.speed_spread},
                      {"way_stops_at_touch", std::string(fit.stops ? "yes" : "no")}};
  if (lifts)
    estimate.details.push_back({"lift_below_touch_mm", mm_per_m * (fit.down_height - fit.up_height)});
  if (moving.levelled) estimate.details.push_back({"touch_height_mm", mm_per_m * fit.down_height});
  if (strokes < enough_strokes)
    estimate.warnings.push_back(std::to_string(strokes) + " strokes; " + std::to_string(enough_strokes) +
                                " give a surer offset");
  return estimate;
}

}  // namespace fude
