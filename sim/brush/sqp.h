// Sequential quadratic programming: damped BFGS on the Lagrangian, an active-set quadratic program a
// step, an exact-penalty line search with a second-order correction (Nocedal & Wright, chapter 18).
// The Hessian is the caller's and goes on from one program to the next (Chu 2.5.8).
#pragma once

#include "sim/brush/program.h"

namespace fude {

struct SqpLimits {
  int iterations = 20;
  double residual = 1e-5;  // of the Karush-Kuhn-Tucker conditions, relative
};

struct SqpResult {
  int iterations = 0;  // quadratic programs solved for a step
  bool converged = false;
  double residual = 0;   // relative; see SqpLimits
  double violation = 0;  // of the worst constraint, in its own unit
  double value = 0;
  Multipliers multipliers;
};

// Minimises from x (moved into its bounds first). `hessian` must be positive definite; where it has
// gone bad it is replaced by `fresh_hessian`.
SqpResult minimise(const Program& program, Variables& x, SquareMatrix& hessian,
                   const SquareMatrix& fresh_hessian, const SqpLimits& limits);

}  // namespace fude
