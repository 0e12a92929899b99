// All that a tuft remembers between steps. Plain values: copying it is a snapshot.
#pragma once

#include <Eigen/Core>
#include <array>

#include "signal/pose.h"
#include "sim/brush/program.h"
#include "sim/brush/skeleton.h"
#include "sim/brush/tuft.h"
#include "sim/brush/tuft_energy.h"

namespace fude {

// A spine node (side 0) or one of its lateral nodes (1, 2) and the spot where it sticks.
struct Touch {
  bool touching = false;
  Eigen::Vector2d anchor = Eigen::Vector2d::Zero();  // mm
};

struct TuftState {
  Variables x;                          // Layout
  SquareMatrix hessian;                 // of the Lagrangian, carried on (Chu 2.5.8)
  double hessian_step_s = 0;            // the step it was made for
  PerSegment<Eigen::Vector2d> set_rad;  // plastic shift of (φ, χ)
  // Multipliers of the contact constraints (mN; the last of the plane) and submerged shares p, both
  // lagging behind what was last solved.
  Multipliers reactions;
  PerNode<double> submerged{};
  PerNode<double> minor_mm{};  // c
  PerNode<std::array<Touch, 3>> touches{};
  BlockingPlane plane;
  bool in_contact = false;
  Pose<Paper, Handle> paper_from_handle;  // as last solved: never lower than the tuft allows
  bool placed = false;                    // there is a pose
  TuftState() { set_rad.fill(Eigen::Vector2d::Zero()); }
};

TuftState rest_state(const Tuft& tuft);

}  // namespace fude
