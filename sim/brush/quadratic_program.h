// Dense convex quadratic program by the dual active-set method of Goldfarb and Idnani (Mathematical
// Programming 27, 1983): from the free minimum, violated constraints are taken up one by one.
#pragma once

#include <Eigen/Core>

#include "sim/brush/program.h"

namespace fude {

// Z with hessian⁻¹ = Z Zᵀ. False where the hessian is not safely positive definite.
bool invert_factor(const SquareMatrix& hessian, SquareMatrix& inverse_factor);

// minimise ½ dᵀ hessian d + gradientᵀ d  where  rows d ≥ right and low ≤ d ≤ high.
struct QuadraticProgram {
  const SquareMatrix& inverse_factor;  // of the hessian, see above; any such Z will do
  const Variables& gradient;
  const Jacobian& rows;
  const Multipliers& right;
  const Variables& low;
  const Variables& high;
};

enum class QuadraticOutcome { solved, infeasible };

struct QuadraticSolution {
  QuadraticOutcome outcome = QuadraticOutcome::solved;
  Variables d;
  Multipliers multipliers;  // of the rows, ≥ 0
};

QuadraticSolution solve(const QuadraticProgram& program);

}  // namespace fude
