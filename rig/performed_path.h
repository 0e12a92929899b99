// The way of a pen through the knots of one stroke, as a function of time.
#pragma once

#include <vector>

#include "rig/performance.h"

namespace fude {

// Share of the way after `share` of the time, both 0 to 1: 10 s³ − 15 s⁴ + 6 s⁵ (Flash and Hogan 1985).
double least_jerk(double share);

class PerformedPath {
 public:
  // Two knots at least; the first and the last are beats whether they say so or not.
  explicit PerformedPath(std::vector<PerformedKnot> knots);

  double seconds() const { return seconds_; }

  // Clamped to the ends.
  PerformedKnot at(double t_s) const;

 private:
  struct Beat {
    std::size_t knot;
    double time_s;
  };
  PerformedKnot on_curve(double way) const;

  std::vector<PerformedKnot> knots_;
  std::vector<double> way_;    // of each knot from the first; pressing counts as going
  std::vector<double> slope_;  // of the pressure over the way, at each knot
  std::vector<Beat> beats_;
  double seconds_ = 0;
};

}  // namespace fude
