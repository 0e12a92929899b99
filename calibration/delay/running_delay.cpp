#include "calibration/delay/running_delay.h"

#include <cmath>

namespace fude {

std::optional<DelayMoment> RunningDelay::add(DelaySide side, const Sample& sample) {
  reader(side).add(sample);
  if (reader(side).restarted()) {
    a_.begin_anew();
    b_.begin_anew();
    newest_.reset();
    next_s_ = -INFINITY;
    return std::nullopt;
  }
  const auto now_s = a_.last_s();
  if (side != DelaySide::a || !now_s || *now_s < next_s_) return std::nullopt;
  next_s_ = *now_s + limits_.every_s;
  // Offsets further from the last one than this are another pairing of strokes.
  constexpr double near_s = 0.2;
  DelaySearch search{.drifts = false};
  if (newest_) search.range_s = std::abs(newest_->offset_s) + near_s;
  const double begin_s = *now_s - limits_.window_s;
  a_.forget_before(begin_s);
  b_.forget_before(begin_s - search.range_s);
  const auto found = delay_between(a_.witness(), b_.witness(), search);
  missing_ = found ? "" : found.error();
  if (!found) return std::nullopt;
  newest_ = {*now_s, found->line.offset_s, found->offset_ci95_s};
  return newest_;
}

}  // namespace fude
