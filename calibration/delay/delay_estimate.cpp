#include "calibration/delay/delay_estimate.h"

#include <algorithm>
#include <cmath>

namespace fude {
namespace {

bool turns(const Witness& w) { return !w.turn_rate.empty(); }
bool moves(const Witness& w) { return !w.path.empty(); }
bool touches(const Witness& w) { return !w.touches.empty(); }
bool has_height(const Witness& w) { return moves(w) && !w.flat; }

// To first order in the drift.
DelayFinding opposite(DelayFinding found) {
  if (!found) return found;
  DelayLine& line = found->line;
  line = {-line.offset_s, -line.drift, line.reference_s};
  found->drift = -found->drift;
  for (DelayMoment& moment : found->course) moment.offset_s = -moment.offset_s;
  return found;
}

}  // namespace

DelayFinding delay_between(const Witness& a, const Witness& b, const DelaySearch& search) {
  const bool one_motion = (turns(a) && turns(b)) || (has_height(a) && has_height(b)) ||
                          (a.flat && b.flat && moves(a) && moves(b));
  const bool felt = touches(a) && has_height(b), felt_by_b = touches(b) && has_height(a);
  if (one_motion) {
    auto found = delay_by_motion(a, b, search);
    if (found || !(felt || felt_by_b)) return found;
    const auto by_touches = felt ? delay_by_touches(a, b, search) : opposite(delay_by_touches(b, a, search));
    return by_touches ? by_touches : found;
  }
  if (felt) return delay_by_touches(a, b, search);
  if (felt_by_b) return opposite(delay_by_touches(b, a, search));
  if (touches(a) && touches(b)) return delay_by_pairs(a, b, search);
  for (const Witness* w : {&a, &b})
    if (w->lifts && w->touches.empty()) return tl::unexpected(w->name + " felt no touch: make 40 strokes");
  return tl::unexpected(a.name + " and " + b.name +
                        " have nothing in common by which to tell the time: it takes touches, or one motion");
}

bool significant(double drift, double drift_sd, double half_session_s, double offset_ci95_s) {
  constexpr double deviations = 3;
  constexpr double least_moved_s = 1e-4;
  return drift_sd > 0 && std::abs(drift) > deviations * drift_sd &&
         std::abs(drift) * half_session_s > std::max(offset_ci95_s, least_moved_s);
}

std::optional<double> break_in_time(const std::vector<InTime>& all) {
  constexpr std::size_t fewest = 5;
  constexpr double mostly = 0.8;
  double agreeing = 0;
  for (const InTime& one : all) agreeing += one.agrees;
  double before = 0, best = 0;
  std::optional<double> at;
  for (std::size_t i = 0; i + fewest < all.size(); ++i) {
    before += all[i].agrees;
    if (i + 1 < fewest) continue;
    const double earlier = before / double(i + 1);
    const double later = (agreeing - before) / double(all.size() - i - 1);
    const double parted = std::max(std::min(earlier, 1 - later), std::min(later, 1 - earlier));
    if (parted > mostly && parted > best) {
      best = parted;
      at = all[i + 1].t_s;
    }
  }
  return at;
}

std::string restart_in_words(const std::string& whose, const std::string& when) {
  return "the clock of " + whose + " started anew " + when +
         " s of the session: calibrate the parts before and after on their own";
}

}  // namespace fude
