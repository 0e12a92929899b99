// How fast a brush is on this machine, and whether its solver holds, led through a gesture of
// bench_gesture.h.
#pragma once

#include <vector>

#include "sim/brush/bench_gesture.h"
#include "sim/brush/brush_spec.h"

namespace fude {

struct BrushBench {
  struct Times {
    double median = 0;
    double p99 = 0;
    double max = 0;
  };
  int frames = 0;
  Times us_per_frame;  // the solves of all tufts and what belongs to them (advance)
  double iterations_median = 0;
  int iterations_max = 0;
  int unconverged = 0;
  double max_violation = 0;  // of the paper, over the length of the tuft
};

// 2000 frames of 4 ms, run several times and the least time of each frame taken. `tufts` of them stand side
// by side on one handle, each a tuft of the brush, solved one after the other.
BrushBench bench_brush(const BrushSpec& spec, const BenchGesture& gesture, int tufts = 1, int runs = 5);

struct MoveBench {
  int frames = 0;
  int marks = 0;  // frames that left ink
  BrushBench::Times us_per_frame;
  int unconverged = 0;
};

// The whole of Brush::move, footprint and loading with it, by a tracker of 1 kHz: 8000 frames, as above.
MoveBench bench_move(const BrushSpec& spec, const BenchGesture& gesture, int runs = 5);

BrushBench::Times times_of(std::vector<double> us);

}  // namespace fude
