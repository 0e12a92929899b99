// Roughly where touches lie on a path: the height falls where the brush comes down and rises where it lifts.
#pragma once

#include <span>
#include <vector>

#include "calibration/delay/series.h"
#include "calibration/delay/touch.h"

namespace fude {

struct TouchCandidate {
  DelayLine line;        // added to the path's times to bring them to the touches'
  double side = 1;       // −1: the path's heights grow into the surface
  double contrast = 0;   // mean fall of height about a touch, in the path's unit
  double agreeing = 0;   // share of touches at which it falls, where they lie on the path
  std::size_t seen = 0;  // touches that lie on the path
};

// Best first, at most six, 50 ms apart or more, each with at least half of the best one's contrast. Offsets
// of −range to range; drifts of up to 120 ppm where the session is long enough for them to matter. The third
// coordinate of `path` is the height over the surface, or, with `either_side`, perhaps its negative. Empty:
// half of the touches never lie on the path.
std::vector<TouchCandidate> search_touches(std::span<const Touch> touches, const Series& path, double range_s,
                                           bool either_side);

}  // namespace fude
