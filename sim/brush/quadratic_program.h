// Dense convex quadratic program by the dual active-set method of Goldfarb and Idnani (Mathematical
// Programming 27, 1983): from the free minimum, violated constraints are taken up one by one.
#pragma once

#include <Eigen/Core>

#include "sim/brush/program.h"

namespace fude {

// minimise ½ dᵀ hessian d + gradientᵀ d  where  rows d ≥ right and low ≤ d ≤ high.
struct QuadraticProgram {
  const SquareMatrix& hessian;  // symmetric, positive definite
  const Variables& gradient;
  const Jacobian& rows;
  const Multipliers& right;
  const Variables& low;
  const Variables& high;
};

enum class QuadraticOutcome { solved, infeasible, indefinite };

struct QuadraticSolution {
  QuadraticOutcome outcome = QuadraticOutcome::solved;
  Variables d;
  Multipliers multipliers;  // of the rows, ≥ 0
};

QuadraticSolution solve(const QuadraticProgram& program);

}  // namespace fude
