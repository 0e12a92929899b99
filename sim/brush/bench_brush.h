// How fast a brush is on this machine, and whether its solver holds: a press, drag, turn, lift
// trajectory of 2000 frames at 250 Hz, run several times and the least time of each frame taken.
#pragma once

#include "signal/pose.h"
#include "sim/brush/brush_spec.h"

namespace fude {

struct BrushBench {
  struct Times {
    double median = 0;
    double p99 = 0;
    double max = 0;
  };
  int frames = 0;
  Times us_per_frame;      // the solve and what belongs to it (advance)
  Times us_per_footprint;  // sweeping the footprint, over the frames that touch
  double iterations_median = 0;
  int iterations_max = 0;
  int unconverged = 0;
};

BrushBench bench_brush(const BrushSpec& spec, int runs = 5);

// The trajectory: pose of the handle at `time_s` in [0, 8], scaled to the length of the tuft.
Pose<Paper, Handle> bench_pose(const BrushSpec& spec, double time_s);

}  // namespace fude
