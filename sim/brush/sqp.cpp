#include "sim/brush/sqp.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/brush/free_program.h"
#include "sim/brush/quadratic_program.h"

namespace fude {
namespace {

constexpr double longest_step = 0.7;  // of any unknown, in its unit
constexpr double sufficient_decrease = 1e-4;
constexpr double damping = 0.2;  // Powell

double violation_of(const Multipliers& constraints) { return std::max(0.0, -constraints.minCoeff()); }

double merit(const Evaluation& at, const Multipliers& penalty) {
  double sum = at.value;
  for (int j = 0; j < penalty.size(); ++j) sum += penalty[j] * std::max(0.0, -at.constraints[j]);
  return sum;
}

// The quadratic program around a point; where its constraints contradict each other, violated ones
// are asked for only in part (Powell 1978), at last not at all.
QuadraticSolution step_from(const Program& program, const Variables& x, const Evaluation& at,
                            const SquareMatrix& inverse_factor, const Multipliers& constraints) {
  const Variables low = (program.low - x).cwiseMax(-longest_step * program.unit).cwiseMin(0.0);
  const Variables high = (program.high - x).cwiseMin(longest_step * program.unit).cwiseMax(0.0);
  QuadraticSolution solution;
  for (const double share : {1.0, 0.5, 0.1, 0.01, 0.0}) {
    Multipliers right = -constraints;
    for (int j = 0; j < right.size(); ++j)
      if (right[j] > 0) right[j] *= share;
    solution = solve({inverse_factor, at.gradient, at.jacobian, right, low, high});
    if (solution.outcome != QuadraticOutcome::infeasible) break;
  }
  return solution;
}

// The Hessian and, in product form, its inverse factor (Brodlie, Gourlay & Greenstadt 1973): no new
// factorisation within a program.
struct Curvature {
  SquareMatrix& hessian;
  SquareMatrix inverse_factor;

  void update(const Variables& s, const Variables& y);
};

void Curvature::update(const Variables& s, const Variables& y) {
  const Variables bs = hessian * s;
  const double curvature = s.dot(bs);
  if (!(curvature > 1e-14)) return;
  const double sy = s.dot(y);
  const double theta = sy >= damping * curvature ? 1 : (1 - damping) * curvature / (curvature - sy);
  const Variables r = theta * y + (1 - theta) * bs;
  const double sr = s.dot(r);
  const Variables turn = (std::sqrt(sr / curvature) * bs - r) / sr;
  const Variables share = inverse_factor.transpose() * turn;
  for (int j = 0; j < s.size(); ++j) {
    hessian.col(j) += (r[j] / sr) * r - (bs[j] / curvature) * bs;
    inverse_factor.col(j) += share[j] * s;
  }
}

SqpResult minimise_free(const Program& program, Variables& x, SquareMatrix& hessian,
                        const SquareMatrix& fresh_hessian, const SqpLimits& limits) {
  SqpResult result;
  x = x.cwiseMax(program.low).cwiseMin(program.high);
  Evaluation at;
  program.evaluate(x, at);
  Multipliers penalty = Multipliers::Zero(at.constraints.size());
  Curvature curvature{hessian, {}};
  if (!invert_factor(hessian, curvature.inverse_factor)) {
    hessian = fresh_hessian;
    if (!invert_factor(hessian, curvature.inverse_factor)) return result;
  }
  Evaluation next;
  for (;;) {
    const QuadraticSolution step = step_from(program, x, at, curvature.inverse_factor, at.constraints);
    result.multipliers =
        step.multipliers.size() > 0 ? step.multipliers : Multipliers(Multipliers::Zero(penalty.size()));
    result.value = at.value;
    result.violation = violation_of(at.constraints);
    if (step.outcome != QuadraticOutcome::solved) break;

    // Stationarity of the quadratic program: ∇f − Jᵀλ − ν = −B d.
    const Variables curved = hessian * step.d;
    const Variables forces = at.jacobian.transpose() * step.multipliers;
    const double reference =
        std::max(program.small_gradient, forces.cwiseAbs().cwiseProduct(program.unit).maxCoeff());
    double slackness = 0;
    for (int j = 0; j < step.multipliers.size(); ++j)
      slackness = std::max(slackness, std::abs(step.multipliers[j] * at.constraints[j]));
    result.residual = curved.cwiseAbs().cwiseProduct(program.unit).maxCoeff() / reference;
    const double energy = std::max(program.small_energy, std::abs(at.value));
    if (result.residual <= limits.residual && result.violation <= program.small_violation &&
        slackness <= 1e-4 * energy && step.d.dot(curved) <= 2e-6 * energy) {
      result.converged = true;
      break;
    }
    if (result.iterations == limits.iterations) break;
    ++result.iterations;

    for (int j = 0; j < penalty.size(); ++j)
      penalty[j] = std::max(1.2 * step.multipliers[j], 0.5 * (penalty[j] + 1.2 * step.multipliers[j]));
    const double start = merit(at, penalty);
    double slope = at.gradient.dot(step.d);
    for (int j = 0; j < penalty.size(); ++j) slope -= penalty[j] * std::max(0.0, -at.constraints[j]);
    slope = std::min(slope, -0.5 * step.d.dot(curved));

    Variables moved = step.d;
    program.evaluate(x + moved, next);
    // Rounding decides where the decrease is lost in the last digits.
    const double noise = 1e-13 * (std::abs(start) + program.small_energy);
    const auto falls_short = [&](double reached, double length) {
      return reached > start + sufficient_decrease * length * slope + noise;
    };
    double reached = merit(next, penalty);
    if (falls_short(reached, 1)) {
      // Constraints curve away from the step; the correction bends the search along them (Mayne & Polak
      // 1982). Straight on, a sliding joint would be cut to the same small step again and again.
      const Multipliers corrected = next.constraints - at.jacobian * step.d;
      const QuadraticSolution second = step_from(program, x, at, curvature.inverse_factor, corrected);
      Variables bend = Variables::Zero(moved.size());
      if (second.outcome == QuadraticOutcome::solved && second.d.squaredNorm() < 4 * step.d.squaredNorm()) {
        bend = second.d - step.d;
        moved = second.d;
        program.evaluate(x + moved, next);
        reached = merit(next, penalty);
      }
      double length = 1;
      for (int cut = 0; cut < 12 && falls_short(reached, length); ++cut) {
        // Minimum of the parabola through value, slope and what was reached.
        const double guess = -0.5 * slope * length / ((reached - start) / length - slope);
        length *= std::clamp(guess > 0 ? guess / length : 0.5, 0.1, 0.6);
        moved = length * step.d + length * length * bend;
        program.evaluate(x + moved, next);
        reached = merit(next, penalty);
      }
    }
    const Variables change =
        next.gradient - at.gradient - (next.jacobian - at.jacobian).transpose() * step.multipliers;
    curvature.update(moved, change);
    x = (x + moved).cwiseMax(program.low).cwiseMin(program.high);
    std::swap(at, next);
  }
  return result;
}

}  // namespace

SqpResult minimise(const Program& program, Variables& x, SquareMatrix& hessian,
                   const SquareMatrix& fresh_hessian, const SqpLimits& limits) {
  const FreeProgram free(program);
  if (free.is_whole()) return minimise_free(program, x, hessian, fresh_hessian, limits);
  Variables free_x = free.free_of(x);
  SquareMatrix free_hessian = free.free_of(hessian);
  const SqpResult result = minimise_free(free, free_x, free_hessian, free.free_of(fresh_hessian), limits);
  free.put_back(free_x, x);
  free.put_back(free_hessian, hessian);
  return result;
}

}  // namespace fude
