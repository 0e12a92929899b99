#include "sim/brush/quadratic_program.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace fude {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double violation_tolerance = 1e-11;
constexpr int max_exchanges = 400;

// Lower Cholesky factor; false where the matrix is not safely positive definite.
bool factor(const SquareMatrix& h, SquareMatrix& l) {
  const int n = static_cast<int>(h.rows());
  l = h;
  for (int j = 0; j < n; ++j) {
    for (int k = 0; k < j; ++k) l.col(j).tail(n - j) -= l(j, k) * l.col(k).tail(n - j);
    const double pivot = l(j, j);
    if (!(pivot > 1e-12 * h(j, j)) || !(h(j, j) < infinite)) return false;
    l.col(j).tail(n - j) /= std::sqrt(pivot);
  }
  return true;
}

class DualActiveSet {
 public:
  explicit DualActiveSet(const QuadraticProgram& p)
      : p_(p), n_(static_cast<int>(p.gradient.size())), m_(static_cast<int>(p.right.size())) {}

  QuadraticSolution run();

 private:
  // Constraints are numbered: rows, then lower bounds, then upper bounds.
  double slack(int c) const {
    if (c < m_) return p_.rows.row(c).dot(d_) - p_.right[c];
    if (c < m_ + n_) return d_[c - m_] - p_.low[c - m_];
    return p_.high[c - m_ - n_] - d_[c - m_ - n_];
  }
  // basisᵀ times the constraint's normal.
  void project_normal(int c) {
    if (c < m_) {
      projected_.noalias() = basis_.transpose() * p_.rows.row(c).transpose();
    } else if (c < m_ + n_) {
      projected_ = basis_.row(c - m_).transpose();
    } else {
      projected_ = -basis_.row(c - m_ - n_).transpose();
    }
  }
  int most_violated() const;
  bool start();
  bool take_up(int c);
  void append(int c, double multiplier);
  void drop(int position);

  const QuadraticProgram& p_;
  const int n_;
  const int m_;
  Variables d_;
  Variables projected_;
  Variables direction_;
  SquareMatrix basis_;     // L⁻ᵀ Q: its first columns span the active normals
  SquareMatrix triangle_;  // R
  int active_count_ = 0;
  std::array<int, max_variables> active_{};
  Variables multipliers_;  // of the active constraints
  Variables dual_step_;
  std::array<bool, max_constraints + 2 * max_variables> is_active_{};
};

bool DualActiveSet::start() {
  SquareMatrix l;
  if (!factor(p_.hessian, l)) return false;
  // basis = L⁻ᵀ, column by column of L⁻¹.
  basis_.setZero(n_, n_);
  for (int j = 0; j < n_; ++j) {
    Variables column = Variables::Zero(n_);
    column[j] = 1;
    for (int k = j; k < n_; ++k) {
      column[k] /= l(k, k);
      if (k + 1 < n_) column.tail(n_ - k - 1) -= column[k] * l.col(k).tail(n_ - k - 1);
    }
    basis_.row(j) = column.transpose();
  }
  projected_.noalias() = basis_.transpose() * p_.gradient;
  d_.noalias() = -(basis_ * projected_);
  triangle_.setZero(n_, n_);
  multipliers_.setZero(n_);
  dual_step_.setZero(n_);
  return true;
}

int DualActiveSet::most_violated() const {
  int worst = -1;
  double least = -violation_tolerance;
  for (int c = 0; c < m_ + 2 * n_; ++c) {
    if (is_active_[static_cast<std::size_t>(c)]) continue;
    const double s = slack(c);
    if (s < least) {
      least = s;
      worst = c;
    }
  }
  return worst;
}

void DualActiveSet::append(int c, double multiplier) {
  // Givens rotations leave the projected normal with nothing below its new diagonal entry.
  for (int j = n_ - 1; j > active_count_; --j) {
    const double a = projected_[j - 1];
    const double b = projected_[j];
    if (b == 0) continue;
    const double h = std::sqrt(a * a + b * b);
    const double cosine = a / h;
    const double sine = b / h;
    projected_[j - 1] = h;
    projected_[j] = 0;
    const Variables left = basis_.col(j - 1);
    basis_.col(j - 1) = cosine * left + sine * basis_.col(j);
    basis_.col(j) = cosine * basis_.col(j) - sine * left;
  }
  triangle_.col(active_count_).head(active_count_ + 1) = projected_.head(active_count_ + 1);
  active_[static_cast<std::size_t>(active_count_)] = c;
  multipliers_[active_count_] = multiplier;
  is_active_[static_cast<std::size_t>(c)] = true;
  ++active_count_;
}

