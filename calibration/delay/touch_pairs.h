// Offset and drift between two streams that feel the same touches and see nothing of the way between.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "calibration/delay/touch.h"

namespace fude {

struct TouchPair {
  std::size_t of_a = 0, of_b = 0;  // their numbers
  double off_s = 0;                // of their distance in time from the line
};

struct PairFit {
  DelayLine line;  // added to B's times to bring them to A's; reference: the middle of the pairs, B's time
  double offset_sd_s = 0;
  double drift_sd = 0;
  double freedom = 0;
  std::vector<TouchPair> pairs;
};

// The lines on which most touches of B meet one of A within a hundredth of a second, best first, at most
// four; how many meet stands beside each. Offsets of −range to range, drifts as in search_touches.
struct PairCandidate {
  DelayLine line;
  std::size_t met = 0;
};
std::vector<PairCandidate> search_pairs(std::span<const Touch> a, std::span<const Touch> b, double range_s);

// A straight line by least squares through the differences of touches that meet, those beyond four standard
// deviations left out. None: fewer than `fewest_pairs`.
inline constexpr std::size_t fewest_pairs = 10;
std::optional<PairFit> fit_pairs(std::span<const Touch> a, std::span<const Touch> b, const DelayLine& start,
                                 bool drifts);

}  // namespace fude
