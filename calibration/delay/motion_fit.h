// Offset and drift between two streams that see the same motion, each in axes of its own.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "calibration/delay/series.h"
#include "calibration/delay/touch.h"

namespace fude {

enum class MotionSeen {
  rates,  // both series are rates already: turn rates
  paths   // both are places, whose speeds are compared
};

struct MotionCandidate {
  DelayLine line;        // added to B's times to bring them to A's
  double explained = 0;  // share 0 to 1 of A's motion that is a linear map of B's
};

// Best first; 0.15 s apart. Offsets of −range to range in steps of a hundredth of a second, over the two
// minutes of the most motion. Empty: the streams overlap by less than five seconds.
std::vector<MotionCandidate> search_motion(const Series& a, const Series& b, MotionSeen seen, double range_s);

struct MotionBlock {
  double t_s = 0;   // of A, its middle
  double pull = 0;  // scores of the offset: offset of this block alone is pull / information
  double information = 0;
  double squares = 0;  // of what is not explained
  double motion = 0;   // squares of A's motion
};

struct MotionFit {
  DelayLine line;  // added to B's times to bring them to A's; reference: the middle of the overlap, A's time
  double offset_sd_s = 0;
  double drift_sd = 0;
  double freedom = 0;
  double explained = 0;
  std::size_t moments = 0;          // of comparison, a hundredth of a second apart
  std::vector<MotionBlock> blocks;  // of two seconds
};

// a(t) = M·b(t − offset(t)) + c by least squares, over M, c and the line together, with both sides smoothed
// by the same parabolas. Residuals hang together over time: the standard deviation is that of the scores of
// blocks of two seconds. None: fewer than five blocks, or the line runs away from `start` by a tenth of a
// second.
std::optional<MotionFit> fit_motion(const Series& a, const Series& b, MotionSeen seen, const DelayLine& start,
                                    bool drifts);

}  // namespace fude
