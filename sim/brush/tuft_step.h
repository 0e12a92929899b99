// One step of the tuft in time: state and the handle's next pose in, next state out (Chu 2.5).
#pragma once

#include "signal/contact_model.h"
#include "sim/brush/tuft.h"
#include "sim/brush/tuft_state.h"

namespace fude {

// How a minimisation went. `residual` is that of the Karush-Kuhn-Tucker conditions, relative;
// `violation_mm` how far the worst node stands in the paper.
struct SolveReport {
  int iterations = 0;
  bool converged = true;
  double kkt_residual = 0;
  double violation_mm = 0;
  double energy_mn_mm = 0;
  Wrench on_hand;  // contact_force.h
};

// The pose as the tuft can follow it: the root never lower than `lowest_root` tuft lengths.
Pose<Paper, Handle> reachable_pose(const Tuft& tuft, Pose<Paper, Handle> paper_from_handle);

// Bends (φ, χ) of a tuft's joints, radians.
using Bends = PerSegment<Eigen::Vector2d>;
Bends bends_of(const Tuft& tuft, const TuftState& state);

// Everything a step freezes before it is solved, and the guess it starts from: `state.x` may be
// turned or nudged by it (first contact, Chu 2.5.8). `beside` is how the neighbours in a row bend, to which
// springs draw it by `row_coherence`; none where it has no neighbours, or they bend as it does.
FrozenStep freeze_step(const Tuft& tuft, TuftState& state, const Pose<Paper, Handle>& paper_from_handle,
                       double step_s, const Bends* beside = nullptr);

// Solves for the tuft at `paper_from_handle`, `step_s` later. `jumped`: the hand did not draw the
// tuft there, so what stuck to the paper is let go. Steps are held between 0.1 ms and 0.5 s. Where `model` is
// given, it becomes the contact model at the solution, at the cost of some three solves. `beside` as above.
SolveReport advance(const Tuft& tuft, TuftState& state, const Pose<Paper, Handle>& paper_from_handle,
                    double step_s, bool jumped, ContactModel* model = nullptr, const Bends* beside = nullptr);

}  // namespace fude
