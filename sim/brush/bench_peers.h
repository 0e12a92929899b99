// Our solver beside others that anyone can install, on the same energies, constraints and trajectory. Built
// with -DFUDE_PEERS=ON alone (libnlopt-cxx-dev, coinor-libipopt-dev).
#pragma once

#include <string>
#include <vector>

#include "sim/brush/bench_brush.h"
#include "sim/brush/bench_gesture.h"

namespace fude {

struct PeerFigures {
  std::string name;
  int frames = 0;
  BrushBench::Times us_per_frame;
  double energy = 0;         // mN mm, mean of the frames
  double max_violation = 0;  // of a constraint, over the length of the tuft
  int failures = 0;          // frames in which it said itself that it found no solution
};

struct PeerBench {
  int frames = 0;
  PeerFigures own;
  std::vector<PeerFigures> peers;
  // How far our energy was above the lowest of the peers that keep to 1e-6 of the length: largest of all
  // frames, over max(E, energy of a bend of one degree). Negative: ours was lower in every frame.
  double worst_gap = 0;
  int worst_frame = 0;
};

// Each frame is frozen as our own solution of the one before left it, and solved by each from the same start:
// NLopt's SLSQP (Kraft) and Ipopt with a quasi-Newton Hessian. The peers are spared the unknowns without room
// and a second evaluation at one point. Ipopt, which
// takes a thousand times as long, is asked every hundredth frame. The least time of `runs`.
PeerBench bench_peers(const BrushSpec& spec, const BenchGesture& gesture, int runs = 1);

}  // namespace fude
