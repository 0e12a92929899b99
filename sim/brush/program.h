// A smooth nonlinear program: minimise value(x) where constraints(x) ≥ 0 and low ≤ x ≤ high.
#pragma once

#include <Eigen/Core>

#include "sim/brush/skeleton.h"

namespace fude {

inline constexpr int max_constraints = max_segments + 1;
using Multipliers = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, max_constraints, 1>;
using Jacobian =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, max_constraints, max_variables>;
using SquareMatrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, max_variables, max_variables>;

struct Evaluation {
  double value = 0;
  Variables gradient;
  Multipliers constraints;
  Jacobian jacobian;
};

class Program {
 public:
  virtual ~Program() = default;
  // Value, gradient, constraints and their Jacobian at x; a pure function.
  virtual void evaluate(const Variables& x, Evaluation& at) const = 0;
  Variables low;
  Variables high;
  Variables unit;             // natural size of each unknown, so that residuals can be compared
  double small_energy = 0;    // below which an energy does not matter
  double small_gradient = 0;  // the same, per unit
  double small_violation = 0;
};

}  // namespace fude
