// Our SQP against NLopt's SLSQP (Kraft) on the same energies, step by step along one trajectory.
#include "sim/brush/sqp.h"

#include <gtest/gtest.h>
#include <nlopt.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "sim/brush/bench_gesture.h"
#include "sim/brush/quadratic_program.h"
#include "sim/brush/tuft_energy.h"
#include "sim/brush/tuft_step.h"

namespace fude {
namespace {

constexpr double step_s = 1.0 / 250;
constexpr int frames = 2000;

double objective(unsigned n, const double* x, double* gradient, void* program) {
  Evaluation at;
  static_cast<const Program*>(program)->evaluate(Eigen::Map<const Eigen::VectorXd>(x, n), at);
  if (gradient) std::copy(at.gradient.data(), at.gradient.data() + n, gradient);
  return at.value;
}

// NLopt wants c ≤ 0, its gradient row by row.
void paper(unsigned m, double* result, unsigned n, const double* x, double* gradient, void* program) {
  Evaluation at;
  static_cast<const Program*>(program)->evaluate(Eigen::Map<const Eigen::VectorXd>(x, n), at);
  for (unsigned j = 0; j < m; ++j) {
    result[j] = -at.constraints[j];
    for (unsigned i = 0; gradient && i < n; ++i) gradient[j * n + i] = -at.jacobian(j, i);
  }
}

struct Reference {
  double value = 0;
  double violation = 0;
};

Reference solve_by_slsqp(const TuftProgram& program, const Variables& start) {
  const auto n = static_cast<unsigned>(start.size());
  const auto m = static_cast<unsigned>(program.constraints());
  void* self = const_cast<TuftProgram*>(&program);
  nlopt_opt opt = nlopt_create(NLOPT_LD_SLSQP, n);
  nlopt_set_min_objective(opt, objective, self);
  const std::vector<double> tolerance(m, 1e-9);
  nlopt_add_inequality_mconstraint(opt, m, paper, self, tolerance.data());
  nlopt_set_lower_bounds(opt, program.low.data());
  nlopt_set_upper_bounds(opt, program.high.data());
  nlopt_set_xtol_rel(opt, 1e-11);
  nlopt_set_maxeval(opt, 3000);
  const Variables inside = start.cwiseMax(program.low).cwiseMin(program.high);
  std::vector<double> x(inside.data(), inside.data() + n);
  Reference reference;
  nlopt_optimize(opt, x.data(), &reference.value);
  nlopt_destroy(opt);
  Evaluation at;
  program.evaluate(Eigen::Map<const Eigen::VectorXd>(x.data(), n), at);
  reference.value = at.value;
  reference.violation = std::max(0.0, -at.constraints.minCoeff());
  return reference;
}

// Largest residual of stationarity at x with multipliers λ, over the largest of the forces: recomputed
// here from the program alone. Where a bound holds, only a pull back inside counts.
double stationarity(const TuftProgram& program, const Variables& x, const Multipliers& multipliers) {
  Evaluation at;
  program.evaluate(x, at);
  const Variables forces = at.jacobian.transpose() * multipliers;
  double worst = 0;
  double scale = program.small_gradient;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    double r = at.gradient[i] - forces[i];
    if (x[i] <= program.low[i] + 1e-9) r = std::min(r, 0.0);
    if (x[i] >= program.high[i] - 1e-9) r = std::max(r, 0.0);
    worst = std::max(worst, std::abs(r) * program.unit[i]);
    scale = std::max(scale, std::abs(forces[i]) * program.unit[i]);
  }
  return worst / scale;
}

TEST(Sqp, AgreesWithSlsqpAlongPressDragTurnLift) {
  const BrushSpec spec;
  const Tuft tuft = make_tuft(spec);
  TuftState state = rest_state(tuft);
  double worst_gap = 0;
  double worst_residual = 0;
  double worst_violation = 0;
  int compared = 0;
  int lower = 0;
  for (int f = 0; f < frames; ++f) {
    const Pose<Paper, Handle> pose = reachable_pose(tuft, bench_gestures()[0].pose(spec, f * step_s));
    if (f % 10 == 5) {
      TuftState trial = state;
      const FrozenStep frozen = freeze_step(tuft, trial, pose, step_s);
      const TuftProgram program(tuft, frozen);
      const Reference reference = solve_by_slsqp(program, trial.x);
      SquareMatrix hessian = trial.hessian;
      const SquareMatrix fresh = program.spring_hessian();
      if (!trial.in_contact) hessian = fresh;
      Variables x = trial.x;
      const SqpResult own = minimise(program, x, hessian, fresh, SqpLimits{});
      ASSERT_TRUE(own.converged) << "frame " << f;
      ASSERT_LE(reference.violation, 1e-6 * spec.tuft_length_mm) << "SLSQP itself, frame " << f;
      const double scale = std::max(std::abs(reference.value), program.small_energy);
      worst_gap = std::max(worst_gap, (own.value - reference.value) / scale);
      worst_residual = std::max(worst_residual, stationarity(program, x, own.multipliers));
      worst_violation = std::max(worst_violation, own.violation);
      if (own.value < reference.value - 1e-3 * scale) ++lower;
      ++compared;
    }
    ASSERT_TRUE(advance(tuft, state, pose, step_s, f == 0).converged) << "frame " << f;
  }
  RecordProperty("compared", compared);
  std::printf(
      "figure: %d steps beside SLSQP: gap %.2e, residual %.2e, violation %.2e mm; lower than SLSQP in %d\n",
      compared, worst_gap, worst_residual, worst_violation, lower);
  EXPECT_LE(worst_gap, 1e-3);
  EXPECT_LE(worst_residual, 1e-4);
  EXPECT_LE(worst_violation, 1e-6 * spec.tuft_length_mm);
}

TEST(Sqp, CarriedHessianSavesIterations) {
  const BrushSpec spec;
  const Tuft tuft = make_tuft(spec);
  TuftState carried = rest_state(tuft);
  TuftState forgetful = rest_state(tuft);
  int with = 0;
  int without = 0;
  for (int f = 0; f < frames; ++f) {
    const Pose<Paper, Handle> pose = bench_gestures()[0].pose(spec, f * step_s);
    with += advance(tuft, carried, pose, step_s, f == 0).iterations;
    forgetful.hessian.resize(0, 0);
    without += advance(tuft, forgetful, pose, step_s, f == 0).iterations;
  }
  std::printf("figure: %.2f iterations a step with the Hessian carried on, %.2f without\n",
              1.0 * with / frames, 1.0 * without / frames);
  EXPECT_LT(with, 0.55 * without);  // thesis, table 2.1: 7.4 for 14.6
}

TEST(QuadraticProgram, SolvesWithBoundsAndRows) {
  // ½|d|² − (2, 3)·d with d₀ + d₁ ≤ 2 and d₁ ≤ 1.2: the corner (0.8, 1.2), multiplier of the row 1.2.
  const SquareMatrix inverse_factor = SquareMatrix::Identity(2, 2);
  Variables gradient(2);
  gradient << -2, -3;
  Jacobian rows(1, 2);
  rows << -1, -1;
  Multipliers right(1);
  right << -2;
  Variables low = Variables::Constant(2, -10);
  Variables high(2);
  high << 10, 1.2;
  const QuadraticSolution s = solve({inverse_factor, gradient, rows, right, low, high});
  ASSERT_EQ(s.outcome, QuadraticOutcome::solved);
  EXPECT_NEAR(s.d[0], 0.8, 1e-12);
  EXPECT_NEAR(s.d[1], 1.2, 1e-12);
  EXPECT_NEAR(s.multipliers[0], 1.2, 1e-12);
}

TEST(QuadraticProgram, SaysWhenThereIsNoSolution) {
  const SquareMatrix inverse_factor = SquareMatrix::Identity(2, 2);
  const Variables gradient = Variables::Zero(2);
  Jacobian rows(1, 2);
  rows << 1, 1;
  Multipliers right(1);
  right << 5;
  const Variables low = Variables::Constant(2, -1);
  const Variables high = Variables::Constant(2, 1);
  EXPECT_EQ(solve({inverse_factor, gradient, rows, right, low, high}).outcome, QuadraticOutcome::infeasible);
}

TEST(QuadraticProgram, TakesAHessianThatIsPositiveDefinite) {
  SquareMatrix hessian(3, 3);
  hessian << 4, 1, -0.5, 1, 3, 0.2, -0.5, 0.2, 2;
  SquareMatrix z;
  ASSERT_TRUE(invert_factor(hessian, z));
  EXPECT_LT((z.transpose() * hessian * z - SquareMatrix::Identity(3, 3)).cwiseAbs().maxCoeff(), 1e-14);
  hessian(1, 1) = -1;
  EXPECT_FALSE(invert_factor(hessian, z));
  hessian(1, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(invert_factor(hessian, z));
}

// ½ (x − c)ᵀ A (x − c) with A of three unknowns coupled, and x₀ + x₂ ≥ 2.
class Coupled : public Program {
 public:
  Coupled() {
    low = Variables::Constant(3, -10);
    high = Variables::Constant(3, 10);
    unit = Variables::Ones(3);
    small_energy = small_gradient = small_violation = 1e-9;
    curvature << 4, 1, -0.5, 1, 3, 0.2, -0.5, 0.2, 2;
  }
  void evaluate(const Variables& x, Evaluation& at) const override {
    const Eigen::Vector3d off = Eigen::Vector3d(x) - Eigen::Vector3d(1, -2, 0.5);
    at.value = 0.5 * off.dot(curvature * off);
    at.gradient = curvature * off;
    at.constraints = Multipliers::Constant(1, x[0] + x[2] - 2);
    at.jacobian = Jacobian::Zero(1, 3);
    at.jacobian(0, 0) = at.jacobian(0, 2) = 1;
  }
  Eigen::Matrix3d curvature;
};

TEST(Sqp, AnUnknownWithoutRoomIsHeldAndTheHessianStaysSound) {
  Coupled program;
  program.low[1] = program.high[1] = 0.25;
  Variables x = Variables::Zero(3);
  SquareMatrix hessian = program.curvature;
  const SqpResult held = minimise(program, x, hessian, SquareMatrix::Identity(3, 3), SqpLimits{});
  ASSERT_TRUE(held.converged);
  EXPECT_EQ(x[1], 0.25);
  // Of x₀ and x₂ = 2 − x₀ alone: the derivative along (1, 0, −1) is zero.
  Evaluation at;
  program.evaluate(x, at);
  EXPECT_NEAR(at.constraints[0], 0, 1e-9);
  EXPECT_NEAR(at.gradient[0] - at.gradient[2], 0, 1e-6);
  EXPECT_NEAR(held.multipliers[0], at.gradient[0], 1e-6);
  // Free again, it goes on from the Hessian that was left.
  SquareMatrix factor;
  ASSERT_TRUE(invert_factor(hessian, factor));
  program.low[1] = -10;
  program.high[1] = 10;
  ASSERT_TRUE(minimise(program, x, hessian, SquareMatrix::Identity(3, 3), SqpLimits{}).converged);
  program.evaluate(x, at);
  EXPECT_NEAR(at.gradient[1], 0, 1e-5);
}

}  // namespace
}  // namespace fude
