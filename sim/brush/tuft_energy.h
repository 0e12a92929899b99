// The incremental potential energy of one step and the constraints of the paper (Chu 2.5.3 to 2.5.6),
// with analytic derivatives. Everything a step keeps frozen stands in FrozenStep: the touching state,
// the reactions, the submerged shares and the effective radii, all from the step before.
#pragma once

#include <Eigen/Core>

#include "signal/pose.h"
#include "sim/brush/program.h"
#include "sim/brush/skeleton.h"
#include "sim/brush/tuft.h"

namespace fude {

// One point of the tuft that rubs on the paper: a spine node or one of its lateral nodes.
struct Rubbing {
  int node = 0;
  int side = -1;                                     // −1 the spine, 0 and 1 the lateral nodes a and b
  double reaction_mn = 0;                            // R
  Eigen::Vector2d anchor = Eigen::Vector2d::Zero();  // where it sticks to the paper, mm
  Eigen::Vector2d along = Eigen::Vector2d::Zero();   // the hair's direction on the paper; zero: upright
};

// The vertical plane that keeps the tip from sliding the way it points (Chu 2.5.6).
struct BlockingPlane {
  bool stands = false;
  Eigen::Vector2d stuck = Eigen::Vector2d::Zero();  // mm
  Eigen::Vector2d facing = Eigen::Vector2d::UnitX();
  double lead_mm = 0;  // L
};

struct FrozenStep {
  Pose<Paper, Handle> paper_from_handle;
  double step_s = 0;
  Variables before;                     // the unknowns at the end of the step before
  PerSegment<Eigen::Vector2d> set_rad;  // (φ, χ) to which plasticity has shifted the bend springs
  PerNode<double> submerged{};          // p
  PerNode<double> lateral_radius_mm{};  // r_lat
  int rubbing_count = 0;
  std::array<Rubbing, 3 * max_segments> rubbing;
  BlockingPlane plane;
  FrozenStep() { set_rad.fill(Eigen::Vector2d::Zero()); }
};

// Where a lateral node stands on the lateral line, mm from its spine node.
double lateral_distance_mm(const Tuft& tuft, const FrozenStep& frozen, int node, double stretch_mm);

class TuftProgram : public Program {
 public:
  TuftProgram(const Tuft& tuft, const FrozenStep& frozen);

  // Constraint k − 1: height of node k's shrunk section over the paper, mm. The last: distance of the
  // tip to the blocking plane, mm.
  void evaluate(const Variables& x, Evaluation& at) const override;

  // Second derivatives of the springs and the internal friction, which do not depend on x for
  // quadratic springs: the first guess of the Hessian. Positive definite.
  SquareMatrix spring_hessian() const;

  // The part of it that depends on the length of the step.
  const Variables& friction_hessian() const { return friction_; }

  int constraints() const { return tuft_.segments + 1; }

  // What rubbing and the constraints with these multipliers pull at the nodes: the derivative of the
  // Lagrangian by node and lateral line, mN. Nothing else of it knows where the handle is.
  NodeForces paper_pull(const Variables& x, const Skeleton& skeleton, const Multipliers& multipliers) const;

 private:
  void add_bends(const Variables& x, Evaluation& at) const;
  void add_stretches(const Variables& x, Evaluation& at) const;
  void add_internal_friction(const Variables& x, Evaluation& at) const;
  void add_rubbing(const Variables& x, const Skeleton& skeleton, NodeForces& forces, Evaluation& at) const;
  // Height of node k's shrunk section, and its derivatives by the lateral line's z and by the two stretches.
  struct Clearance {
    double height = 0;
    double by_lateral_z = 0;
    double by_stretch_a = 0;
    double by_stretch_b = 0;
  };
  Clearance clearance(const Variables& x, const Skeleton& skeleton, int k) const;
  void fill_constraints(const Variables& x, const Skeleton& skeleton, Evaluation& at) const;

  const Tuft& tuft_;
  const FrozenStep& frozen_;
  Layout layout_;
  Variables friction_;      // internal friction: second derivative by the change of each unknown
  SquareMatrix side_hair_;  // Hessian of the side-hair springs, stretches only
};

}  // namespace fude