void DualActiveSet::drop(int position) {
  is_active_[static_cast<std::size_t>(active_[static_cast<std::size_t>(position)])] = false;
  for (int j = position; j + 1 < active_count_; ++j) {
    active_[static_cast<std::size_t>(j)] = active_[static_cast<std::size_t>(j + 1)];
    multipliers_[j] = multipliers_[j + 1];
    triangle_.col(j).head(j + 2) = triangle_.col(j + 1).head(j + 2);
  }
  --active_count_;
  for (int j = position; j < active_count_; ++j) {
    const double a = triangle_(j, j);
    const double b = triangle_(j + 1, j);
    const double h = std::sqrt(a * a + b * b);
    if (h == 0) continue;
    const double cosine = a / h;
    const double sine = b / h;
    for (int k = j; k < active_count_; ++k) {
      const double upper = triangle_(j, k);
      triangle_(j, k) = cosine * upper + sine * triangle_(j + 1, k);
      triangle_(j + 1, k) = cosine * triangle_(j + 1, k) - sine * upper;
    }
    const Variables left = basis_.col(j);
    basis_.col(j) = cosine * left + sine * basis_.col(j + 1);
    basis_.col(j + 1) = cosine * basis_.col(j + 1) - sine * left;
  }
}

// Brings constraint c to its boundary, dropping others on the way; false where that is impossible.
bool DualActiveSet::take_up(int c) {
  double multiplier = 0;
  for (int exchange = 0; exchange < max_exchanges; ++exchange) {
    project_normal(c);
    const int q = active_count_;
    const double length = projected_.squaredNorm();
    const double free_length = projected_.tail(n_ - q).squaredNorm();
    dual_step_.head(q) = projected_.head(q);
    for (int i = q - 1; i >= 0; --i) {
      dual_step_[i] /= triangle_(i, i);
      dual_step_.head(i) -= dual_step_[i] * triangle_.col(i).head(i);
    }
    double partial = infinite;
    int leaving = -1;
    for (int i = 0; i < q; ++i) {
      if (dual_step_[i] > 0 && multipliers_[i] / dual_step_[i] < partial) {
        partial = multipliers_[i] / dual_step_[i];
        leaving = i;
      }
    }
    const bool movable = free_length > 1e-13 * length;
    const double full = movable ? -slack(c) / free_length : infinite;
    const double step = std::min(partial, full);
    if (step == infinite) return false;
    multipliers_.head(q) -= step * dual_step_.head(q);
    multiplier += step;
    if (movable) {
      direction_.noalias() = basis_.rightCols(n_ - q) * projected_.tail(n_ - q);
      d_ += step * direction_;
    }
    if (movable && full <= partial) {
      append(c, multiplier);
      return true;
    }
    drop(leaving);
  }
  return false;
}

QuadraticSolution DualActiveSet::run() {
  QuadraticSolution solution;
  if (!start()) {
    solution.outcome = QuadraticOutcome::indefinite;
    return solution;
  }
  for (int exchange = 0; exchange < max_exchanges; ++exchange) {
    const int c = most_violated();
    if (c < 0) break;
    if (!take_up(c)) {
      solution.outcome = QuadraticOutcome::infeasible;
      return solution;
    }
  }
  solution.d = d_;
  solution.multipliers = Multipliers::Zero(m_);
  for (int i = 0; i < active_count_; ++i) {
    const int c = active_[static_cast<std::size_t>(i)];
    if (c < m_) solution.multipliers[c] = std::max(0.0, multipliers_[i]);
  }
  return solution;
}

}  // namespace

QuadraticSolution solve(const QuadraticProgram& program) { return DualActiveSet(program).run(); }

}  // namespace fude
